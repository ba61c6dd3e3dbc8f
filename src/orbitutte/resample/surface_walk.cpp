// SPDX-License-Identifier: MIT
#include "orbitutte/resample/surface_walk.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <mutex>
#include <numeric>
#include <unordered_map>
#include <utility>

#include "orbitutte/geometry/barycentric_coordinates.h"
#include "orbitutte/geometry/morton.h"
#include "orbitutte/geometry/orientation.h"
#include "orbitutte/mesh/connectivity.h"
#include "orbitutte/orbifold/signature.h"
#include "orbitutte/orbifold/symmetry_group.h"
#include "orbitutte/parallel.h"

namespace orbitutte {
namespace {

constexpr int no_gluing = -1, no_halfedge = -1;
constexpr int longest_walk = 20000;
constexpr int most_crossings = 64;  // of seams, before rounding errors are left behind

// The numbers of the points along a curve that keeps neighbours near to each other (Morton's order).
std::vector<int> along_curve(const Points& points) {
  const int count = static_cast<int>(points.rows());
  std::vector<std::pair<std::uint64_t, int>> keys(count);
  if (count == 0) return {};
  const Eigen::RowVector3d low = points.colwise().minCoeff(), high = points.colwise().maxCoeff();
  const double size = std::max((high - low).maxCoeff(), std::numeric_limits<double>::min());
  constexpr double cells = 0x1fffff;
  parallel_ranges(count, [&](int begin, int end) {
    for (int k = begin; k < end; ++k) {
      const auto cell = [&](int c) {
        const double share = (points(k, c) - low[c]) / size;
        return static_cast<std::uint64_t>(share >= 0 && share <= 1 ? share * cells : 0);
      };
      keys[k] = {place_on_curve(cell(0), cell(1), cell(2)), k};
    }
  });
  std::sort(keys.begin(), keys.end());
  std::vector<int> order(count);
  std::transform(keys.begin(), keys.end(), order.begin(), [](const auto& key) { return key.second; });
  return order;
}

// The sign of det[p a b]. Rounding errors of differences between neighbours are below 10 units of 1.1e-16 |a
// - p| |b - p|.
bool is_right_of(const Vector3& p, const Vector3& a, const Vector3& b) {
  const Vector3 u = a - p, v = b - p;
  const double determinant = p.dot(u.cross(v));
  const double bound = 4e-15 * std::sqrt(u.squaredNorm() * v.squaredNorm());
  if (std::abs(determinant) > bound) return determinant < 0;
  return orientation_sign(p, a, b) < 0;
}

std::uint64_t directed_edge(int from, int to) {
  return static_cast<std::uint64_t>(static_cast<std::uint32_t>(from)) << 32 | static_cast<std::uint32_t>(to);
}

}  // namespace

struct SurfaceWalk::State {
  const Embedding& embedding;
  Space space;
  Points positions;
  Triangles triangles;

  // 3 T: the half-edge beyond, no_halfedge at an end; and which of `gluings` takes a point along, no_gluing
  // within the cut surface. At a mirror it is the half-edge itself.
  std::vector<int> opposite, gluing;
  std::vector<Matrix3> gluings;

  mutable std::once_flag is_locator_made;
  mutable std::unique_ptr<PointLocator> locator;

  explicit State(const Embedding& given)
      : embedding(given),
        space(given.space()),
        positions(given.canonical_positions()),
        triangles(given.triangles),
        opposite(connectivity_of(given.triangles, static_cast<int>(given.positions.rows())).opposite),
        gluing(opposite.size(), no_gluing) {
    if (tiles_its_space(given.target)) glue();
  }

  // The half-edges of the cut surface's boundary by the vertices where they begin and end.
  std::unordered_map<std::uint64_t, int> boundary() const {
    std::unordered_map<std::uint64_t, int> result;
    for (int h = 0; h < static_cast<int>(opposite.size()); ++h)
      if (opposite[h] < 0)
        result.emplace(directed_edge(halfedge_origin(triangles, h), halfedge_target(triangles, h)), h);
    return result;
  }

  void glue() {
    if (embedding.seams.empty()) return;
    const std::unordered_map<std::uint64_t, int> halfedges = boundary();
    const auto halfedge = [&](int a, int b) {
      auto found = halfedges.find(directed_edge(a, b));
      if (found == halfedges.end()) found = halfedges.find(directed_edge(b, a));
      return found == halfedges.end() ? no_halfedge : found->second;
    };
    const Isometry& placement = embedding.placement;
    for (const Seam& seam : embedding.seams) {
      const Isometry to_left = placement.inverse() * seam.transform * placement;
      const int of_left = static_cast<int>(gluings.size());
      gluings.push_back(to_left.inverse_matrix());
      gluings.push_back(to_left.matrix());
      for (std::size_t k = 1; k < seam.left.size(); ++k) {
        const int left = halfedge(seam.left[k - 1], seam.left[k]),
                  right = halfedge(seam.right[k - 1], seam.right[k]);
        if (left == no_halfedge || right == no_halfedge) continue;
        opposite[left] = right, gluing[left] = of_left;
        opposite[right] = left, gluing[right] = of_left + 1;
      }
    }
  }

  // Where a walk is: the point as the copy with this triangle sees it is frame * point.
  struct Place {
    int triangle = 0;
    Matrix3 frame = Matrix3::Identity();
    int crossings = 0;
    std::uint32_t random = 1;
  };

  TriangleCorners corners(int t) const {
    return {positions.row(triangles(t, 0)), positions.row(triangles(t, 1)), positions.row(triangles(t, 2))};
  }

  // The half-edge of the triangle that has the point on its other side, any if there are two, but not the one
  // by which the walk came.
  int way_out(const TriangleCorners& at, const Vector3& here, int entry, Place& place) const {
    place.random = place.random * 1664525U + 1013904223U;
    const int first = static_cast<int>((place.random >> 16) % 3);
    for (int i = 0; i < 3; ++i) {
      const int k = (first + i) % 3;
      if (3 * place.triangle + k != entry && is_right_of(here, at[k], at[(k + 1) % 3]))
        return 3 * place.triangle + k;
    }
    return no_halfedge;
  }

  // From the opposite point of a sphere, the sides of a triangle that is turned over look the same.
  bool is_this_side(const TriangleCorners& at, const Vector3& here) const {
    return space.side(here, Vector3(at[0] + at[1] + at[2])) > 0;
  }

  // Goes to the triangle that holds the point, or returns false.
  bool walk(const Vector3& point, Place& place, Vector3& coordinates) const {
    if (place.crossings > most_crossings) place.frame.setIdentity(), place.crossings = 0;
    Vector3 here = place.frame * point;
    int entry = no_halfedge;
    for (int step = 0; step < longest_walk; ++step) {
      const TriangleCorners at = corners(place.triangle);
      const int out = way_out(at, here, entry, place);
      if (out == no_halfedge) {
        if (!is_this_side(at, here)) return false;
        coordinates = barycentric_coordinates(space, at, here);
        return coordinates.allFinite();
      }
      if (opposite[out] < 0) return false;
      if (gluing[out] != no_gluing) {
        here = gluings[gluing[out]] * here;
        place.frame = gluings[gluing[out]] * place.frame;
        ++place.crossings;
      }
      entry = opposite[out];
      place.triangle = entry / 3;
    }
    return false;
  }

  const PointLocator& tree() const {
    std::call_once(is_locator_made, [&] { locator = std::make_unique<PointLocator>(embedding); });
    return *locator;
  }
};

SurfaceWalk::SurfaceWalk(const Embedding& embedding) : state_(std::make_unique<State>(embedding)) {}
SurfaceWalk::~SurfaceWalk() = default;

SurfacePoints SurfaceWalk::locate(const Points& points) const {
  const int count = static_cast<int>(points.rows());
  const std::vector<int> order = along_curve(points);
  SurfacePoints result = {
      std::vector<int>(count, -1), Points::Constant(count, 3, std::numeric_limits<double>::quiet_NaN()), {}};
  if (state_->triangles.rows() == 0) return result;
  parallel_ranges(count, [&](int begin, int end) {
    State::Place place;
    for (int i = begin; i < end; ++i) {
      const int k = order[i];
      const Vector3 point = points.row(k);
      if (!point.allFinite() || point.isZero(0)) continue;
      Vector3 coordinates;
      if (state_->walk(point, place, coordinates)) {
        result.triangle[k] = place.triangle;
        result.barycentric.row(k) = coordinates.transpose();
      } else {
        place = {};
      }
    }
  });
  const std::vector<int> missed = parallel_select(count, [&](int k) { return result.triangle[k] < 0; });
  if (missed.empty()) return result;
  Points rest(static_cast<Eigen::Index>(missed.size()), 3);
  for (std::size_t i = 0; i < missed.size(); ++i)
    rest.row(static_cast<Eigen::Index>(i)) = points.row(missed[i]);
  const SurfacePoints found = state_->tree().locate(rest);
  for (std::size_t i = 0; i < missed.size(); ++i) {
    result.triangle[missed[i]] = found.triangle[i];
    result.barycentric.row(missed[i]) = found.barycentric.row(static_cast<Eigen::Index>(i));
  }
  return result;
}

Embedding embedded_sphere(const Points& points, const Triangles& triangles) {
  Embedding result;
  result.target = parse_orbifold("1");
  result.positions = points;
  result.triangles = triangles;
  result.source_vertex.resize(points.rows());
  std::iota(result.source_vertex.begin(), result.source_vertex.end(), 0);
  return result;
}

}  // namespace orbitutte
