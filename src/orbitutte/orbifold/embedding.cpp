// SPDX-License-Identifier: MIT
#include "orbitutte/orbifold/embedding.h"

#include <algorithm>

namespace orbitutte {

SeamKind Seam::kind() const {
  if (is_mirror()) return SeamKind::reflection;
  return transform.reverses_orientation() ? SeamKind::rotoreflection : SeamKind::rotation;
}

int Embedding::input_vertex_count() const {
  return source_vertex.empty() ? 0 : *std::max_element(source_vertex.begin(), source_vertex.end()) + 1;
}

std::vector<int> Embedding::corner_at_input_vertex() const {
  std::vector<int> corner(input_vertex_count(), -1);
  for (int t = 0; t < static_cast<int>(triangles.rows()); ++t)
    for (int k = 0; k < 3; ++k) corner[source_vertex[triangles(t, k)]] = 3 * t + k;
  return corner;
}

Points Embedding::canonical_positions() const {
  return placement.is_identity() ? positions : placement.inverse().on_rows(positions);
}

}  // namespace orbitutte
