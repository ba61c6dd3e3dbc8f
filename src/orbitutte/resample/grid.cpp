// SPDX-License-Identifier: MIT
#include "orbitutte/resample/grid.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <bit>
#include <charconv>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>

#include "orbitutte/errors.h"
#include "orbitutte/mesh/subdivision.h"
#include "orbitutte/parallel.h"
#include "orbitutte/resample/flat_images.h"
#include "orbitutte/resample/healpix.h"
#include "orbitutte/resample/sphere_images.h"

namespace orbitutte {
namespace {

using std::numbers::pi;

constexpr long long most_points = 100'000'000;

[[noreturn]] void refuse_grid(const std::string& text, const std::string& problem) {
  throw ArgumentError(fmt::format("the grid is '{}': {}", text, problem));
}

std::optional<int> parse_size(std::string_view text) {
  if (text.empty()) return std::nullopt;
  int value = 0;
  const auto [stop, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || stop != text.data() + text.size() || value < 0 || text.front() == '-')
    return std::nullopt;
  return value;
}

long long points_of(const GridRequest& request) {
  const long long size = request.size;
  switch (request.kind) {
    case GridKind::icosphere:
      return size > 20 ? most_points + 1 : 10 * (1LL << 2 * size) + 2;
    case GridKind::healpix:
    case GridKind::healpix_nested:
      return 12 * size * size;
    case GridKind::cube:
      return 6 * size * size;
    default:
      return size * request.width;
  }
}

bool has_width(GridKind kind) {
  return kind == GridKind::equirectangular || kind == GridKind::periodic || kind == GridKind::tile;
}

// Sets size and width from "512x256", or "256".
void read_sizes(const std::string& text, std::string_view numbers, GridRequest& request) {
  const std::size_t at = numbers.find('x');
  const std::optional<int> first = parse_size(numbers.substr(0, at));
  std::optional<int> second = first;
  if (at != std::string_view::npos) {
    second = has_width(request.kind) ? parse_size(numbers.substr(at + 1)) : std::nullopt;
  } else if (first && request.kind == GridKind::equirectangular) {
    second = *first / 2;
  }
  if (!first || !second)
    refuse_grid(text, "give its size, as in ico:7, healpix:64, equirectangular:512x256 or cube:128");
  request.size = *second;
  request.width = request.kind == GridKind::octahedral || has_width(request.kind) ? *first : 0;
}

void require_sound_size(const std::string& text, const GridRequest& request) {
  const int least = request.kind == GridKind::icosphere    ? 0
                    : request.kind == GridKind::octahedral ? 4
                    : has_width(request.kind)              ? 2
                                                           : 1;
  if (request.size < least || (has_width(request.kind) && request.width < least))
    refuse_grid(text, fmt::format("its size must be at least {}", least));
  if (request.kind == GridKind::equirectangular && request.width % 2 != 0)
    refuse_grid(text, "its width must be even, so that it goes on beyond the poles");
  if (request.kind == GridKind::octahedral && request.size % 2 != 0)
    refuse_grid(text, "its size must be even, so that its diagonals pass between pixels");
  if (request.kind == GridKind::healpix_nested && !std::has_single_bit(static_cast<unsigned>(request.size)))
    refuse_grid(text, "nested pixels need a power of two");
  if (request.size > 100000 || request.width > most_points || points_of(request) > most_points)
    refuse_grid(text, fmt::format("it has more than {} points; take a coarser one", most_points));
}

// The icosahedron with vertices at the even permutations of (0, +-1, +-golden ratio).
Mesh unit_icosahedron() {
  Mesh mesh;
  mesh.V.resize(12, 3);
  const double g = std::numbers::phi;
  mesh.V << -1, g, 0, 1, g, 0, -1, -g, 0, 1, -g, 0, 0, -1, g, 0, 1, g, 0, -1, -g, 0, 1, -g, g, 0, -1, g, 0, 1,
      -g, 0, -1, -g, 0, 1;
  mesh.F.resize(20, 3);
  mesh.F << 0, 11, 5, 0, 5, 1, 0, 1, 7, 0, 7, 10, 0, 10, 11, 1, 5, 9, 5, 11, 4, 11, 10, 2, 10, 7, 6, 7, 1, 8,
      3, 9, 4, 3, 4, 2, 3, 2, 6, 3, 6, 8, 3, 8, 9, 4, 9, 5, 2, 4, 11, 6, 2, 10, 8, 6, 7, 9, 8, 1;
  mesh.V.rowwise().normalize();
  return mesh;
}

// The signed areas of triangles on the sphere.
Eigen::VectorXd areas_on_sphere(const Points& points, const Triangles& triangles) {
  Eigen::VectorXd areas(triangles.rows());
  parallel_ranges(static_cast<int>(triangles.rows()), [&](int begin, int end) {
    for (int t = begin; t < end; ++t)
      areas[t] = Space::sphere().area(points.row(triangles(t, 0)), points.row(triangles(t, 1)),
                                      points.row(triangles(t, 2)));
  });
  return areas;
}

// A third of the areas of the triangles around each point.
Eigen::VectorXd areas_around_points(const Grid& grid, const Eigen::VectorXd& of_triangles) {
  Eigen::VectorXd areas = Eigen::VectorXd::Zero(grid.count());
  for (Eigen::Index t = 0; t < grid.triangles.rows(); ++t)
    for (int k = 0; k < 3; ++k) areas[grid.triangles(t, k)] += of_triangles[t] / 3;
  return areas;
}

Grid icosphere_grid(int level) {
  Mesh mesh = unit_icosahedron();
  for (int l = 0; l < level; ++l) {
    mesh = subdivided(mesh);
    parallel_ranges(static_cast<int>(mesh.V.rows()), [&](int begin, int end) {
      for (int v = begin; v < end; ++v) mesh.V.row(v).normalize();
    });
  }
  Grid grid;
  grid.points = std::move(mesh.V);
  grid.triangles = std::move(mesh.F);
  grid.areas = areas_around_points(grid, areas_on_sphere(grid.points, grid.triangles));
  return grid;
}

Grid healpix_grid(const GridRequest& request) {
  const Healpix pixels(request.size);
  Grid grid;
  grid.kind = request.kind;
  grid.points = pixels.centres();
  if (request.kind == GridKind::healpix_nested) {
    const Points in_rings = grid.points;
    const std::vector<int> numbers = pixels.rings_of_nested();
    for (int p = 0; p < grid.count(); ++p) grid.points.row(p) = in_rings.row(numbers[p]);
  }
  grid.areas = Eigen::VectorXd::Constant(grid.count(), 4 * pi / grid.count());
  return grid;
}

void require_image(const Grid& grid, int margin) {
  if (!grid.is_image())
    throw ArgumentError(
        fmt::format("only images can have a margin, and the grid {} is none", name_of(grid.kind)));
  const int largest = std::min(grid.shape[grid.shape.size() - 2], grid.shape.back());
  if (margin < 0 || margin > largest)
    throw ArgumentError(
        fmt::format("the margin is {}; it may be 0 to {}, the size of the image", margin, largest));
}

}  // namespace

GridRequest parse_grid(const std::string& text) {
  const std::size_t colon = text.find(':');
  GridRequest request;
  request.kind = parse_choice<GridKind>(std::string_view(text).substr(0, colon), "the kind of grid");
  if (colon == std::string::npos) refuse_grid(text, "its size is missing, as in ico:7 or healpix:64");
  read_sizes(text, std::string_view(text).substr(colon + 1), request);
  require_sound_size(text, request);
  return request;
}

Grid make_grid(const GridRequest& request) {
  switch (request.kind) {
    case GridKind::icosphere:
      return icosphere_grid(request.size);
    case GridKind::healpix:
    case GridKind::healpix_nested:
      return healpix_grid(request);
    case GridKind::equirectangular:
      return equirectangular_grid(request.size, request.width);
    case GridKind::octahedral:
      return octahedral_grid(request.size);
    case GridKind::cube:
      return cube_grid(request.size);
    default:
      throw ArgumentError(
          fmt::format("the grid {} is made from a surface, not from a size alone", name_of(request.kind)));
  }
}

Grid make_grid(const GridRequest& request, const Embedding& embedding) {
  if (request.kind == GridKind::periodic || request.kind == GridKind::tile)
    return flat_grid(request, embedding);
  if (embedding.space() != Space::sphere())
    throw ArgumentError(
        fmt::format("the grid {} is one of the sphere, but the map is onto {}, which is {}; take periodic or "
                    "tile, or embed "
                    "into an orbifold of the sphere",
                    name_of(request.kind), embedding.target.signature, embedding.space().name()));
  return make_grid(request);
}

Grid sphere_grid(const Points& V, const Triangles& triangles) {
  Grid grid;
  grid.kind = GridKind::sphere;
  grid.points = V;
  for (Eigen::Index v = 0; v < V.rows(); ++v) {
    const double length = V.row(v).stableNorm();
    if (!(length > 0) || !std::isfinite(length))
      throw MeshError(fmt::format("vertex {} of the grid's sphere is at the origin, or not finite", v));
    grid.points.row(v) /= length;
  }
  grid.triangles = triangles;
  Eigen::VectorXd of_triangles = areas_on_sphere(grid.points, triangles);
  if (of_triangles.sum() < 0) {
    grid.triangles.col(1).swap(grid.triangles.col(2));
    of_triangles = -of_triangles;
  }
  constexpr double folds = 0.01;  // FreeSurfer's spheres have some
  const double times = of_triangles.cwiseAbs().sum() / (4 * pi);
  if (!(std::abs(of_triangles.sum() / (4 * pi) - 1) < 1e-6 && times < 1 + folds))
    throw MeshError(
        fmt::format("seen from the origin, the grid's surface covers the sphere {:.3g} times; give a sphere "
                    "around the origin, without folds",
                    times));
  grid.areas = areas_around_points(grid, of_triangles);
  return grid;
}

int pixel_number(const Grid& grid, const ImagePixel& pixel) {
  const int height = grid.shape[grid.shape.size() - 2], width = grid.shape.back();
  ImagePixel inside = pixel;
  switch (grid.kind) {
    case GridKind::equirectangular:
      inside = equirectangular_pixel(pixel, height, width);
      break;
    case GridKind::octahedral:
      inside = octahedral_pixel(pixel, height);
      break;
    case GridKind::cube:
      inside = cube_pixel(pixel, height);
      break;
    default:
      inside = flat_pixel(grid, pixel);
  }
  return (inside.image * height + inside.row) * width + inside.column;
}

std::vector<int> padded_shape(const Grid& grid, int margin) {
  require_image(grid, margin);
  std::vector<int> shape = grid.shape;
  shape[shape.size() - 2] += 2 * margin;
  shape.back() += 2 * margin;
  return shape;
}

std::vector<int> padded_points(const Grid& grid, int margin) {
  const std::vector<int> shape = padded_shape(grid, margin);
  const int images = shape.size() == 3 ? shape[0] : 1, height = shape[shape.size() - 2], width = shape.back();
  std::vector<int> numbers(static_cast<std::size_t>(images) * height * width);
  parallel_for(images * height, [&](int k) {
    for (int column = 0; column < width; ++column)
      numbers[static_cast<std::size_t>(k) * width + column] =
          pixel_number(grid, {k / height, k % height - margin, column - margin});
  });
  return numbers;
}

}  // namespace orbitutte
