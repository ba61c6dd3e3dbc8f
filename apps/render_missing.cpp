// SPDX-License-Identifier: MIT
// Stands in for render_command.cpp if the library is built without Embree and Cairo.
#include "commands.h"
#include "orbitutte/types.h"
#include "page_pictures.h"

namespace orbitutte::cli {

int render_command(const RenderArguments&) {
  throw ArgumentError("this binary was built without pictures; build it with -D ORBITUTTE_RENDER=ON");
}

std::vector<PagePicture> page_pictures(const Surface&, const Embedding&, const Report&) { return {}; }

}  // namespace orbitutte::cli
