// SPDX-License-Identifier: MIT
// Spherical triangles and embeddings built by hand, from nothing but trigonometry: tests compare the library
// with them.
#pragma once

#include <Eigen/Geometry>
#include <cmath>
#include <map>
#include <numbers>
#include <utility>
#include <vector>

#include "orbitutte/orbifold/embedding.h"
#include "orbitutte/orbifold/signature.h"

namespace orbitutte::hand_made {

inline Matrix3 rotation(const Vector3& axis, double angle) {
  return Eigen::AngleAxisd(angle, axis.normalized()).toRotationMatrix();
}

/// The reflection in the plane through 0 with this normal.
inline Matrix3 reflection(const Vector3& normal) {
  return Matrix3::Identity() - 2 * normal * normal.transpose() / normal.squaredNorm();
}

/// A symmetry of the sphere.
inline Isometry symmetry(const Matrix3& matrix) { return Space::sphere().isometry(matrix); }

/// The triangle with angles pi/n1, pi/n2, pi/n3 at a, b, c, counterclockwise from outside; a is the north
/// pole.
struct Triangle {
  Vector3 a, b, c;

  Triangle(int n1, int n2, int n3) : a(Vector3::UnitZ()) {
    const double A = std::numbers::pi / n1, B = std::numbers::pi / n2, C = std::numbers::pi / n3;
    const double ab = std::acos((std::cos(C) + std::cos(A) * std::cos(B)) / (std::sin(A) * std::sin(B)));
    const double ac = std::acos((std::cos(B) + std::cos(A) * std::cos(C)) / (std::sin(A) * std::sin(C)));
    b = {std::sin(ab), 0, std::cos(ab)};
    c = {std::sin(ac) * std::cos(A), std::sin(ac) * std::sin(A), std::cos(ac)};
  }

  Matrix3 mirror_ab() const { return reflection(a.cross(b)); }
  Matrix3 mirror_bc() const { return reflection(b.cross(c)); }
  Matrix3 mirror_ca() const { return reflection(c.cross(a)); }
};

/// A grid of n^2 triangles over the spherical triangle a b c. ab[i] is the vertex i/n of the way from a to b,
/// and so on.
struct TriangleGrid {
  std::vector<int> ab, bc, ca;
};

/// Collects vertices, those at the same place once, and triangles. One tile's worth: seams must be added by
/// hand. The target's canonical frame is the one in which the triangles above lie.
class Builder {
 public:
  Embedding embedding;

  explicit Builder(const ConwaySymbol& symbol) { embedding.target = parse_orbifold(symbol.text()); }

  int vertex(const Vector3& position) {
    const Vector3 p = position.normalized();
    for (int v = 0; v < embedding.positions.rows(); ++v)
      if ((embedding.positions.row(v).transpose() - p).norm() < 1e-9) return v;
    const int v = static_cast<int>(embedding.positions.rows());
    embedding.positions.conservativeResize(v + 1, 3);
    embedding.positions.row(v) = p.transpose();
    embedding.source_vertex.push_back(v);
    return v;
  }

  void face(int a, int b, int c) {
    const Eigen::Index f = embedding.triangles.rows();
    embedding.triangles.conservativeResize(f + 1, 3);
    embedding.triangles.row(f) << a, b, c;
  }

  TriangleGrid triangle(const Vector3& a, const Vector3& b, const Vector3& c, int n) {
    std::map<std::pair<int, int>, int> at;  // i steps towards b, j towards c
    for (int i = 0; i <= n; ++i)
      for (int j = 0; i + j <= n; ++j) at[{i, j}] = vertex((n - i - j) * a + i * b + j * c);
    for (int i = 0; i < n; ++i) {
      for (int j = 0; i + j < n; ++j) {
        face(at[{i, j}], at[{i + 1, j}], at[{i, j + 1}]);
        if (i + j + 2 <= n) face(at[{i + 1, j}], at[{i + 1, j + 1}], at[{i, j + 1}]);
      }
    }
    TriangleGrid grid;
    for (int i = 0; i <= n; ++i) {
      grid.ab.push_back(at[{i, 0}]);
      grid.bc.push_back(at[{n - i, i}]);
      grid.ca.push_back(at[{0, n - i}]);
    }
    return grid;
  }
};

/// *n1 n2 n3: the triangle with three mirrors.
inline Embedding mirror_triangle(int n1, int n2, int n3, int n) {
  const Triangle triangle(n1, n2, n3);
  Builder builder({{}, {n1, n2, n3}, true, false});
  const TriangleGrid grid = builder.triangle(triangle.a, triangle.b, triangle.c, n);
  builder.embedding.seams = {{grid.ab, grid.ab, symmetry(triangle.mirror_ab())},
                             {grid.bc, grid.bc, symmetry(triangle.mirror_bc())},
                             {grid.ca, grid.ca, symmetry(triangle.mirror_ca())}};
  return builder.embedding;
}

/// n1 n2 n3: the triangle and its mirror image across the side c a, glued by rotations about a and c.
inline Embedding rotation_quadrilateral(int n1, int n2, int n3, int n) {
  const Triangle triangle(n1, n2, n3);
  const Vector3 b2 = triangle.mirror_ca() * triangle.b;
  Builder builder({{n1, n2, n3}, {}, false, false});
  const TriangleGrid first = builder.triangle(triangle.a, triangle.b, triangle.c, n);
  const TriangleGrid second = builder.triangle(triangle.a, triangle.c, b2, n);
  const std::vector<int> b2_to_c(second.bc.rbegin(), second.bc.rend());
  const std::vector<int> a_to_b2(second.ca.rbegin(), second.ca.rend());
  builder.embedding.seams = {{a_to_b2, first.ab, symmetry(triangle.mirror_ca() * triangle.mirror_ab())},
                             {b2_to_c, first.bc, symmetry(triangle.mirror_ca() * triangle.mirror_bc())}};
  return builder.embedding;
}

/// Of N*, the sector of the northern hemisphere from the meridian 0 to the meridian 2 pi/N, in k triangles
/// that meet at the pole, each a grid of n^2.
struct Sector {
  Embedding embedding;
  std::vector<int> east, west,
      equator;  ///< pole to equator at 0, pole to equator at 2 pi/N, equator from 0 to 2 pi/N
};

inline Vector3 on_equator(double longitude) { return {std::cos(longitude), std::sin(longitude), 0}; }

inline Sector sector(int N, int k, int n) {
  const double angle = 2 * std::numbers::pi / N;
  Builder builder({{N}, {}, true, false});
  Sector result;
  for (int i = 0; i < k; ++i) {
    const TriangleGrid grid =
        builder.triangle(Vector3::UnitZ(), on_equator(angle * i / k), on_equator(angle * (i + 1) / k), n);
    if (i == 0) result.east = grid.ab;
    if (i == k - 1) result.west.assign(grid.ca.rbegin(), grid.ca.rend());
    result.equator.insert(result.equator.end(), grid.bc.begin() + (i > 0), grid.bc.end());
  }
  result.embedding = builder.embedding;
  return result;
}

/// N*: a sector of the hemisphere, its meridians glued by a rotation, the equator a mirror.
inline Embedding mirror_bounded_cone(int N, int k, int n) {
  const double angle = 2 * std::numbers::pi / N;
  Sector result = sector(N, k, n);
  result.embedding.seams = {{result.west, result.east, symmetry(rotation(Vector3::UnitZ(), angle))},
                            {result.equator, result.equator, symmetry(reflection(Vector3::UnitZ()))}};
  return result.embedding;
}

/// NN: a lune from pole to pole, glued to itself by a rotation.
inline Embedding rotation_lune(int N, int k, int n) {
  const double angle = 2 * std::numbers::pi / N;
  Builder builder({{N, N}, {}, false, false});
  std::vector<int> east, west;
  for (int i = 0; i < k; ++i) {
    const Vector3 p = on_equator(angle * i / k), q = on_equator(angle * (i + 1) / k);
    const TriangleGrid north = builder.triangle(Vector3::UnitZ(), p, q, n);
    const TriangleGrid south = builder.triangle(-Vector3::UnitZ(), q, p, n);
    if (i == 0) {  // from pole to pole, the equator's vertex once
      east = north.ab;
      east.insert(east.end(), south.ca.begin() + 1, south.ca.end());
    }
    if (i == k - 1) {
      west.assign(north.ca.rbegin(), north.ca.rend());
      west.insert(west.end(), south.ab.rbegin() + 1, south.ab.rend());
    }
  }
  builder.embedding.seams = {{west, east, symmetry(rotation(Vector3::UnitZ(), angle))}};
  return builder.embedding;
}

/// 1x: the hemisphere, its equator glued to itself by the antipodal map.
inline Embedding antipodal_hemisphere(int n) {
  Builder builder({{1}, {}, false, true});
  std::vector<int> equator;
  for (int i = 0; i < 4; ++i) {
    const double from = i * std::numbers::pi / 2;
    const TriangleGrid grid =
        builder.triangle(Vector3::UnitZ(), on_equator(from), on_equator(from + std::numbers::pi / 2), n);
    equator.insert(equator.end(), grid.bc.begin(), grid.bc.end() - 1);
  }
  equator.push_back(equator.front());
  builder.embedding.seams = {{{equator.begin(), equator.begin() + 2 * n + 1},
                              {equator.begin() + 2 * n, equator.end()},
                              symmetry(-Matrix3::Identity())}};
  return builder.embedding;
}

}  // namespace orbitutte::hand_made
