// SPDX-License-Identifier: MIT
#include "orbitutte/report/overlay_distortion.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

namespace orbitutte {
namespace {

// The products of the edges e = b - a and f = c - a of a triangle: e e, e f, f f.
struct EdgeProducts {
  EdgeProducts(const Triangles& triangles, Eigen::Index t, const Points& at) {
    const Vector3 e = at.row(triangles(t, 1)) - at.row(triangles(t, 0)),
                  f = at.row(triangles(t, 2)) - at.row(triangles(t, 0));
    ee = e.squaredNorm();
    ef = e.dot(f);
    ff = f.squaredNorm();
    root = e.cross(f).norm();
  }

  double ee = 0, ef = 0, ff = 0;

  // The root of ee ff - ef^2: twice the area.
  double root = 0;
};

// Of the linear map that takes the edges of `a` to those of `b`, with G and H the matrices of the products:
// s t = sqrt(det H / det G), s^2 + t^2 = tr(G^-1 H). `scale`: by what areas are multiplied.
PieceDistortion distortion_between(const EdgeProducts& a, const EdgeProducts& b, double scale) {
  const double area = scale * b.root / a.root,
               squares = scale * (a.ff * b.ee - 2 * a.ef * b.ef + a.ee * b.ff) / (a.root * a.root),
               energy = (squares + squares / (area * area)) / 4;
  if (std::isfinite(energy)) return {area, energy};
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  return {nan, nan};
}

double area_sum(const Triangles& triangles, const Points& at) {
  double sum = 0;
  for (Eigen::Index t = 0; t < triangles.rows(); ++t) sum += EdgeProducts(triangles, t, at).root;
  return sum;
}

// What a share of the values does not exceed; 1 if there are none.
double share_of_values(std::vector<double> values, double share) {
  if (values.empty()) return 1;
  const auto at =
      values.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

}  // namespace

std::vector<PieceDistortion> piece_distortions(const Triangles& triangles, const Points& from,
                                               const Points& to) {
  const double scale = area_sum(triangles, from) / area_sum(triangles, to);
  std::vector<PieceDistortion> pieces;
  pieces.reserve(static_cast<std::size_t>(triangles.rows()));
  for (Eigen::Index t = 0; t < triangles.rows(); ++t)
    pieces.push_back(
        distortion_between(EdgeProducts(triangles, t, from), EdgeProducts(triangles, t, to), scale));
  return pieces;
}

std::vector<double> piece_log_areas(const std::vector<PieceDistortion>& pieces) {
  std::vector<double> values;
  values.reserve(pieces.size());
  for (const PieceDistortion& piece : pieces)
    if (std::isfinite(std::log2(piece.area))) values.push_back(std::log2(piece.area));
  return values;
}

std::vector<double> piece_energies(const std::vector<PieceDistortion>& pieces) {
  std::vector<double> values;
  values.reserve(pieces.size());
  for (const PieceDistortion& piece : pieces)
    if (std::isfinite(piece.symmetric_dirichlet)) values.push_back(piece.symmetric_dirichlet);
  return values;
}

ColourScale map_area_scale(const std::vector<double>& values) {
  ColourScale scale = colour_scale(Measure::area, values);
  scale.axis.title = "share of B's area over share of A's";
  return scale;
}

ColourScale map_energy_scale(const std::vector<double>& values) {
  static constexpr double ends[] = {1.5, 2, 3, 5, 10, 20};
  const double wanted = share_of_values(values, 0.9);
  double end = ends[0];
  for (const double each : ends)
    if ((end = each) >= wanted) break;
  ColourScale scale = {Measure::angle, {"symmetric Dirichlet energy, 1 for an isometry", 1, end, {}}};
  constexpr int steps = 4;
  for (int k = 0; k <= steps; ++k) {
    const double value = 1 + (end - 1) * k / steps;
    scale.axis.ticks.push_back({value, fmt::format("{:.4g}", value)});
  }
  scale.axis.ticks.back().text.insert(0, "≥ ");
  return scale;
}

}  // namespace orbitutte
