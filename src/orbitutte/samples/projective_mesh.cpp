// SPDX-License-Identifier: MIT
// A vertex is a pair of antipodes, stored as either of the two. To divide a face, antipodes are chosen that
// lie close together: neighbours are less than a right angle apart, so the sign of their product decides.
#include "orbitutte/samples/projective_mesh.h"

#include <Eigen/Geometry>
#include <array>
#include <cmath>
#include <cstdlib>
#include <numbers>
#include <utility>
#include <vector>

#include "orbitutte/mesh/connectivity.h"
#include "orbitutte/parallel.h"

namespace orbitutte {
namespace {

// p or -p, whichever is nearer to `to`.
Vector3 aligned(const Vector3& p, const Vector3& to) { return p.dot(to) < 0 ? Vector3(-p) : p; }

struct Triangle {
  Vector3 a, b, c;
};

Triangle aligned_corners(const Mesh& mesh, int f) {
  const Vector3 a = mesh.V.row(mesh.F(f, 0));
  return {a, aligned(mesh.V.row(mesh.F(f, 1)), a), aligned(mesh.V.row(mesh.F(f, 2)), a)};
}

// The six axes through opposite vertices of an icosahedron, and one of every two opposite faces, with the
// centre of one at the north pole. Three axes are a face if antipodes can be chosen on them that lie close
// together.
Mesh half_icosahedron() {
  constexpr double golden = std::numbers::phi;
  Mesh result;
  result.V.resize(6, 3);
  result.V << 0, 1, golden, 0, -1, golden, golden, 0, 1, golden, 0, -1, 1, golden, 0, -1, golden, 0;
  const auto up = Eigen::Quaterniond::FromTwoVectors(Vector3(1, 1, 1), Vector3::UnitZ());
  result.V = result.V.rowwise().normalized() * up.toRotationMatrix().transpose();
  result.F.resize(10, 3);
  int f = 0;
  const auto product = [&](int i, int j) { return result.V.row(i).dot(result.V.row(j)); };
  for (int i = 0; i < 6; ++i) {
    for (int j = i + 1; j < 6; ++j) {
      for (int k = j + 1; k < 6; ++k)
        if (product(i, j) * product(j, k) * product(k, i) > 0) result.F.row(f++) << i, j, k;
    }
  }
  return result;
}

// The vertices of a mesh whose faces are divided by k: first those of the mesh, then k - 1 on every edge,
// from its lower end to its upper one, then those inside the faces.
class DividedVertices {
 public:
  DividedVertices(const Mesh& mesh, int k)
      : mesh_(mesh),
        connectivity_(connectivity_of(mesh.F, static_cast<int>(mesh.V.rows()))),
        k_(k),
        first_inside_(static_cast<int>(mesh.V.rows() + connectivity_.edges.size() * (k - 1))) {}

  int count() const { return first_inside_ + static_cast<int>(mesh_.F.rows()) * inside_a_face(); }

  // The vertex of face f that lies i steps from its first corner towards the second, then j towards the
  // third.
  int operator()(int f, int i, int j) const {
    const std::array<int, 3> weight = {k_ - i - j, i, j};
    for (int c = 0; c < 3; ++c)
      if (weight[c] == k_) return mesh_.F(f, c);
    for (int c = 0; c < 3; ++c) {
      const int next = (c + 1) % 3;
      if (weight[c] + weight[next] == k_) return on_edge(3 * f + c, weight[next]);
    }
    return first_inside_ + f * inside_a_face() + (i + j - 1) * (i + j - 2) / 2 + j - 1;
  }

 private:
  int inside_a_face() const { return (k_ - 1) * (k_ - 2) / 2; }

  int on_edge(int h, int steps) const {
    const int from_lower = halfedge_origin(mesh_.F, h) < halfedge_target(mesh_.F, h) ? steps : k_ - steps;
    return static_cast<int>(mesh_.V.rows()) + connectivity_.edge_of[h] * (k_ - 1) + from_lower - 1;
  }

  const Mesh& mesh_;
  Connectivity connectivity_;
  int k_, first_inside_;
};

// Divides every face into k^2.
Mesh divided(const Mesh& mesh, int k) {
  const DividedVertices vertex(mesh, k);
  Mesh result = {Points(vertex.count(), 3), Triangles(mesh.F.rows() * k * k, 3)};
  Eigen::Index next = 0;
  for (int f = 0; f < static_cast<int>(mesh.F.rows()); ++f) {
    const auto [a, b, c] = aligned_corners(mesh, f);
    for (int i = 0; i <= k; ++i) {
      for (int j = 0; i + j <= k; ++j) {
        result.V.row(vertex(f, i, j)) = ((k - i - j) * a + i * b + j * c).normalized();
        if (i + j == k) continue;
        result.F.row(next++) << vertex(f, i, j), vertex(f, i + 1, j), vertex(f, i, j + 1);
        if (i + j + 1 < k)
          result.F.row(next++) << vertex(f, i + 1, j), vertex(f, i + 1, j + 1), vertex(f, i, j + 1);
      }
    }
  }
  return result;
}

// Divides every face into three at its centre, and replaces every old edge by the edge between the centres on
// its two sides. Each new edge has one face on either side. L. Kobbelt, sqrt(3)-subdivision (2000).
Mesh tripled(const Mesh& mesh) {
  const int n = static_cast<int>(mesh.V.rows()), m = static_cast<int>(mesh.F.rows());
  const Connectivity connectivity = connectivity_of(mesh.F, n);
  Mesh result = {Points(n + m, 3), Triangles(3 * m, 3)};
  result.V.topRows(n) = mesh.V;
  for (int f = 0; f < m; ++f) {
    const auto [a, b, c] = aligned_corners(mesh, f);
    result.V.row(n + f) = (a + b + c).normalized();
  }
  Eigen::Index next = 0;
  for (int h = 0; h < 3 * m; ++h) {
    const int other = connectivity.opposite[h];
    if (other < h) continue;
    for (const int v : {halfedge_origin(mesh.F, h), halfedge_target(mesh.F, h)})
      result.F.row(next++) << v, n + h / 3, n + other / 3;
  }
  return result;
}

// Turns every face so that it runs counterclockwise as seen from outside, for the antipode whose centre lies
// above the equator.
void turn_counterclockwise(Mesh& mesh) {
  for (int f = 0; f < static_cast<int>(mesh.F.rows()); ++f) {
    const auto [a, b, c] = aligned_corners(mesh, f);
    const double volume = a.dot(b.cross(c)), height = (a + b + c).z();
    if ((volume < 0) != (height < 0)) std::swap(mesh.F(f, 1), mesh.F(f, 2));
  }
}

struct Division {
  int k = 1;
  bool triples = false;

  int faces() const { return (triples ? 30 : 10) * k * k; }
};

// The k for which `unit` k^2 is nearest to `faces`.
int nearest_division(int faces, int unit) {
  const int below = std::max(1, static_cast<int>(std::sqrt(faces / static_cast<double>(unit))));
  const auto off = [&](int k) { return std::abs(unit * k * k - faces); };
  return off(below + 1) < off(below) ? below + 1 : below;
}

Division division_for(int faces) {
  const Division plain = {nearest_division(faces, 10), false}, triple = {nearest_division(faces, 30), true};
  const int off = std::abs(plain.faces() - faces), triple_off = std::abs(triple.faces() - faces);
  if (off != triple_off) return off < triple_off ? plain : triple;
  return plain.faces() < triple.faces() ? plain : triple;
}

}  // namespace

int projective_face_count(int faces) { return division_for(faces).faces(); }

Mesh projective_mesh(EvenMap map, int faces) {
  const Division division = division_for(faces);
  Mesh mesh = divided(half_icosahedron(), division.k);
  if (division.triples) mesh = tripled(mesh);
  turn_counterclockwise(mesh);
  parallel_ranges(static_cast<int>(mesh.V.rows()), [&](int begin, int end) {
    for (int v = begin; v < end; ++v) mesh.V.row(v) = map(mesh.V.row(v));
  });
  return mesh;
}

}  // namespace orbitutte
