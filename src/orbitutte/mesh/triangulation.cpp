// SPDX-License-Identifier: MIT
#include "orbitutte/mesh/triangulation.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <queue>
#include <tuple>

namespace orbitutte {
namespace {

// One polygon on the way to triangles: a ring of the corners that are left.
class Clipping {
 public:
  Clipping(const PolygonMesh& mesh, int face)
      : mesh_(mesh),
        first_(mesh.face_start[face]),
        left_(mesh.face_degree(face)),
        previous_(left_),
        next_(left_),
        normal_(Vector3::Zero()) {
    for (int k = 0; k < left_; ++k) {
      previous_[k] = k == 0 ? left_ - 1 : k - 1;
      next_[k] = k == left_ - 1 ? 0 : k + 1;
      normal_ += (position(k) - position(0)).cross(position(next_[k]) - position(k));
    }
  }

  // Calls add(i, j, k) for every triangle, by indices into the mesh's corners.
  template <typename Add>
  void run(const Add& add) {
    if (left_ > 4)
      for (int k = 0; k < static_cast<int>(next_.size()); ++k) push(k);
    while (left_ > 4) {
      const auto [quality, minus_corner] = best_.top();
      best_.pop();
      const int corner = -minus_corner;
      if (next_[corner] < 0 || quality != quality_at(corner)) continue;  // no longer so
      add(first_ + previous_[corner], first_ + corner, first_ + next_[corner]);
      cut_off(corner);
    }
    finish(add);
  }

 private:
  Vector3 position(int k) const { return mesh_.V.row(mesh_.corners[first_ + k]); }

  // Area over the sum of the squared sides, but for a factor common to the polygon's triangles; negative if
  // the triangle runs against the polygon.
  double quality(int i, int j, int k) const {
    const Vector3 a = position(j) - position(i), b = position(k) - position(j);
    const double quality =
        normal_.dot(a.cross(b)) / (a.squaredNorm() + b.squaredNorm() + (a + b).squaredNorm());
    return std::isfinite(quality) ? quality : 0.0;
  }
  double quality_at(int corner) const { return quality(previous_[corner], corner, next_[corner]); }

  void push(int corner) { best_.emplace(quality_at(corner), -corner); }

  void cut_off(int corner) {
    const int before = previous_[corner], behind = next_[corner];
    next_[before] = behind;
    previous_[behind] = before;
    next_[corner] = -1;
    --left_;
    push(before);
    push(behind);
  }

  template <typename Add>
  void finish(const Add& add) const {
    int i = 0;
    while (next_[i] < 0) ++i;
    const int j = next_[i], k = next_[j], l = next_[k];
    if (std::min(quality(i, j, k), quality(k, l, i)) >= std::min(quality(j, k, l), quality(l, i, j))) {
      add(first_ + i, first_ + j, first_ + k);
      add(first_ + k, first_ + l, first_ + i);
    } else {
      add(first_ + j, first_ + k, first_ + l);
      add(first_ + l, first_ + i, first_ + j);
    }
  }

  const PolygonMesh& mesh_;
  const int first_;
  int left_;
  std::vector<int> previous_, next_;                  // of each corner; -1 behind one that is cut off
  Vector3 normal_;                                    // twice the vector area
  std::priority_queue<std::pair<double, int>> best_;  // quality, minus the corner: the first of equal ones
};

// A half-edge by what it shares with the opposite one; the half-edges of diagonals belong to a face.
struct Side {
  int lower, upper, face;
  int halfedge;

  bool same_edge(const Side& other) const {
    return lower == other.lower && upper == other.upper && face == other.face;
  }
  auto key() const { return std::tuple(lower, upper, face, halfedge); }
};

std::vector<Side> sorted_sides(const PolygonMesh& mesh, const Triangles& division) {
  std::vector<Side> sides;
  sides.reserve(division.size());
  int face = 0;
  for (int h = 0; h < static_cast<int>(division.size()); ++h) {
    const int from = halfedge_origin(division, h), to = halfedge_target(division, h);
    while (from >= mesh.face_start[face + 1]) ++face;
    const int next = from + 1 < mesh.face_start[face + 1] ? from + 1 : mesh.face_start[face];
    const auto [lower, upper] = std::minmax(mesh.corners[from], mesh.corners[to]);
    sides.push_back({lower, upper, to == next ? -1 : face, h});
  }
  std::sort(sides.begin(), sides.end(), [](const Side& a, const Side& b) { return a.key() < b.key(); });
  return sides;
}

}  // namespace

bool is_triangle_mesh(const PolygonMesh& mesh) {
  for (int f = 0; f < mesh.face_count(); ++f)
    if (mesh.face_degree(f) != 3) return false;
  return true;
}

Triangles triangulate(const PolygonMesh& mesh) {
  Triangles result(static_cast<int>(mesh.corners.size()) - 2 * mesh.face_count(), 3);
  int row = 0;
  for (int f = 0; f < mesh.face_count(); ++f) {
    const auto add = [&](int i, int j, int k) { result.row(row++) << i, j, k; };
    if (const int first = mesh.face_start[f]; mesh.face_degree(f) == 3) {
      add(first, first + 1, first + 2);
    } else {
      Clipping(mesh, f).run(add);
    }
  }
  return result;
}

Triangles fan_triangles(const Polygons& polygons) {
  Triangles result(static_cast<int>(polygons.corners.size()) - 2 * polygons.count(), 3);
  int row = 0;
  for (int f = 0; f < polygons.count(); ++f)
    for (int c = polygons.start[f] + 2; c < polygons.start[f + 1]; ++c)
      result.row(row++) << polygons.start[f], c - 1, c;
  return result;
}

Triangles triangles_on_vertices(const Triangles& division, const std::vector<int>& corners) {
  return division.unaryExpr([&](int c) { return corners[c]; });
}

Connectivity connectivity_of(const PolygonMesh& mesh, const Triangles& division) {
  if (is_triangle_mesh(mesh))
    return connectivity_of(triangles_on_vertices(division, mesh.corners), mesh.vertex_count());
  const std::vector<Side> sides = sorted_sides(mesh, division);
  Connectivity result;
  result.edge_of.resize(sides.size());
  result.opposite.assign(sides.size(), -1);
  for (std::size_t k = 0; k < sides.size(); ++k) {
    const Side& side = sides[k];
    const bool again = k > 0 && side.same_edge(sides[k - 1]), is_diagonal = side.face >= 0;
    if (!again && !is_diagonal) result.edges.push_back({side.lower, side.upper});
    result.edge_of[side.halfedge] = is_diagonal ? -1 : static_cast<int>(result.edges.size()) - 1;
    if (!again) continue;
    result.opposite[side.halfedge] = sides[k - 1].halfedge;
    result.opposite[sides[k - 1].halfedge] = side.halfedge;
  }
  return result;
}

}  // namespace orbitutte
