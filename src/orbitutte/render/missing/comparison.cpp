// SPDX-License-Identifier: MIT
// Stands in for render/comparison.cpp in builds without Embree and Cairo.
#include "orbitutte/report/comparison.h"

namespace orbitutte {

void write_comparison(const std::string&, const Comparison&) {
  throw ArgumentError("this binary was built without pictures; build it with -D ORBITUTTE_RENDER=ON");
}

}  // namespace orbitutte
