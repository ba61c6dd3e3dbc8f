// SPDX-License-Identifier: MIT
#include "orbitutte/orbifold/embedding.h"

namespace orbitutte {

SeamKind Seam::kind() const {
  if (is_mirror()) return SeamKind::reflection;
  return transform.reverses_orientation() ? SeamKind::rotoreflection : SeamKind::rotation;
}

Points Embedding::canonical_positions() const {
  return placement.is_identity() ? positions : placement.inverse().on_rows(positions);
}

}  // namespace orbitutte
