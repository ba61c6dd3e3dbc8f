// SPDX-License-Identifier: MIT
// What edges weigh in the discrete Dirichlet energy (equation (2)), whoever found the weights.
#pragma once

#include <memory>
#include <string>

#include "orbitutte/mesh/intrinsic_triangulation.h"
#include "orbitutte/names.h"

namespace orbitutte {

enum class WeightKind {
  /// Delaunay, or cotan on meshes with faces of more than three corners.
  standard,
  /// W_ij = (cot a + cot b)/2 over the angles opposite to the edge; those not positive become `clamp`.
  cotan,
  /// The same of the intrinsic Delaunay triangulation, whose weights are nonnegative; zeros become 1e-6, and
  /// those of blocked edges that are negative `clamp`.
  delaunay,
  /// W_ij = (l_i m_ij + l_j m_ji)/2, m_ij the mean value weight (tan(a/2) + tan(b/2))/|ij| over the angles at
  /// i beside the edge, l_i half the mean length of the edges at i.
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
  /// Cotangent weights that became `clamp`.
  int clamped_edges = 0;
  /// Of kind `delaunay`: the triangulation whose edges have the weights; null where they are the mesh's.
  std::shared_ptr<const IntrinsicTriangulation> triangulation;
  /// Weights of a file that are exactly zero: accepted, though the theory asks for w > 0.
  int zero_edges = 0;
};

}  // namespace orbitutte
