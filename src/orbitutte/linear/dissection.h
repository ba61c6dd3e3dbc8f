// SPDX-License-Identifier: MIT
// Nested dissection of a mesh's graph: an elimination order for its Laplacian, and a tree of separators that
// divides the work.
#pragma once

#include <array>
#include <vector>

#include "orbitutte/mesh/connectivity.h"

namespace orbitutte {

/// A binary tree of vertex sets. Every set separates the sets of its two subtrees: a vertex has neighbours
/// only in its own set, in the sets below, and in those on the way to the root. Eliminating the vertices in
/// the order of `order` keeps the Cholesky factor sparse.
struct Dissection {
  struct Node {
    /// An index into nodes, greater than the node's own; -1 at the root.
    int parent = -1;
    /// 0 at the root.
    int depth = 0;
    /// The node's subtree holds order[first .. end - 1], its own set is order[begin .. end - 1].
    int first = 0;
    int begin = 0;
    int end = 0;
  };
  /// n: the vertices; order[k] is eliminated k-th.
  std::vector<int> order;
  /// Children come before their parents; the last node is the root.
  std::vector<Node> nodes;
};

/// Bisects the graph, coarsened once, with METIS (G. Karypis, V. Kumar, "A fast and high quality multilevel
/// scheme for partitioning irregular graphs", SIAM J. Sci. Comput. 20 (1998)). The smallest set of vertices
/// that separates both sides of a band along each interface becomes its separator (smallest_separator.h).
/// Each set is ordered by approximate minimum degree (P. Amestoy, T. Davis, I. Duff, "Algorithm 837: AMD",
/// ACM TOMS 30 (2004)). On meshes the factor is about as sparse as with METIS's own nested dissection, in a
/// tenth of the time (docs/benchmarks.md).
Dissection dissect(const Neighbors& graph);

/// The same sets for another graph on the vertices, most of whose edges are those of the one that was
/// dissected: the first end of an edge that joins two subtrees moves to the set that separates them.
Dissection adapted(Dissection dissection, const std::vector<std::array<int, 2>>& edges);

}  // namespace orbitutte
