// SPDX-License-Identifier: MIT
// The octahedral chart: E. Praun, H. Hoppe, "Spherical parametrization and remeshing", ACM TOG 22 (2003).
#include "orbitutte/output/texture_chart.h"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>

#include "orbitutte/verify/spherical_triangle.h"

namespace orbitutte {
namespace {

using Eigen::Vector2d;
using std::numbers::pi;

std::array<Vector3, 3> corners(const Embedding& embedding, Eigen::Index f) {
  const auto v = embedding.faces.row(f);
  return {embedding.positions.row(v[0]), embedding.positions.row(v[1]), embedding.positions.row(v[2])};
}

// The rows of a rotation that takes the middle of the tile to the z axis, and the direction in which it is
// wider to the x axis.
Matrix3 frame(const Embedding& embedding) {
  Vector3 sum = Vector3::Zero();
  Matrix3 spread = Matrix3::Zero();
  for (Eigen::Index f = 0; f < embedding.faces.rows(); ++f) {
    const auto [a, b, c] = corners(embedding, f);
    const double area = std::abs(signed_area(a, b, c));
    const Vector3 middle = (a + b + c) / 3;
    sum += area * middle;
    spread += area * middle * middle.transpose();
  }
  const Vector3 z = sum.norm() > 0 ? Vector3(sum.normalized()) : Vector3(Vector3::UnitZ());
  const Matrix3 across = Matrix3::Identity() - z * z.transpose();
  const Eigen::SelfAdjointEigenSolver<Matrix3> axes(across * spread * across);
  Vector3 x = across * axes.eigenvectors().col(2);
  x = x.norm() > 0.5 ? x.normalized() : z.unitOrthogonal();
  Eigen::Index largest = 0;
  x.cwiseAbs().maxCoeff(&largest);
  if (x[largest] < 0) x = -x;
  Matrix3 rows;
  rows << x.transpose(), z.cross(x).transpose(), z.transpose();
  return rows;
}

Vector2d stereographic(const Vector3& p) { return p.head<2>() / std::max(1 + p.z(), 1e-12); }

// In turns: longitude from the date line, latitude from the south pole; the y axis is the poles'.
Vector2d equirectangular(const Vector3& p) {
  return {0.5 + std::atan2(p.x(), p.z()) / (2 * pi), 0.5 + std::asin(std::clamp(p.y(), -1.0, 1.0)) / pi};
}

double sign(double x) { return x < 0 ? -1 : 1; }

Vector2d octahedral(const Vector3& p) {
  const Vector2d q = p.head<2>() / p.lpNorm<1>();
  const Vector2d folded((1 - std::abs(q.y())) * sign(q.x()), (1 - std::abs(q.x())) * sign(q.y()));
  const Vector2d inner = p.z() >= 0 ? q : folded;
  return (inner + Vector2d::Ones()) / 2;
}

// The least square that holds the corners of all faces, moved to the unit square.
void fit_into_unit_square(const std::vector<int>& of_corner, Eigen::MatrixX2d& uv) {
  if (of_corner.empty()) return;
  Eigen::RowVector2d low = uv.row(of_corner[0]), high = low;
  for (const int row : of_corner) {
    low = low.cwiseMin(uv.row(row));
    high = high.cwiseMax(uv.row(row));
  }
  const double side = std::max((high - low).maxCoeff(), 1e-300);
  uv.rowwise() -= (low + high) / 2;
  uv /= side;
  uv.array() += 0.5;
}

// Corners more than half a turn to the left of their face's rightmost one get a pair of their own, a turn
// further.
void reach_over_date_line(const Embedding& embedding, TextureCoordinates& result) {
  std::map<int, int> further;
  std::vector<Eigen::RowVector2d> added;
  const int vertices = static_cast<int>(result.uv.rows());
  for (Eigen::Index f = 0; f < embedding.faces.rows(); ++f) {
    const auto v = embedding.faces.row(f);
    const double right = std::max({result.uv(v[0], 0), result.uv(v[1], 0), result.uv(v[2], 0)});
    for (int k = 0; k < 3; ++k) {
      if (right - result.uv(v[k], 0) <= 0.5) continue;
      const auto [at, is_new] = further.try_emplace(v[k], vertices + static_cast<int>(added.size()));
      if (is_new) added.emplace_back(result.uv(v[k], 0) + 1, result.uv(v[k], 1));
      result.of_corner[3 * f + k] = at->second;
    }
  }
  result.uv.conservativeResize(vertices + static_cast<Eigen::Index>(added.size()), 2);
  for (std::size_t k = 0; k < added.size(); ++k)
    result.uv.row(vertices + static_cast<Eigen::Index>(k)) = added[k];
}

// Does the face cross one of the half planes behind the octahedron along which it was unfolded?
bool is_torn(const std::array<Vector3, 3>& p) {
  for (int k = 0; k < 3; ++k) {
    const Vector3 &a = p[k], &b = p[(k + 1) % 3];
    if (std::min(a.z(), b.z()) < 0 && (a.x() * b.x() < 0 || a.y() * b.y() < 0)) return true;
  }
  return false;
}

double plane_area(const Vector2d& a, const Vector2d& b, const Vector2d& c) {
  const Vector2d e = b - a, g = c - a;
  return std::abs(e.x() * g.y() - e.y() * g.x()) / 2;
}

double max_area_distortion(const Embedding& embedding, const TextureCoordinates& coordinates) {
  const Eigen::Index m = embedding.faces.rows();
  Eigen::VectorXd flat(m), round(m);
  for (Eigen::Index f = 0; f < m; ++f) {
    const auto [a, b, c] = corners(embedding, f);
    round[f] = signed_area(a, b, c);
    const auto at = [&](int k) { return Vector2d(coordinates.uv.row(coordinates.of_corner[3 * f + k])); };
    flat[f] = plane_area(at(0), at(1), at(2));
  }
  double worst = 1;
  const double scale = flat.sum() / round.sum();
  for (Eigen::Index f = 0; f < m; ++f) {
    const double ratio = flat[f] / (scale * round[f]);
    if (ratio > 0 && std::isfinite(ratio)) worst = std::max({worst, ratio, 1 / ratio});
  }
  return worst;
}

}  // namespace

std::string name(TextureChart chart) {
  switch (chart) {
    case TextureChart::stereographic:
      return "stereographic";
    case TextureChart::equirectangular:
      return "equirectangular";
    case TextureChart::octahedral:
      return "octahedral";
  }
  return {};
}

TextureChart parse_texture_chart(const std::string& text) {
  for (const TextureChart chart :
       {TextureChart::stereographic, TextureChart::equirectangular, TextureChart::octahedral})
    if (name(chart) == text) return chart;
  throw ArgumentError(
      fmt::format("the chart is '{}'; it may be stereographic, equirectangular or octahedral", text));
}

TextureCoordinates texture_coordinates(const Embedding& embedding, TextureChart chart) {
  const Points seen = embedding.positions * frame(embedding).transpose();
  TextureCoordinates result;
  result.uv.resize(seen.rows(), 2);
  for (Eigen::Index v = 0; v < seen.rows(); ++v) {
    const Vector3 p = seen.row(v);
    result.uv.row(v) = chart == TextureChart::stereographic     ? stereographic(p)
                       : chart == TextureChart::equirectangular ? equirectangular(p)
                                                                : octahedral(p);
  }
  result.of_corner.assign(embedding.faces.data(), embedding.faces.data() + embedding.faces.size());
  if (chart == TextureChart::stereographic) fit_into_unit_square(result.of_corner, result.uv);
  if (chart == TextureChart::equirectangular) reach_over_date_line(embedding, result);
  for (Eigen::Index f = 0; f < embedding.faces.rows() && chart == TextureChart::octahedral; ++f) {
    const auto v = embedding.faces.row(f);
    result.torn_faces += is_torn({seen.row(v[0]), seen.row(v[1]), seen.row(v[2])});
  }
  result.max_area_distortion = max_area_distortion(embedding, result);
  return result;
}

}  // namespace orbitutte
