// SPDX-License-Identifier: MIT
// Weights of edges in the discrete Dirichlet energy (equation (2)), from whatever source.
#pragma once

#include <memory>
#include <string>

#include "orbitutte/names.h"
#include "orbitutte/types.h"

namespace orbitutte {

struct IntrinsicTriangulation;

enum class WeightKind {
  /// Delaunay, or cotan on meshes with faces of more than three corners.
  standard,
  /// w_ij = (cot a + cot b)/2 over the angles opposite to the edge; weights that are not positive become
  /// `clamp`.
  cotan,
  /// The same for the intrinsic Delaunay triangulation, whose weights are nonnegative. Zeros become 1e-6.
  /// Negative weights of edges that could not be flipped become `clamp`.
  delaunay,
  /// w_ij = (l_i m_ij + l_j m_ji)/2, where m_ij is the mean value weight (tan(a/2) + tan(b/2))/|ij| over the
  /// angles at i beside the edge, and l_i is half the mean length of the edges at i.
  mean_value,
  /// W_ij = 1.
  uniform,
  /// Given by the caller.
  file
};

/// Its names.
template <>
struct NameTable<WeightKind> {
  static constexpr NamedValue<WeightKind> rows[] = {
      {WeightKind::standard, "standard"}, {WeightKind::cotan, "cotan"},
      {WeightKind::delaunay, "delaunay"}, {WeightKind::mean_value, "mean-value"},
      {WeightKind::uniform, "uniform"},   {WeightKind::file, "file", false}};
};

/// A weight for every edge of the mesh, or of an intrinsic triangulation of its surface.
struct EdgeWeights {
  WeightKind kind = WeightKind::cotan;
  double clamp = 0.01;
  /// One weight per undirected edge, in the order of Connectivity::edges.
  Eigen::VectorXd w;
  /// The number of cotangent weights that became `clamp`.
  int clamped_edges = 0;
  /// For kind `delaunay`, the triangulation whose edges have the weights; null if the mesh's own edges have
  /// them.
  std::shared_ptr<const IntrinsicTriangulation> triangulation;
  /// The number of weights of a file that are exactly zero. They are accepted, although the theory requires
  /// w > 0.
  int zero_edges = 0;
};

}  // namespace orbitutte
