// SPDX-License-Identifier: MIT
// Edge weights of the discrete Dirichlet energy (section 4), on the uncut mesh.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "orbitutte/mesh/edge_weights.h"

namespace orbitutte {

/// The weight of one undirected edge.
struct WeightedEdge {
  int i = -1, j = -1;  ///< its ends
  double weight = 0;
};

/// Which weights the energy has.
struct WeightOptions {
  WeightKind kind = WeightKind::standard;
  double clamp = 0.01;                   ///< of cotangents that are not positive, > 0: the paper's value
  std::vector<int> kept_faces;           ///< of kind `delaunay`: faces whose edges are not flipped
  std::vector<WeightedEdge> given = {};  ///< of kind `file`: every edge once, w >= 0
  std::vector<std::array<int, 2>> kept_apart = {};  ///< of kind `delaunay`: vertices that no flip joins
};

/// Weights on the uncut mesh, so that no cut can change them. Zero-area triangles have no cotangents and add
/// nothing to `cotan`; `delaunay` and `mean_value` go by mollified_lengths. Mean value weights are made
/// symmetric, since a minimiser of an energy knows no others: they are positive, but no longer reproduce
/// linear maps (M. Floater, "Mean value coordinates", CAGD 20 (2003)). Throws ArgumentError for a clamp that
/// is not positive and finite, and MeshError as given_weights does. The faces are all there are, so
/// `standard` is `delaunay`.
EdgeWeights edge_weights(const Mesh& mesh, const Connectivity& connectivity, const WeightOptions& options);

/// Cotangent weights of an intrinsic triangulation, as WeightKind::delaunay says.
EdgeWeights intrinsic_weights(IntrinsicTriangulation triangulation, double clamp);

/// Weights from a list, each undirected edge of the mesh once, in any order. Throws MeshError naming the
/// entry and the edge: no edge of the mesh, given twice, missing, a weight that is negative or not finite.
EdgeWeights given_weights(const std::vector<WeightedEdge>& list, const Connectivity& connectivity);

/// Reads lines `i j w`, each undirected edge of the mesh once, in any order; further columns are ignored.
/// Throws FileError, and MeshError naming the line and the edge: no edge of the mesh, given twice, missing, a
/// weight that is negative or not finite.
EdgeWeights read_weights(const std::string& path, const Connectivity& connectivity);

}  // namespace orbitutte
