// SPDX-License-Identifier: MIT
#include "orbitutte/resample/grid_interpolation.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "orbitutte/parallel.h"
#include "orbitutte/resample/flat_images.h"
#include "orbitutte/resample/healpix.h"
#include "orbitutte/resample/sphere_images.h"
#include "orbitutte/resample/surface_walk.h"

namespace orbitutte {
namespace {

// The nested number of each pixel in the order of the rings.
std::vector<int> nested_of_rings(int side) {
  const std::vector<int> rings = Healpix(side).rings_of_nested();
  std::vector<int> nested(rings.size());
  for (std::size_t p = 0; p < rings.size(); ++p) nested[rings[p]] = static_cast<int>(p);
  return nested;
}

// Linear in row and column between four pixels.
Stencil between_pixels(const Grid& grid, const Eigen::Vector2d& column_and_row) {
  const double column = std::floor(column_and_row.x()), row = std::floor(column_and_row.y());
  const double right = column_and_row.x() - column, down = column_and_row.y() - row;
  Stencil stencil;
  for (int corner = 0; corner < 4; ++corner) {
    const int i = corner / 2, j = corner % 2;
    stencil.add(pixel_number(grid, {0, static_cast<int>(row) + i, static_cast<int>(column) + j}),
                (i == 0 ? 1 - down : down) * (j == 0 ? 1 - right : right));
  }
  return stencil;
}

}  // namespace

struct GridInterpolation::State {
  const Grid& grid;

  // Of HEALPix.
  Healpix pixels;
  std::vector<int> nested;

  // Of grids with triangles.
  Embedding sphere;
  std::unique_ptr<SurfaceWalk> walk;

  explicit State(const Grid& given)
      : grid(given), pixels(static_cast<int>(std::lround(std::sqrt(given.count() / 12.0)))) {
    if (grid.kind == GridKind::healpix_nested) nested = nested_of_rings(pixels.side());
    if (grid.triangles.rows() == 0) return;
    sphere = embedded_sphere(grid.points, grid.triangles);
    walk = std::make_unique<SurfaceWalk>(sphere);
  }

  Stencil of_healpix(const Vector3& point) const {
    Stencil stencil = pixels.stencil(point);
    for (int i = 0; i < stencil.count && !nested.empty(); ++i) stencil.index[i] = nested[stencil.index[i]];
    return stencil;
  }

  Stencil of_image(const Vector3& point) const {
    const int height = grid.shape[0], width = grid.shape[1];
    if (grid.kind == GridKind::equirectangular)
      return between_pixels(grid, equirectangular_place(point, height, width));
    const Eigen::Vector2d share = flat_place(grid, point);
    return between_pixels(grid, {share.x() * width - 0.5, (1 - share.y()) * height - 0.5});
  }

  std::vector<Stencil> in_triangles(const Points& points) const {
    const SurfacePoints found = walk->locate(points);
    std::vector<Stencil> stencils(points.rows());
    for (int k = 0; k < found.count(); ++k)
      for (int i = 0; i < 3 && found.triangle[k] >= 0; ++i)
        stencils[k].add(grid.triangles(found.triangle[k], i), found.barycentric(k, i));
    return stencils;
  }
};

GridInterpolation::GridInterpolation(const Grid& grid) : state_(std::make_unique<State>(grid)) {}
GridInterpolation::~GridInterpolation() = default;

std::vector<Stencil> GridInterpolation::stencils(const Points& points) const {
  if (state_->walk) return state_->in_triangles(points);
  const bool is_image = state_->grid.is_image();
  std::vector<Stencil> stencils(points.rows());
  parallel_ranges(static_cast<int>(points.rows()), [&](int begin, int end) {
    for (int k = begin; k < end; ++k)
      stencils[k] = is_image ? state_->of_image(points.row(k)) : state_->of_healpix(points.row(k));
  });
  return stencils;
}

}  // namespace orbitutte
