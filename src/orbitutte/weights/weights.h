// SPDX-License-Identifier: MIT
// Edge weights of the discrete Dirichlet energy (section 4), on the uncut mesh.
#pragma once

#include <string>
#include <vector>

#include "orbitutte/mesh/edge_weights.h"
#include "orbitutte/mesh/surface.h"

namespace orbitutte {

/// The weight of one undirected edge.
struct WeightedEdge {
  /// Its ends.
  int i = -1, j = -1;
  double weight = 0;
};

/// How the weights of the energy are chosen.
struct WeightOptions {
  WeightKind kind = WeightKind::standard;
  double clamp = 0.01;                   ///< of cotangents that are not positive, > 0: the paper's value
  std::vector<WeightedEdge> given = {};  ///< of kind `file`: every edge once, w >= 0
};

/// The kind of weights that a surface gets where this one is asked for: of `standard` it is `delaunay`, or
/// `cotan` where faces have more than three corners. Throws ArgumentError for kinds that such faces do not
/// have: `delaunay` and `mean_value`.
WeightKind weight_kind(const Surface& surface, WeightKind asked);

/// Weights on the uncut mesh, so that no cut can change them. Zero-area triangles have no cotangents and add
/// nothing to `cotan`; `delaunay` and `mean_value` go by mollified_lengths. Mean value weights are made
/// symmetric, since a minimiser of an energy knows no others: they are positive, but no longer reproduce
/// linear maps (M. Floater, "Mean value coordinates", CAGD 20 (2003)). Throws ArgumentError for a clamp that
/// is not positive and finite, as weight_kind does, and MeshError as given_weights does and for kept faces
/// that are not there. kept_faces: triangles whose edges are not flipped, of kind `delaunay`.
EdgeWeights edge_weights(const Surface& surface, const WeightOptions& options,
                         const std::vector<int>& kept_faces = {});

/// Cotangent weights of an intrinsic triangulation: see WeightKind::delaunay.
EdgeWeights intrinsic_weights(IntrinsicTriangulation triangulation, double clamp);

/// Weights from a list that has each undirected edge of the mesh once, in any order. Throws MeshError naming
/// the entry and the edge if the edge is not in the mesh, is given twice or is missing, or if a weight is
/// negative or not finite.
EdgeWeights given_weights(const std::vector<WeightedEdge>& list, const Connectivity& connectivity);

/// Reads lines `i j w`, one for each undirected edge of the mesh, in any order; further columns are ignored.
/// Throws FileError, and MeshError as given_weights does, naming the line.
EdgeWeights read_weights(const std::string& path, const Connectivity& connectivity);

}  // namespace orbitutte
