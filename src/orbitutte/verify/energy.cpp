// SPDX-License-Identifier: MIT
#include "orbitutte/verify/energy.h"

#include <algorithm>
#include <numeric>

#include "orbitutte/verify/spherical_triangle.h"

namespace orbitutte {
namespace {

// Finds edges by their ends: those of one lower vertex stand together.
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

}  // namespace

double dirichlet_energy(const Connectivity& connectivity, const EdgeWeights& weights,
                        const Embedding& embedding) {
  const FaceView faces = embedding.input_faces();
  const std::vector<int>& source = embedding.source_vertex;
  const EdgeIndex edge_between(connectivity, static_cast<int>(source.size()));
  std::vector<char> done(connectivity.edges.size(), 0);
  double energy = 0;
  for (int f = 0; f < faces.count(); ++f) {
    int a = faces[f].back();
    for (const int b : faces[f]) {
      const int e = edge_between(source[a], source[b]);
      if (!done[e]) {
        const double d = arc_length(embedding.positions.row(a), embedding.positions.row(b));
        energy += weights.w[e] * d * d;
      }
      done[e] = 1;
      a = b;
    }
  }
  return energy;
}

}  // namespace orbitutte
