// SPDX-License-Identifier: MIT
// Nested dissection of a mesh's graph: the elimination order of its Laplacian, and a tree of separators along
// which the work parts.
#pragma once

#include <vector>

#include "orbitutte/mesh/connectivity.h"

namespace orbitutte {

/// A binary tree of vertex sets, every one of which separates the sets of its two subtrees from each other: a
/// vertex has neighbours in its own set, in the sets below it, and in those on the way to the root.
/// Eliminating `order` from its beginning keeps the Cholesky factor sparse.
struct Dissection {
  struct Node {
    int parent = -1;  ///< an index into nodes, greater than the node's own; -1 at the root
    int depth = 0;    ///< of the root: 0
    int first = 0;    ///< the node's subtree holds order[first .. end - 1],
    int begin = 0;    ///< and its own set order[begin .. end - 1]
    int end = 0;
  };
  std::vector<int> order;   ///< n: the vertices; order[k] is eliminated k-th
  std::vector<Node> nodes;  ///< children before their parents; the last is the root
};

/// Bisects the graph, coarsened once, by METIS (G. Karypis, V. Kumar, "A fast and high quality multilevel
/// scheme for partitioning irregular graphs", SIAM J. Sci. Comput. 20 (1998)), takes the vertices on one side
/// of every interface as its separator, and orders each set by approximate minimum degree (P. Amestoy, T.
/// Davis, I. Duff, "Algorithm 837: AMD", ACM TOMS 30 (2004)). On meshes the factor is about as sparse as
/// METIS's own nested dissection makes it, in a tenth of the time (docs/benchmarks.md).
Dissection dissect(const Neighbors& graph);

}  // namespace orbitutte
