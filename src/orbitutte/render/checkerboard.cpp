// SPDX-License-Identifier: MIT
#include "orbitutte/render/checkerboard.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace orbitutte {
namespace {

using Plane = Eigen::Matrix<double, Eigen::Dynamic, 2, Eigen::RowMajor>;

constexpr Rgb dark = {52, 62, 84}, light = {240, 236, 226};

// Conformal, area element 1 at the centre.
Plane seen_from(Space space, const Points& positions, const Vector3& centre) {
  const Isometry centred = space.to_origin(centre);
  Plane plane(positions.rows(), 2);
  for (Eigen::Index v = 0; v < positions.rows(); ++v)
    plane.row(v) = Space::conformal(centred * Vector3(positions.row(v)));
  return plane;
}

double source_area(const Embedding& embedding, const Points& source, Eigen::Index f) {
  const auto corner = [&](int k) -> Vector3 {
    return source.row(embedding.source_vertex[embedding.triangles(f, k)]);
  };
  return 0.5 * (corner(1) - corner(0)).cross(corner(2) - corner(0)).norm();
}

double plane_area(const Embedding& embedding, const Plane& plane, Eigen::Index f) {
  const auto corner = [&](int k) -> Eigen::Vector2d { return plane.row(embedding.triangles(f, k)); };
  const Eigen::Vector2d e = corner(1) - corner(0), g = corner(2) - corner(0);
  return 0.5 * std::abs(e[0] * g[1] - e[1] * g[0]);
}

// The value below which half of the total weight lies.
double weighted_median(const std::vector<float>& values, const std::vector<double>& weights) {
  std::vector<int> order(values.size());
  std::iota(order.begin(), order.end(), 0);
  std::sort(order.begin(), order.end(), [&](int a, int b) { return values[a] < values[b]; });
  const double half = 0.5 * std::accumulate(weights.begin(), weights.end(), 0.0);
  double sum = 0;
  for (const int i : order)
    if ((sum += weights[i]) >= half) return values[i];
  return 1;
}

// -1 or 1 by turns.
double parity(const Eigen::Vector2d& place) {
  return std::fmod(std::abs(std::floor(place[0]) + std::floor(place[1])), 2.0) == 1 ? -1 : 1;
}

// -1 .. 1. Where squares are `enlarged` on the source, boards of four times finer squares come in one by one,
// each stronger than the coarser ones.
double board(Eigen::Vector2d place, double enlarged) {
  double value = parity(place), total = 1;
  constexpr double most = 6;  // where the image has no area, all are too coarse
  for (double level = std::min(std::log(enlarged / 1.5) / std::log(4.0), most); level > 0; level -= 1) {
    const double weight = std::min(level, 1.0), coarser = 1 - 0.7 * weight;
    place *= 4;
    value = coarser * value + weight * parity(place);
    total = coarser * total + weight;
  }
  return value / total;
}

}  // namespace

std::vector<float> sides_on_source(const Embedding& embedding, const Points& source, const Plane& plane) {
  std::vector<float> sides(embedding.triangles.rows(), std::numeric_limits<float>::infinity());
  for (Eigen::Index f = 0; f < embedding.triangles.rows(); ++f) {
    const double area = plane_area(embedding, plane, f);
    if (area > 0) sides[f] = static_cast<float>(std::sqrt(source_area(embedding, source, f) / area));
  }
  return sides;
}

Checkerboard::Checkerboard(const Embedding& embedding, const Points& source, const Vector3& centre,
                           double side)
    : coordinates_(seen_from(embedding.space(), embedding.positions, centre)),
      faces_(embedding.triangles),
      side_(side),
      side_on_source_(sides_on_source(embedding, source, coordinates_)) {
  std::vector<double> areas(faces_.rows());
  for (Eigen::Index f = 0; f < faces_.rows(); ++f) areas[f] = source_area(embedding, source, f);
  const double square = side / weighted_median(side_on_source_, areas);
  coordinates_ /= square;
  for (float& on_source : side_on_source_) on_source *= static_cast<float>(square);
}

Colour Checkerboard::colour(const Hit& hit, double pixel) const {
  const auto corner = faces_.row(hit.primitive);
  const Eigen::Vector2d place = (1 - hit.u - hit.v) * coordinates_.row(corner[0]) +
                                hit.u * coordinates_.row(corner[1]) + hit.v * coordinates_.row(corner[2]);
  const double side = side_on_source_[hit.primitive];
  const double contrast = std::clamp(side / pixel - 0.75, 0.0, 1.0);
  return mix(linear(dark), linear(light),
             static_cast<float>(0.5 + 0.5 * contrast * board(place, side / side_)));
}

}  // namespace orbitutte
