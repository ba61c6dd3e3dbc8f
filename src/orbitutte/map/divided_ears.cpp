// SPDX-License-Identifier: MIT
#include "orbitutte/map/divided_ears.h"

#include <algorithm>
#include <set>
#include <utility>

#include "orbitutte/geometry/precise_isometry.h"
#include "orbitutte/mesh/connectivity.h"
#include "orbitutte/orbifold/exact_positions.h"

namespace orbitutte {
namespace {

// Cut vertices and the triangles that they are corners of.
struct CornersOfVertices {
  explicit CornersOfVertices(const Embedding& embedding)
      : count(embedding.source_vertex.size(), 0), last(embedding.source_vertex.size(), -1) {
    for (int h = 0; h < static_cast<int>(embedding.triangles.size()); ++h) {
      const int v = halfedge_origin(embedding.triangles, h);
      ++count[v];
      last[v] = h;
    }
  }

  std::vector<int> count, last;
};

// The inner half-edges of all ears: those opposite to a tip, which is a corner of one triangle alone.
std::vector<int> inner_halfedges_of_ears(const Embedding& embedding) {
  const auto is_mirror = [](const Seam& seam) { return seam.is_mirror(); };
  if (std::none_of(embedding.seams.begin(), embedding.seams.end(), is_mirror)) return {};
  const CornersOfVertices corners(embedding);
  std::vector<int> result;
  for (const Seam& seam : embedding.seams) {
    if (!seam.is_mirror()) continue;
    for (std::size_t k = 1; k + 1 < seam.left.size(); ++k) {
      const int tip = seam.left[k];
      if (corners.count[tip] != 1) continue;
      const int inner = next_halfedge(corners.last[tip]);
      const std::pair ends(halfedge_origin(embedding.triangles, inner),
                           halfedge_target(embedding.triangles, inner));
      if (ends == std::pair(seam.left[k - 1], seam.left[k + 1]) ||
          ends == std::pair(seam.left[k + 1], seam.left[k - 1]))
        result.push_back(inner);
    }
  }
  return result;
}

// The inner edges of ears that have a triangle behind them: the ear's half-edge and the one behind. Two ears
// may share theirs.
std::vector<std::array<int, 2>> inner_edges_of_ears(const Embedding& embedding) {
  const std::vector<int> ears = inner_halfedges_of_ears(embedding);
  if (ears.empty()) return {};
  const int vertices = static_cast<int>(embedding.source_vertex.size());
  const std::vector<int> opposite = connectivity_of(embedding.triangles, vertices).opposite;
  std::vector<std::array<int, 2>> result;
  std::set<int> met;
  for (const int inner : ears) {
    const int behind = opposite[inner];
    if (behind < 0 || met.contains(behind)) continue;
    met.insert(inner);
    result.push_back({inner, behind});
  }
  return result;
}

// Where the half-edges of the whole lie while its triangles are divided.
class MovingHalfedges {
 public:
  int now(int halfedge) const {
    const auto moved = now_.find(halfedge);
    return moved == now_.end() ? halfedge : moved->second;
  }

  // The edge y z moves to the added row, as a half-edge of this triangle of the whole.
  void divide(int whole_triangle, const DividedTriangle& division) {
    const int y = (division.corner + 1) % 3;
    for (int h = 3 * whole_triangle; h < 3 * whole_triangle + 3; ++h)
      if (now(h) == 3 * division.row + y) {
        now_[h] = 3 * division.added + y;
        return;
      }
  }

 private:
  std::unordered_map<int, int> now_;
};

// A quarter of the way from the middle of a half-edge to the third corner of its triangle, with as many
// digits as the corners have.
void place_middle(Embedding& parts, const ExactPositions& whole, int halfedge, int middle) {
  const int x = halfedge_origin(parts.triangles, halfedge), y = halfedge_target(parts.triangles, halfedge),
            z = halfedge_origin(parts.triangles, previous_halfedge(halfedge));
  const auto exact = [&](int v) {
    return v < whole.count() ? whole.exact(v)
                             : Vector3Of<MostPrecise>(parts.positions.row(v).cast<MostPrecise>());
  };
  const auto offsets = [&](int v) { return v < whole.count() ? whole.offset_count(v) : 0; };
  const Vector3Of<MostPrecise> sum =
      MostPrecise(3) * (exact(x) + exact(y)) + MostPrecise(2) * exact(z);  // 3/8, 3/8, 1/4
  store(parts, middle, precise_retract(parts.space(), sum), std::max({offsets(x), offsets(y), offsets(z)}));
}

// Divides the triangle of a half-edge from a middle, whose vertices are cut vertices.
DividedTriangle divide_at(Embedding& parts, int halfedge, int middle, int added) {
  const int row = halfedge / 3, corner = halfedge % 3;
  const auto vertex = [&](int k) { return parts.source_vertex[parts.triangles(row, (corner + k) % 3)]; };
  const DividedTriangle division = {
      row, corner, added, parts.source_vertex[middle], {vertex(0), vertex(1), vertex(2)}};
  parts.triangles.row(added) = parts.triangles.row(row);
  parts.triangles(added, corner) = middle;
  parts.triangles(row, (corner + 1) % 3) = middle;
  return division;
}

// The triangle was divided: the corners x, y, z of a part or of the whole.
std::array<int, 3> corners_from(const DividedTriangle& division) {
  return {division.corner, (division.corner + 1) % 3, (division.corner + 2) % 3};
}

// On x m z, whose points are nearer to x than to y, or on m y z.
void put_on_part(const DividedTriangle& division, SurfacePoints& points, int k) {
  if (points.triangle[k] != division.row) return;
  const auto [x, y, z] = corners_from(division);
  auto w = points.barycentric.row(k);
  const double of_x = w[x], of_y = w[y];
  const bool is_kept = of_x >= of_y;
  if (!is_kept) points.triangle[k] = division.added;
  w[x] = is_kept ? of_x - of_y : 2 * of_x;
  w[y] = is_kept ? 2 * of_y : of_y - of_x;
}

void put_on_whole(const DividedTriangle& division, SurfacePoints& points, int k) {
  const bool is_added = points.triangle[k] == division.added;
  if (!is_added && points.triangle[k] != division.row) return;
  const auto [x, y, z] = corners_from(division);
  auto w = points.barycentric.row(k);
  const double half = (is_added ? w[x] : w[y]) / 2;
  points.triangle[k] = division.row;
  w[x] = is_added ? half : w[x] + half;
  w[y] = is_added ? w[y] + half : half;
}

// The triangles of an embedding by their vertices, while one after the other is divided.
class TrianglesByVertex {
 public:
  explicit TrianglesByVertex(const Embedding& whole) : corners_(whole.triangles) {
    for (int& corner : corners_.reshaped()) corner = whole.source_vertex[corner];
  }

  void divide(const DividedTriangle& division) {
    const auto [x, y, z] = corners_from(division);
    if (corners_.rows() <= division.added) corners_.conservativeResize(division.added + 1, 3);
    corners_.row(division.added) = corners_.row(division.row);
    corners_(division.added, x) = division.middle;
    corners_(division.row, y) = division.middle;
  }

  // The coordinates of a point in the triangle that is divided, or nothing if it does not lie there.
  std::optional<Vector3> in_divided(const DividedTriangle& division, const SurfacePoints& points,
                                    int k) const {
    const std::array<int, 3> at = corners_from(division);
    Vector3 result = Vector3::Zero();
    for (int i = 0; i < 3; ++i) {
      const double weight = points.barycentric(k, i);
      if (weight == 0) continue;
      const auto found =
          std::find(division.vertices.begin(), division.vertices.end(), corners_(points.triangle[k], i));
      if (found == division.vertices.end()) return std::nullopt;
      result[at[found - division.vertices.begin()]] = weight;
    }
    return result;
  }

 private:
  Triangles corners_;
};

// With a point wherever the polyline crosses the line from the middle to z.
SurfacePoints crossing_median(const DividedTriangle& division, const TrianglesByVertex& triangles,
                              const SurfacePoints& points) {
  SurfacePoints result = {{}, Points(2 * points.count(), 3), {}};
  const auto add = [&](int triangle, const Vector3& coordinates) {
    result.barycentric.row(result.count()) = coordinates.transpose();
    result.triangle.push_back(triangle);
  };
  const auto [x, y, z] = corners_from(division);
  for (int k = 0; k < points.count(); ++k) {
    add(points.triangle[k], points.barycentric.row(k));
    if (k + 1 == points.count()) break;
    const std::optional<Vector3> from = triangles.in_divided(division, points, k),
                                 to = triangles.in_divided(division, points, k + 1);
    if (!from || !to) continue;
    const double before = (*from)[x] - (*from)[y], after = (*to)[x] - (*to)[y];
    if (!(before * after < 0)) continue;
    const double share = before / (before - after);
    Vector3 there = (1 - share) * *from + share * *to;
    there[x] = there[y] = (there[x] + there[y]) / 2;
    add(division.row, there);
  }
  result.barycentric.conservativeResize(result.count(), 3);
  return result;
}

}  // namespace

DividedEars::DividedEars(const Embedding& embedding) : whole_(embedding) {
  const std::vector<std::array<int, 2>> inner_edges = inner_edges_of_ears(embedding);
  if (inner_edges.empty()) return;
  const int ears = static_cast<int>(inner_edges.size()),
            triangles = static_cast<int>(embedding.triangles.rows()),
            cut_vertices = static_cast<int>(embedding.source_vertex.size());
  const ExactPositions positions(embedding);
  parts_ = embedding;
  parts_->polygons = {};
  parts_->triangles.conservativeResize(triangles + 2 * ears, 3);
  parts_->positions.conservativeResize(cut_vertices + ears, 3);
  const int first_middle =
      1 + *std::max_element(embedding.source_vertex.begin(), embedding.source_vertex.end());
  MovingHalfedges halfedges;
  for (int k = 0; k < ears; ++k) {
    const int middle = cut_vertices + k;
    parts_->source_vertex.push_back(first_middle + k);
    place_middle(*parts_, positions, halfedges.now(inner_edges[k][1]), middle);
    for (const int halfedge : inner_edges[k]) {
      const int added = triangles + static_cast<int>(divisions_.size());
      divisions_.push_back(divide_at(*parts_, halfedges.now(halfedge), middle, added));
      halfedges.divide(halfedge / 3, divisions_.back());
      divisions_of_[halfedge / 3].push_back(divisions_.back());
    }
  }
}

int DividedEars::halfedge_of_middle(int vertex) const {
  const DividedTriangle& ear = divisions_[2 * static_cast<std::size_t>(vertex - divisions_.front().middle)];
  return whole_halfedge(3 * ear.row + ear.corner);
}

int DividedEars::whole_triangle(int part) const {
  if (!any()) return part;
  for (const int first = divisions_.front().added; part >= first;) part = divisions_[part - first].row;
  return part;
}

const std::vector<DividedTriangle>& DividedEars::divisions_of(int whole_triangle) const {
  static const std::vector<DividedTriangle> none;
  const auto found = divisions_of_.find(whole_triangle);
  return found == divisions_of_.end() ? none : found->second;
}

int DividedEars::whole_halfedge(int halfedge) const {
  const std::vector<DividedTriangle>& divisions = divisions_of(whole_triangle(halfedge / 3));
  for (auto at = divisions.rbegin(); at != divisions.rend() && halfedge >= 0; ++at) {
    const auto [x, y, z] = corners_from(*at);
    const int row = halfedge / 3, corner = halfedge % 3;
    if (row != at->row && row != at->added) continue;
    const bool is_inside = corner == (row == at->row ? y : z);
    halfedge = is_inside ? -1 : 3 * at->row + corner;
  }
  return halfedge;
}

SurfacePoints DividedEars::on_parts(SurfacePoints points) const {
  for (int k = 0; k < points.count(); ++k)
    for (const DividedTriangle& division : divisions_of(points.triangle[k])) put_on_part(division, points, k);
  return points;
}

SurfacePoints DividedEars::on_whole(SurfacePoints points) const {
  for (int k = 0; k < points.count(); ++k) {
    const std::vector<DividedTriangle>& divisions = divisions_of(whole_triangle(points.triangle[k]));
    for (auto at = divisions.rbegin(); at != divisions.rend(); ++at) put_on_whole(*at, points, k);
  }
  return points;
}

SurfacePoints DividedEars::polyline_on_parts(SurfacePoints points) const {
  if (!any()) return points;
  TrianglesByVertex triangles(whole_);
  for (const DividedTriangle& division : divisions_) {
    points = crossing_median(division, triangles, points);
    for (int k = 0; k < points.count(); ++k) put_on_part(division, points, k);
    triangles.divide(division);
  }
  return points;
}

}  // namespace orbitutte
