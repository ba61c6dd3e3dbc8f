// SPDX-License-Identifier: MIT
// One image of every edge of the uncut mesh. Private to verify/.
#pragma once

#include <algorithm>
#include <numeric>
#include <vector>

#include "orbitutte/mesh/connectivity.h"
#include "orbitutte/orbifold/embedding.h"

namespace orbitutte {

/// Finds edges by their ends: those of one lower vertex stand together.
class EdgeIndex {
 public:
  EdgeIndex(const Connectivity& connectivity, int vertex_count)
      : edges_(connectivity.edges), start_(vertex_count + 1, 0) {
    for (const auto& [i, j] : edges_) ++start_[i + 1];
    std::partial_sum(start_.begin(), start_.end(), start_.begin());
  }

  int operator()(int i, int j) const {
    const auto [lower, upper] = std::minmax(i, j);
    int e = start_[lower];
    while (edges_[e][1] != upper) ++e;
    return e;
  }

 private:
  const std::vector<std::array<int, 2>>& edges_;
  std::vector<int> start_;
};

/// Calls visit(e, a, b) once for every edge e of the uncut mesh, as one of the embedding's faces, triangles
/// or polygons, has it between the cut vertices a and b. The faces must be those of the mesh, cut (see
/// certify).
template <typename Visit>
void visit_edges(const Connectivity& connectivity, const Embedding& embedding, const Visit& visit) {
  const FaceView faces = embedding.faces();
  const std::vector<int>& source = embedding.source_vertex;
  const EdgeIndex edge_between(connectivity, static_cast<int>(source.size()));
  std::vector<char> done(connectivity.edges.size(), 0);
  for (int f = 0; f < faces.count(); ++f) {
    int a = faces[f].back();
    for (const int b : faces[f]) {
      const int e = edge_between(source[a], source[b]);
      if (!done[e]) visit(e, a, b);
      done[e] = 1;
      a = b;
    }
  }
}

}  // namespace orbitutte
