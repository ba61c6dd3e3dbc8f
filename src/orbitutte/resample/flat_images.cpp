// SPDX-License-Identifier: MIT
#include "orbitutte/resample/flat_images.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "orbitutte/errors.h"
#include "orbitutte/orbifold/families.h"
#include "orbitutte/orbifold/symmetry_group.h"
#include "orbitutte/parallel.h"

namespace orbitutte {
namespace {

using Eigen::Vector2d;

constexpr int searched_elements = 400;
constexpr double direction_tolerance = 1e-6;

Eigen::Matrix2d linear_part(const Isometry& element) { return element.matrix().topLeftCorner<2, 2>(); }
Vector2d translation_part(const Isometry& element) { return element.matrix().topRightCorner<2, 1>(); }

bool have_same_linear_part(const Isometry& a, const Isometry& b) {
  return (linear_part(a) - linear_part(b)).norm() < direction_tolerance;
}

double cross(const Vector2d& a, const Vector2d& b) { return a.x() * b.y() - a.y() * b.x(); }

// Is the first a better side of an image: shorter, or as long and more to the right, or above?
bool is_better_side(const Vector2d& a, const Vector2d& b) {
  const double tolerance = 1e-9 * std::max(a.norm(), b.norm());
  if (std::abs(a.norm() - b.norm()) > tolerance) return a.norm() < b.norm();
  if (std::abs(a.x() - b.x()) > tolerance) return a.x() > b.x();
  return a.y() > b.y();
}

// The two shortest translations, the second one to the left of the first.
std::array<Vector2d, 2> lattice_basis(const std::vector<Isometry>& elements, const Target& target) {
  std::optional<Vector2d> first, second;
  std::vector<Vector2d> translations;
  translations.reserve(elements.size());
  for (const Isometry& element : elements)
    if (have_same_linear_part(element, Isometry()) && translation_part(element).norm() > direction_tolerance)
      translations.push_back(translation_part(element));
  for (const Vector2d& t : translations)
    if (!first || is_better_side(t, *first)) first = t;
  for (const Vector2d& t : translations)
    if (cross(*first, t) > direction_tolerance * first->norm() * t.norm() &&
        (!second || is_better_side(t, *second)))
      second = t;
  if (!second)
    throw ArgumentError(fmt::format(
        "there is no periodic image of a map onto {}, whose group has no two translations; take 442, 2222 or "
        "another orbifold of the plane",
        target.signature));
  return {*first, *second};
}

// One element for each linear part.
std::vector<Isometry> sheets_of(const std::vector<Isometry>& elements) {
  std::vector<Isometry> sheets;
  sheets.reserve(12);
  for (const Isometry& element : elements)
    if (std::none_of(sheets.begin(), sheets.end(),
                     [&](const Isometry& sheet) { return have_same_linear_part(sheet, element); }))
      sheets.push_back(element);
  return sheets;
}

Matrix3 lattice_matrix(const std::array<Vector2d, 2>& basis, const Vector2d& origin) {
  Matrix3 result = Matrix3::Identity();
  result.topLeftCorner<2, 1>() = basis[0];
  result.block<2, 1>(0, 1) = basis[1];
  result.topRightCorner<2, 1>() = origin;
  return result;
}

// The point nearest to the middle that all elements with a linear part leave where it is: (1 - A) x = t.
std::optional<Vector2d> fixed_point(const std::vector<Isometry>& elements, const Eigen::Matrix2d& linear) {
  for (const Isometry& element : elements) {
    if ((linear_part(element) - linear).norm() > direction_tolerance) continue;
    return (Eigen::Matrix2d::Identity() - linear_part(element)).lu().solve(translation_part(element));
  }
  return std::nullopt;
}

PartOfCell part_of_cell(const Target& target) {
  const Family* family = find_family(target.symbol);
  return family ? family->part_of_cell : PartOfCell();
}

// A corner of the tile: a centre of order 4 or 2, where mirrors meet. Otherwise the origin.
Vector2d corner_of_cell(const std::vector<Isometry>& elements, const PartOfCell& part) {
  if (!part.is_known()) return Vector2d::Zero();
  Eigen::Matrix2d turn = -Eigen::Matrix2d::Identity();
  if (part.order_at_corner == 4) turn << 0, -1, 1, 0;
  return fixed_point(elements, turn).value_or(Vector2d::Zero());
}

// The cell of the translations. A tile is the lower left part of it.
FlatImage flat_image(const std::vector<Isometry>& elements, const Target& target, GridKind kind) {
  FlatImage flat;
  flat.sheets = sheets_of(elements);
  const PartOfCell part = part_of_cell(target);
  flat.lattice = lattice_matrix(lattice_basis(elements, target), corner_of_cell(elements, part));
  if (kind == GridKind::periodic) return flat;
  if (!part.is_known())
    throw ArgumentError(
        fmt::format("the tile of {} is no image: those of 442, 2222 and *2222 are; take periodic, which all "
                    "orbifolds of the plane have",
                    target.signature));
  flat.across = part.across;
  flat.up = part.up;
  return flat;
}

// The number minus the whole number below it, 0 .. 1.
double fraction_of(double x) { return x - std::floor(x); }

// By how much a number is outside of 0 .. bound, where 1 is 0 again.
double outside(double x, double bound) { return x <= bound ? 0 : std::min(x - bound, 1 - x); }

}  // namespace

Grid flat_grid(const GridRequest& request, const Embedding& embedding) {
  if (embedding.space() != Space::plane())
    throw ArgumentError(
        fmt::format("the grid {} is an image of the plane, but the map is onto {}, which is {}; take a grid "
                    "of the sphere, "
                    "or embed into 442 or 2222",
                    name_of(request.kind), embedding.target.signature, embedding.space().name()));
  const std::vector<Isometry> elements = canonical_group_of(embedding, searched_elements).elements();
  Grid grid;
  grid.kind = request.kind;
  grid.space = Space::plane();
  grid.flat = flat_image(elements, embedding.target, request.kind);
  const int height = request.size, width = request.width;
  grid.shape = {height, width};
  grid.points.resize(static_cast<Eigen::Index>(height) * width, 3);
  parallel_for(height, [&](int row) {
    for (int column = 0; column < width; ++column) {
      const Vector3 place(grid.flat.across * (column + 0.5) / width,
                          grid.flat.up * (1 - (row + 0.5) / height), 1);
      grid.points.row(static_cast<Eigen::Index>(row) * width + column) =
          (grid.flat.lattice * place).transpose();
    }
  });
  const double area = grid.flat.across * grid.flat.up * std::abs(grid.flat.lattice.determinant());
  grid.areas = Eigen::VectorXd::Constant(grid.count(), area / grid.count());
  return grid;
}

Vector2d flat_place(const Grid& grid, const Vector3& point) {
  const FlatImage& flat = grid.flat;
  const Matrix3 to_cell = flat.lattice.inverse();
  Vector2d best = Vector2d::Zero();
  double least = std::numeric_limits<double>::infinity();
  for (const Isometry& sheet : flat.sheets) {
    const Vector3 in_cell = to_cell * (sheet * point);
    const Vector2d place(fraction_of(in_cell.x()), fraction_of(in_cell.y()));
    const double away = std::max(outside(place.x(), flat.across), outside(place.y(), flat.up));
    if (away < least) least = away, best = place;
    if (away == 0) break;
  }
  // On a side, rounding may have put it just beyond, or to the opposite side.
  const auto share = [](double x, double bound) {
    return x <= bound ? x / bound : x - bound < 1 - x ? 1 : 0;
  };
  return {share(best.x(), flat.across), share(best.y(), flat.up)};
}

ImagePixel flat_pixel(const Grid& grid, const ImagePixel& pixel) {
  const int height = grid.shape[0], width = grid.shape[1];
  const bool is_inside = pixel.row >= 0 && pixel.row < height && pixel.column >= 0 && pixel.column < width;
  if (is_inside) return pixel;
  const Vector3 place(grid.flat.across * (pixel.column + 0.5) / width,
                      grid.flat.up * (1 - (pixel.row + 0.5) / height), 1);
  const Vector2d inside = flat_place(grid, grid.flat.lattice * place);
  const auto index = [](double share, int count) {
    return std::clamp(static_cast<int>(std::floor(share * count)), 0, count - 1);
  };
  return {0, index(1 - inside.y(), height), index(inside.x(), width)};
}

}  // namespace orbitutte
