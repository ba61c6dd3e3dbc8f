// SPDX-License-Identifier: MIT
// Edge weights of the discrete Dirichlet energy (section 4), on the uncut mesh.
#pragma once

#include <array>
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
  /// Replaces cotangent weights that are negative or zero; must be positive. The default is the paper's
  /// value.
  double clamp = 0.01;
  /// For kind `file`: every edge once, w >= 0.
  std::vector<WeightedEdge> given = {};
};

/// What the flips of kind `delaunay` leave as it is.
struct UnflippedEdges {
  /// Triangles of the surface, none of whose edges is flipped.
  std::vector<int> kept_faces;
  /// Pairs of vertices that no flip joins by an edge.
  std::vector<std::array<int, 2>> kept_apart = {};
};

/// The kind of weights that a surface gets if this kind is asked for. `standard` stands for `delaunay`, or
/// for `cotan` if some faces have more than three corners. Throws ArgumentError if such faces are to have
/// `delaunay` or `mean_value` weights, which are defined on triangles only.
WeightKind weight_kind(const Surface& surface, WeightKind asked);

/// Weights on the uncut mesh, so that no cut can change them. Zero-area triangles have no cotangents and add
/// nothing to `cotan`; `delaunay` and `mean_value` use mollified_lengths. Mean value weights are made
/// symmetric, since weights of an energy must be; they are positive, but no longer reproduce linear maps (M.
/// Floater, "Mean value coordinates", CAGD 20 (2003)). For kind `delaunay`, `unflipped` limits the flips.
/// Throws ArgumentError if the clamp is not positive and finite, and as weight_kind does; MeshError as
/// given_weights does, and if a kept face does not exist.
EdgeWeights edge_weights(const Surface& surface, const WeightOptions& options,
                         const UnflippedEdges& unflipped = {});

/// The intrinsic Delaunay triangulation that has the weights of kind `delaunay`; all faces of the surface are
/// triangles. Throws as edge_weights does.
IntrinsicTriangulation delaunay_triangulation(const Surface& surface, const UnflippedEdges& unflipped = {});

/// Cotangent weights of an intrinsic triangulation: see WeightKind::delaunay. Its lengths and angles, half of
/// its memory, are not kept: the result cannot be sharpened at cones. Throws ArgumentError if the clamp is
/// not positive and finite.
EdgeWeights intrinsic_weights(IntrinsicTriangulation triangulation, double clamp);

/// Weights from a list that has each undirected edge of the mesh once, in any order. Throws MeshError naming
/// the entry and the edge if the edge is not in the mesh, is given twice or is missing, or if a weight is
/// negative or not finite.
EdgeWeights given_weights(const std::vector<WeightedEdge>& list, const Connectivity& connectivity);

/// Reads lines `i j w`, one for each undirected edge of the mesh, in any order; further columns are ignored.
/// Throws FileError, and MeshError as given_weights does, naming the line.
EdgeWeights read_weights(const std::string& path, const Connectivity& connectivity);

}  // namespace orbitutte
