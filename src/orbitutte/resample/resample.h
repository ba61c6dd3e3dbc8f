// SPDX-License-Identifier: MIT
// Values from a surface to a grid of what it is mapped onto, and back, as tables of weights.
#pragma once

#include "orbitutte/mesh/surface.h"
#include "orbitutte/names.h"
#include "orbitutte/orbifold/embedding.h"
#include "orbitutte/resample/grid.h"
#include "orbitutte/resample/least_squares.h"
#include "orbitutte/resample/sparse_table.h"

namespace orbitutte {

enum class ResampleKind {
  /// To the grid: linear in the triangle of the surface that a point lies in. Back: linear in the grid.
  linear,
  /// To the grid: the corner of that triangle with the largest barycentric coordinate. Back: the point of the
  /// grid with the largest weight. For labels.
  nearest,
  /// Means over the cells of the grid that keep the integral over the surface: conservative_tables.
  conservative,
  /// To the grid: the values of which the surface's are made again as nearly as can be:
  /// least_squares_values. Back: linear in the grid.
  least_squares
};

/// Its names.
template <>
struct NameTable<ResampleKind> {
  static constexpr NamedValue<ResampleKind> rows[] = {{ResampleKind::linear, "linear"},
                                                      {ResampleKind::nearest, "nearest"},
                                                      {ResampleKind::conservative, "conservative"},
                                                      {ResampleKind::least_squares, "least-squares"}};
};

/// The table that takes values at the n vertices of the input (Embedding::source_vertex) to the k points of
/// the grid: k x n, rows with the sum 1, empty where no triangle lies: outside of a polygon, or where an
/// embedding is not certified. Points in any copy of the tile are found on the surface. `kind` is linear or
/// nearest; ArgumentError otherwise: values of the kind least_squares are no product with a table.
SparseTable table_to_grid(const Embedding& embedding, const Grid& grid, ResampleKind kind);

/// The table back: n x k; empty for vertices that no face uses. Linear: the mean over the copies of the
/// vertex in the grid (over all elements of a finite group; over the sheets of a periodic image). Nearest:
/// that of the first copy. Least squares: as linear. ArgumentError for conservative.
SparseTable table_to_surface(const Embedding& embedding, const Grid& grid, ResampleKind kind);

/// Tables that keep integrals. Let A_v be the areas of the vertices on the surface, a_v those on the target,
/// and c_i those of the cells of the grid. With the linear tables P from the grid to the surface (n x k) and
/// Q from the surface to the grid (k x n), the area that vertex v and cell i have in common is
///
///     Y_vi = A_v X_vi / sum_j X_vj,    X_vi = a_v P_vi + c_i Q_iv / copies,
///
/// a first-order scheme in which every cell and every vertex has its part, be the grid finer or coarser than
/// the surface. The cell has the area m_i = sum_v Y_vi of the surface, and values are means:
///
///     to the grid g_i = sum_v Y_vi f_v / m_i,    back f_v = sum_i Y_vi g_i / A_v.
///
/// So sum_i m_i g_i = sum_v A_v f_v, up to rounding, and constants stay as they are, both ways.
struct ConservativeTables {
  /// k x n, and n x k.
  SparseTable to_grid, to_surface;

  /// k: m_i. Their sum is the area of the surface.
  Eigen::VectorXd cell_areas;
};

/// vertex_areas: n, as Surface::vertex_areas has them. Throws ArgumentError if there are not as many as
/// vertices.
ConservativeTables conservative_tables(const Embedding& embedding, const Grid& grid,
                                       const Eigen::VectorXd& vertex_areas);

}  // namespace orbitutte
