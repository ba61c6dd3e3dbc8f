// SPDX-License-Identifier: MIT
#include "orbitutte/resample/resample.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>

#include "orbitutte/errors.h"
#include "orbitutte/orbifold/symmetry_group.h"
#include "orbitutte/parallel.h"
#include "orbitutte/resample/grid_interpolation.h"
#include "orbitutte/resample/surface_walk.h"

namespace orbitutte {
namespace {

constexpr int stencils_at_once = 1 << 21;

void require_kind(ResampleKind kind) {
  if (kind == ResampleKind::conservative)
    throw ArgumentError("conservative tables need the areas of the vertices: conservative_tables makes them");
}

// The elements of the group that make copies of a vertex with places of their own in the grid.
std::vector<Isometry> copies_in(const Embedding& embedding, const Grid& grid) {
  if (grid.kind == GridKind::periodic) return grid.flat.sheets;
  if (grid.kind == GridKind::tile) return {Isometry()};
  constexpr int of_cone_surfaces = 1;
  return canonical_group_of(embedding, of_cone_surfaces).elements();
}

// Appends the rows of a table with as many columns.
void append_rows(const SparseTable& part, SparseTable& table) {
  const int before = table.start.back();
  for (std::size_t r = 1; r < part.start.size(); ++r) table.start.push_back(before + part.start[r]);
  table.index.insert(table.index.end(), part.index.begin(), part.index.end());
  table.weight.insert(table.weight.end(), part.weight.begin(), part.weight.end());
}

// The means over the copies, of which only so many are made at once.
SparseTable linear_to_surface(const Embedding& embedding, const Grid& grid,
                              const std::vector<Isometry>& copies) {
  const int vertices = embedding.input_vertex_count(), count = static_cast<int>(copies.size());
  const std::vector<int> corner = embedding.corner_at_input_vertex();
  const Points positions = embedding.canonical_positions();
  const GridInterpolation interpolation(grid);
  const int at_once = std::max(1, stencils_at_once / count);
  SparseTable table;
  table.columns = grid.count();
  table.start.reserve(vertices + 1);
  for (int begin = 0; begin < vertices; begin += at_once) {
    const int end = std::min(vertices - begin, at_once) + begin;
    Points points(static_cast<Eigen::Index>(end - begin) * count, 3);
    parallel_ranges(end - begin, [&](int from, int to) {
      for (int v = from; v < to; ++v)
        for (int g = 0; g < count; ++g)
          points.row(static_cast<Eigen::Index>(v) * count + g) =
              (copies[g] * Vector3(positions.row(begin + v))).transpose();
    });
    std::vector<Stencil> stencils = interpolation.stencils(points);
    for (int v = begin; v < end; ++v)
      for (int g = 0; g < count && corner[v] < 0; ++g)
        stencils[static_cast<std::size_t>(v - begin) * count + g].count = 0;
    append_rows(table_of_stencils(grid.count(), stencils, count), table);
  }
  return table;
}

SparseTable linear_to_grid(const Embedding& embedding, const Grid& grid) {
  const SurfacePoints found = SurfaceWalk(embedding).locate(grid.points);
  std::vector<Stencil> stencils(grid.count());
  parallel_ranges(grid.count(), [&](int begin, int end) {
    for (int k = begin; k < end; ++k)
      for (int i = 0; i < 3 && found.triangle[k] >= 0; ++i)
        stencils[k].add(embedding.source_vertex[embedding.triangles(found.triangle[k], i)],
                        found.barycentric(k, i));
  });
  return table_of_stencils(embedding.input_vertex_count(), stencils);
}

// A third of the areas of a vertex's triangles on the target.
Eigen::VectorXd target_areas(const Embedding& embedding) {
  Eigen::VectorXd areas = Eigen::VectorXd::Zero(embedding.input_vertex_count());
  for (Eigen::Index t = 0; t < embedding.triangles.rows(); ++t) {
    const auto corner = [&](int k) -> Vector3 { return embedding.positions.row(embedding.triangles(t, k)); };
    const double area = std::abs(embedding.space().area(corner(0), corner(1), corner(2)));
    for (int k = 0; k < 3; ++k) areas[embedding.source_vertex[embedding.triangles(t, k)]] += area / 3;
  }
  return areas;
}

}  // namespace

SparseTable table_to_grid(const Embedding& embedding, const Grid& grid, ResampleKind kind) {
  require_kind(kind);
  if (kind == ResampleKind::least_squares)
    throw ArgumentError(
        "values of the kind least-squares solve equations, and are no product with a table: "
        "least_squares_values makes them");
  SparseTable table = linear_to_grid(embedding, grid);
  return kind == ResampleKind::nearest ? largest_weights(table) : table;
}

SparseTable table_to_surface(const Embedding& embedding, const Grid& grid, ResampleKind kind) {
  require_kind(kind);
  if (kind == ResampleKind::nearest) return largest_weights(linear_to_surface(embedding, grid, {Isometry()}));
  return linear_to_surface(embedding, grid, copies_in(embedding, grid));
}

ConservativeTables conservative_tables(const Embedding& embedding, const Grid& grid,
                                       const Eigen::VectorXd& vertex_areas) {
  const int vertices = embedding.input_vertex_count();
  if (vertex_areas.size() != vertices)
    throw ArgumentError(fmt::format("there are areas of {} vertices, but the embedding has {}",
                                    vertex_areas.size(), vertices));
  const std::vector<Isometry> copies = copies_in(embedding, grid);
  const SparseTable from_grid = linear_to_surface(embedding, grid, copies);
  SparseTable to_grid = linear_to_grid(embedding, grid);
  scale_rows(to_grid, grid.areas / static_cast<double>(copies.size()));
  const SparseTable from_surface = transposed(to_grid);
  ConservativeTables result;
  result.to_surface =
      sum_of({from_grid, target_areas(embedding)}, {from_surface, Eigen::VectorXd::Ones(vertices)});
  normalize_rows(result.to_surface);
  SparseTable common = result.to_surface;
  scale_rows(common, vertex_areas);
  result.to_grid = transposed(common);
  result.cell_areas = row_sums(result.to_grid);
  normalize_rows(result.to_grid);
  return result;
}

}  // namespace orbitutte
