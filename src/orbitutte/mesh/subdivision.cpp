// SPDX-License-Identifier: MIT
#include "orbitutte/mesh/subdivision.h"

#include "orbitutte/mesh/connectivity.h"

namespace orbitutte {

Mesh subdivided(const Mesh& mesh) {
  const int n = static_cast<int>(mesh.V.rows());
  const Connectivity connectivity = connectivity_of(mesh.F, n);
  const int edge_count = static_cast<int>(connectivity.edges.size());
  Mesh fine = {Points(n + edge_count, 3), Triangles(4 * mesh.F.rows(), 3)};
  fine.V.topRows(n) = mesh.V;
  for (int e = 0; e < edge_count; ++e) {
    const auto [i, j] = connectivity.edges[e];
    fine.V.row(n + e) = 0.5 * mesh.V.row(i) + 0.5 * mesh.V.row(j);  // their sum might overflow
  }
  for (int f = 0; f < mesh.F.rows(); ++f) {
    const auto corner = mesh.F.row(f);
    const auto middle = [&](int k) { return n + connectivity.edge_of[3 * f + k]; };
    for (int k = 0; k < 3; ++k) fine.F.row(4 * f + k) << corner[k], middle(k), middle((k + 2) % 3);
    fine.F.row(4 * f + 3) << middle(0), middle(1), middle(2);
  }
  return fine;
}

}  // namespace orbitutte
