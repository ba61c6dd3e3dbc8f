// SPDX-License-Identifier: MIT
#include "orbitutte/map/point_map.h"

#define BOOST_ALLOW_DEPRECATED_HEADERS  // Boost.Geometry 1.74 includes one of its own

#include <fmt/format.h>

#include <algorithm>
#include <boost/geometry/algorithms/covered_by.hpp>
#include <boost/geometry/geometries/box.hpp>
#include <boost/geometry/geometries/point.hpp>
#include <boost/geometry/index/rtree.hpp>
#include <boost/iterator/function_output_iterator.hpp>
#include <cmath>
#include <limits>

#include "orbitutte/geometry/barycentric_coordinates.h"
#include "orbitutte/geometry/orientation.h"
#include "orbitutte/orbifold/symmetry_group.h"
#include "orbitutte/parallel.h"

namespace orbitutte {
namespace {

namespace bg = boost::geometry;
using TreePoint = bg::model::point<double, 3, bg::cs::cartesian>;
using TriangleBox = bg::model::box<TreePoint>;
using TriangleEntry = std::pair<TriangleBox, int>;  // a triangle
using TriangleTree = bg::index::rtree<TriangleEntry, bg::index::rstar<16>>;

constexpr double largest_gap = 1e-11;  // the certificate allows seams a residual of 1e-12
constexpr int most_copies = 100000;    // of infinitely many
constexpr double nan = std::numeric_limits<double>::quiet_NaN();

void require_sound(const Embedding& embedding) {
  if (!embedding.positions.allFinite())
    throw ArgumentError("the embedding has positions that are not finite");
  if (embedding.triangles.size() > 0 &&
      (embedding.triangles.minCoeff() < 0 || embedding.triangles.maxCoeff() >= embedding.positions.rows()))
    throw ArgumentError("a face of the embedding names a vertex that does not exist");
}

TriangleCorners corners_of(const Points& positions, const Triangles& triangles, int t) {
  return {positions.row(triangles(t, 0)), positions.row(triangles(t, 1)), positions.row(triangles(t, 2))};
}

// A box around the triangle and all within largest_gap of it.
TriangleBox box_around(Space space, const TriangleCorners& corners) {
  const auto& [a, b, c] = corners;
  const Vector3 margin = Vector3::Constant(triangle_bulge(space, corners) + 2 * largest_gap);
  const Vector3 low = a.cwiseMin(b).cwiseMin(c) - margin, high = a.cwiseMax(b).cwiseMax(c) + margin;
  return {TreePoint(low.x(), low.y(), low.z()), TreePoint(high.x(), high.y(), high.z())};
}

struct Location {
  int triangle = -1;
  int copy = -1;
  Vector3 barycentric = Vector3::Constant(nan);
};

}  // namespace

struct PointLocator::State {
  Space space;
  Points positions;  // in the canonical frame
  Triangles triangles;
  std::vector<Isometry> elements;
  TriangleTree tree;

  TriangleCorners corners(int f) const { return corners_of(positions, triangles, f); }

  // The triangles that are positively oriented.
  void grow_tree() {
    std::vector<char> positive(triangles.rows());
    parallel_ranges(static_cast<int>(triangles.rows()), [&](int begin, int end) {
      for (int f = begin; f < end; ++f) {
        const auto [a, b, c] = corners(f);
        positive[f] = orientation_sign(a, b, c) > 0;
      }
    });
    std::vector<TriangleEntry> entries;
    for (int f = 0; f < static_cast<int>(triangles.rows()); ++f)
      if (positive[f]) entries.emplace_back(box_around(space, corners(f)), f);
    tree = TriangleTree(entries);
  }

  // The triangles whose boxes hold the point.
  void find_near(const Vector3& point, std::vector<int>& found) const {
    found.clear();
    tree.query(bg::index::intersects(TreePoint(point.x(), point.y(), point.z())),
               boost::make_function_output_iterator(
                   [&](const TriangleEntry& entry) { found.push_back(entry.second); }));
    std::sort(found.begin(), found.end());
  }

  bool may_hold(const Vector3& point) const {
    const TriangleBox bounds = tree.bounds();
    return bg::covered_by(TreePoint(point.x(), point.y(), point.z()), bounds);
  }

  // visit(f, g, here) for the triangles f near `here`, the point seen from copy g. Returning true ends the
  // search.
  template <typename Visit>
  void visit_near(const Vector3& point, std::vector<int>& near, const Visit& visit) const {
    for (std::size_t g = 0; g < elements.size(); ++g) {
      const Vector3 here = elements[g].inverse_matrix() * point;
      if (!may_hold(here)) continue;
      find_near(here, near);
      for (const int f : near)
        if (visit(f, static_cast<int>(g), here)) return;
    }
  }

  // The first triangle of the first copy that holds the point.
  Location locate(const Vector3& point, std::vector<int>& near) const {
    Location found;
    visit_near(point, near, [&](int f, int g, const Vector3& here) {
      if (!triangle_contains(corners(f), here)) return false;
      found = {f, g, barycentric_coordinates(space, corners(f), here)};
      return true;
    });
    return found.triangle >= 0 ? found : nearest(point, near);
  }

  // For points in gaps between banks.
  Location nearest(const Vector3& point, std::vector<int>& near) const {
    Location best;
    double least = largest_gap;
    visit_near(point, near, [&](int f, int g, const Vector3& here) {
      const Vector3 coordinates = nearest_on_edges(space, corners(f), here);
      const double away = (barycentric_point(space, corners(f), coordinates) - here).norm();
      if (away < least) {
        least = away;
        best = {f, g, coordinates};
      }
      return false;
    });
    return best;
  }
};

PointLocator::PointLocator(const Embedding& embedding, int copies) {
  require_sound(embedding);
  state_ =
      std::make_unique<State>(State{embedding.space(), embedding.canonical_positions(), embedding.triangles,
                                    canonical_group_of(embedding, copies).elements(), TriangleTree()});
  state_->grow_tree();
}

PointLocator::~PointLocator() = default;
PointLocator::PointLocator(PointLocator&&) noexcept = default;

const std::vector<Isometry>& PointLocator::elements() const { return state_->elements; }

SurfacePoints PointLocator::locate(const Points& points) const {
  const int count = static_cast<int>(points.rows());
  SurfacePoints result = {std::vector<int>(count, -1), Points::Constant(count, 3, nan),
                          std::vector<int>(count, -1)};
  parallel_ranges(count, [&](int begin, int end) {
    std::vector<int> near;
    for (int k = begin; k < end; ++k) {
      const Vector3 direction = points.row(k);
      const double length = direction.stableNorm();
      if (!(length > 0) || !std::isfinite(length)) continue;
      const Vector3 point = state_->space.retract(direction / length);
      if (!point.allFinite()) continue;
      const Location found = state_->locate(point, near);
      result.triangle[k] = found.triangle;
      result.copy[k] = found.copy;
      result.barycentric.row(k) = found.barycentric.transpose();
    }
  });
  return result;
}

namespace {

void require_coordinates(const Vector3& coordinates, int point) {
  constexpr double bound = 1e-6;
  if (coordinates.allFinite() && coordinates.minCoeff() >= -bound && std::abs(coordinates.sum() - 1) <= bound)
    return;
  throw ArgumentError(fmt::format(
      "point {} has the barycentric coordinates ({}, {}, {}); they must be finite, not negative, and add up "
      "to 1",
      point, coordinates[0], coordinates[1], coordinates[2]));
}

void require_index(int index, std::size_t count, const char* what, int point) {
  if (index < 0 || index >= static_cast<long long>(count))
    throw ArgumentError(fmt::format("point {} names the {} {}; there are {}", point, what, index, count));
}

void require_lengths(const SurfacePoints& points) {
  const auto count = static_cast<std::size_t>(points.count());
  if (static_cast<std::size_t>(points.barycentric.rows()) != count ||
      (!points.copy.empty() && points.copy.size() != count))
    throw ArgumentError(fmt::format("there are {} triangles, {} rows of coordinates and {} copies", count,
                                    points.barycentric.rows(), points.copy.size()));
}

}  // namespace

Points map_points(const Embedding& embedding, const SurfacePoints& points) {
  require_lengths(points);
  require_sound(embedding);
  const int last = points.copy.empty() ? 0 : *std::max_element(points.copy.begin(), points.copy.end());
  const std::vector<Isometry> elements =
      last > 0 ? canonical_group_of(embedding, std::min(last, most_copies) + 1).elements()
               : std::vector<Isometry>(1);
  const Points positions = embedding.canonical_positions();
  Points images = Points::Constant(points.count(), 3, nan);
  parallel_ranges(points.count(), [&](int begin, int end) {
    for (int k = begin; k < end; ++k) {
      const int triangle = points.triangle[k], copy = points.copy.empty() ? 0 : points.copy[k];
      if (triangle == -1) continue;
      const Vector3 coordinates = points.barycentric.row(k);
      require_index(triangle, static_cast<std::size_t>(embedding.triangles.rows()), "triangle", k);
      require_index(copy, elements.size(), "copy", k);
      require_coordinates(coordinates, k);
      const Vector3 image = barycentric_point(
          embedding.space(), corners_of(positions, embedding.triangles, triangle), coordinates);
      images.row(k) = (elements[copy] * image).transpose();
    }
  });
  return images;
}

}  // namespace orbitutte
