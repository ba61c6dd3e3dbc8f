// SPDX-License-Identifier: MIT
// The octahedral chart: E. Praun, H. Hoppe, "Spherical parametrization and remeshing", ACM TOG 22 (2003).
#include "orbitutte/export/texture_chart.h"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <span>

#include "orbitutte/geometry/space.h"

namespace orbitutte {
namespace {

using Eigen::Vector2d;
using std::numbers::pi;

std::array<Vector3, 3> corners(const Embedding& embedding, Eigen::Index f) {
  const auto v = embedding.triangles.row(f);
  return {embedding.positions.row(v[0]), embedding.positions.row(v[1]), embedding.positions.row(v[2])};
}

// Takes the middle of the tile to (0, 0, 1), and its wider direction to the x axis.
Isometry frame(const Embedding& embedding) {
  const Space space = embedding.space();
  Vector3 sum = Vector3::Zero();
  for (Eigen::Index f = 0; f < embedding.triangles.rows(); ++f) {
    const auto [a, b, c] = corners(embedding, f);
    sum += std::abs(space.area(a, b, c)) * (a + b + c) / 3;
  }
  const Isometry centred = space.to_origin(sum.norm() > 0 ? space.retract(sum) : Space::origin());
  Eigen::Matrix2d spread = Eigen::Matrix2d::Zero();
  for (Eigen::Index f = 0; f < embedding.triangles.rows(); ++f) {
    const auto [a, b, c] = corners(embedding, f);
    const Vector2d middle = space.flatten(centred * Vector3((a + b + c) / 3));
    spread += std::abs(space.area(a, b, c)) * middle * middle.transpose();
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> axes(spread);
  Vector2d wide = axes.eigenvectors().col(1);
  if (wide[std::abs(wide[0]) < std::abs(wide[1])] < 0) wide = -wide;
  return space.rotation(Space::origin(), -std::atan2(wide.y(), wide.x())) * centred;
}

// Longitude from the date line and latitude from the south pole, in turns. The poles lie on the y axis.
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

// Moves and scales the smallest square that holds the corners of all faces to the unit square.
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

// Gives a corner a pair of its own, a turn further to the right, if it lies more than half a turn to the left
// of its face's rightmost corner.
void reach_over_date_line(const Embedding& embedding, TextureCoordinates& result) {
  std::map<int, int> further;
  std::vector<Eigen::RowVector2d> added;
  const int vertices = static_cast<int>(result.uv.rows());
  const FaceView faces = embedding.faces();
  std::size_t corner = 0;
  for (int f = 0; f < faces.count(); ++f) {
    double right = 0;
    for (const int v : faces[f]) right = std::max(right, result.uv(v, 0));
    for (const int v : faces[f]) {
      int& row = result.of_corner[corner++];
      if (right - result.uv(v, 0) <= 0.5) continue;
      const auto [at, is_new] = further.try_emplace(v, vertices + static_cast<int>(added.size()));
      if (is_new) added.emplace_back(result.uv(v, 0) + 1, result.uv(v, 1));
      row = at->second;
    }
  }
  result.uv.conservativeResize(vertices + static_cast<Eigen::Index>(added.size()), 2);
  for (std::size_t k = 0; k < added.size(); ++k)
    result.uv.row(vertices + static_cast<Eigen::Index>(k)) = added[k];
}

// Does the face cross one of the half planes behind the octahedron along which the octahedron was unfolded?
bool is_torn(const Points& seen, std::span<const int> face) {
  for (std::size_t k = 0; k < face.size(); ++k) {
    const Vector3 a = seen.row(face[k]), b = seen.row(face[(k + 1) % face.size()]);
    if (std::min(a.z(), b.z()) < 0 && (a.x() * b.x() < 0 || a.y() * b.y() < 0)) return true;
  }
  return false;
}

double plane_area(const Vector2d& a, const Vector2d& b, const Vector2d& c) {
  const Vector2d e = b - a, g = c - a;
  return (e.x() * g.y() - e.y() * g.x()) / 2;
}

// Both areas of a face are sums over the fan from its first corner, with signs, so that parts outside of the
// face cancel.
struct FaceAreas {
  double flat = 0;  // in the square
  double round = 0;
};

FaceAreas face_areas(const Embedding& embedding, const Eigen::MatrixX2d& uv, std::span<const int> face,
                     const int* rows) {
  const auto on_sphere = [&](std::size_t k) { return Vector3(embedding.positions.row(face[k])); };
  const auto in_square = [&](std::size_t k) { return Vector2d(uv.row(rows[k])); };
  FaceAreas areas;
  for (std::size_t k = 2; k < face.size(); ++k) {
    areas.flat += plane_area(in_square(0), in_square(k - 1), in_square(k));
    areas.round += embedding.space().area(on_sphere(0), on_sphere(k - 1), on_sphere(k));
  }
  areas.flat = std::abs(areas.flat);
  return areas;
}

double max_area_distortion(const Embedding& embedding, const TextureCoordinates& coordinates) {
  const FaceView faces = embedding.faces();
  std::vector<FaceAreas> areas;
  FaceAreas sum;
  const int* rows = coordinates.of_corner.data();
  for (int f = 0; f < faces.count(); rows += faces[f].size(), ++f) {
    areas.push_back(face_areas(embedding, coordinates.uv, faces[f], rows));
    sum.flat += areas.back().flat;
    sum.round += areas.back().round;
  }
  double worst = 1;
  const double scale = sum.flat / sum.round;
  for (const FaceAreas& face : areas) {
    const double ratio = face.flat / (scale * face.round);
    if (ratio > 0 && std::isfinite(ratio)) worst = std::max({worst, ratio, 1 / ratio});
  }
  return worst;
}

// The cut vertex of every corner.
std::vector<int> corner_vertices(const FaceView& faces) {
  std::vector<int> vertices;
  for (int f = 0; f < faces.count(); ++f) vertices.insert(vertices.end(), faces[f].begin(), faces[f].end());
  return vertices;
}

}  // namespace

namespace {

// Has no chart in one piece.
bool is_whole_sphere(const Target& target) { return target.group_order == 1 && !target.is_polygon(); }

void require_chart(const Target& target, TextureChart chart) {
  if (chart != TextureChart::stereographic && !target.space.is_closed())
    throw ArgumentError(
        fmt::format("the {} chart is one of the sphere, but {} is {}; take stereographic, which "
                    "is the plane itself there",
                    name_of(chart), target.signature, target.space.name()));
  if (chart == TextureChart::stereographic && is_whole_sphere(target))
    throw ArgumentError(
        "the stereographic chart lays one point of the whole sphere at infinity; take equirectangular or "
        "octahedral");
}

}  // namespace

TextureChart suitable_chart(const Embedding& embedding) {
  return is_whole_sphere(embedding.target) ? TextureChart::equirectangular : TextureChart::stereographic;
}

TextureCoordinates texture_coordinates(const Embedding& embedding, TextureChart chart) {
  require_chart(embedding.target, chart);
  const Isometry seen_from = is_whole_sphere(embedding.target) ? Isometry() : frame(embedding);
  const Points seen = seen_from.on_rows(embedding.positions);
  TextureCoordinates result;
  result.uv.resize(seen.rows(), 2);
  for (Eigen::Index v = 0; v < seen.rows(); ++v) {
    const Vector3 p = seen.row(v);
    result.uv.row(v) = chart == TextureChart::stereographic     ? Space::conformal(p)
                       : chart == TextureChart::equirectangular ? equirectangular(p)
                                                                : octahedral(p);
  }
  const FaceView faces = embedding.faces();
  result.of_corner = corner_vertices(faces);
  if (chart == TextureChart::stereographic) fit_into_unit_square(result.of_corner, result.uv);
  if (chart == TextureChart::equirectangular) reach_over_date_line(embedding, result);
  for (int f = 0; f < faces.count() && chart == TextureChart::octahedral; ++f)
    result.torn_faces += is_torn(seen, faces[f]);
  result.max_area_distortion = max_area_distortion(embedding, result);
  return result;
}

}  // namespace orbitutte
