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

#include "orbitutte/geometry/orientation.h"
#include "orbitutte/geometry/spherical_coordinates.h"
#include "orbitutte/orbifold/symmetry_group.h"
#include "orbitutte/parallel.h"

namespace orbitutte {
namespace {

namespace bg = boost::geometry;
using TreePoint = bg::model::point<double, 3, bg::cs::cartesian>;
using Box = bg::model::box<TreePoint>;
using Entry = std::pair<Box, int>;  // a triangle
using Tree = bg::index::rtree<Entry, bg::index::rstar<16>>;

constexpr double largest_gap = 1e-11;  // the certificate allows seams a residual of 1e-12
constexpr double nan = std::numeric_limits<double>::quiet_NaN();

std::vector<Matrix3> copies_of(const Embedding& embedding) {
  std::vector<Matrix3> generators;
  for (const Seam& seam : embedding.seams) generators.push_back(seam.transform);
  const SymmetryGroup group(generators, std::max(embedding.group_order, 1));
  if (group.order() != embedding.group_order)
    throw ArgumentError(
        fmt::format("the transforms of the seams generate {} symmetries, but the orbifold has {}",
                    group.order(), embedding.group_order));
  return group.elements();
}

void require_sound(const Embedding& embedding) {
  if (!embedding.positions.allFinite())
    throw ArgumentError("the embedding has positions that are not finite");
  if (embedding.faces.size() > 0 &&
      (embedding.faces.minCoeff() < 0 || embedding.faces.maxCoeff() >= embedding.positions.rows()))
    throw ArgumentError("a face of the embedding names a vertex that does not exist");
}

SphericalCorners corners_of(const Embedding& embedding, int f) {
  const auto corner = [&](int k) -> Vector3 { return embedding.positions.row(embedding.faces(f, k)); };
  return {corner(0), corner(1), corner(2)};
}

// How far the sphere rises over the triangle, at the most: with chords c_ij, the squared length of sum l_i
// a_i is 1 - sum l_i l_j c_ij^2, at least 1 - c^2/3.
double rise(const SphericalCorners& corners) {
  double squared_chord = 0;
  for (int k = 0; k < 3; ++k)
    squared_chord = std::max(squared_chord, (corners[k] - corners[(k + 1) % 3]).squaredNorm());
  return 1 - std::sqrt(std::max(0.0, 1 - squared_chord / 3));
}

// A box around the spherical triangle and all within largest_gap of it.
Box box_around(const SphericalCorners& corners) {
  const auto& [a, b, c] = corners;
  const Vector3 margin = Vector3::Constant(rise(corners) + 2 * largest_gap);
  const Vector3 low = a.cwiseMin(b).cwiseMin(c) - margin, high = a.cwiseMax(b).cwiseMax(c) + margin;
  return {TreePoint(low.x(), low.y(), low.z()), TreePoint(high.x(), high.y(), high.z())};
}

Tree tree_of(const Embedding& embedding) {
  const int faces = static_cast<int>(embedding.faces.rows());
  std::vector<char> positive(faces);
  parallel_ranges(faces, [&](int begin, int end) {
    for (int f = begin; f < end; ++f) {
      const auto [a, b, c] = corners_of(embedding, f);
      positive[f] = orientation_sign(a, b, c) > 0;
    }
  });
  std::vector<Entry> entries;
  for (int f = 0; f < faces; ++f)
    if (positive[f]) entries.emplace_back(box_around(corners_of(embedding, f)), f);
  return Tree(entries);
}

struct Location {
  int face = -1;
  int element = -1;
  Vector3 barycentric = Vector3::Constant(nan);
};

}  // namespace

struct PointLocator::State {
  Embedding embedding;  // positions and faces alone
  std::vector<Matrix3> elements;
  Tree tree;

  // The triangles whose boxes hold the point.
  void find_near(const Vector3& point, std::vector<int>& found) const {
    found.clear();
    tree.query(
        bg::index::intersects(TreePoint(point.x(), point.y(), point.z())),
        boost::make_function_output_iterator([&](const Entry& entry) { found.push_back(entry.second); }));
    std::sort(found.begin(), found.end());
  }

  bool may_hold(const Vector3& point) const {
    const Box bounds = tree.bounds();
    return bg::covered_by(TreePoint(point.x(), point.y(), point.z()), bounds);
  }

  // visit(f, g, here): the triangles f near `here`, which is where copy g has the point. Returning true ends
  // it.
  template <typename Visit>
  void visit_near(const Vector3& point, std::vector<int>& near, const Visit& visit) const {
    for (std::size_t g = 0; g < elements.size(); ++g) {
      const Vector3 here = elements[g].transpose() * point;
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
      const SphericalCorners corners = corners_of(embedding, f);
      if (!contains(corners, here)) return false;
      found = {f, g, spherical_coordinates(corners, here)};
      return true;
    });
    return found.face >= 0 ? found : nearest(point, near);
  }

  // For points in gaps between banks.
  Location nearest(const Vector3& point, std::vector<int>& near) const {
    Location best;
    double least = largest_gap;
    visit_near(point, near, [&](int f, int g, const Vector3& here) {
      const SphericalCorners corners = corners_of(embedding, f);
      const Vector3 coordinates = nearest_on_edges(corners, here);
      const double away = (spherical_point(corners, coordinates) - here).norm();
      if (away < least) {
        least = away;
        best = {f, g, coordinates};
      }
      return false;
    });
    return best;
  }
};

PointLocator::PointLocator(const Embedding& embedding) {
  if (embedding.geometry != Geometry::spherical)
    throw ArgumentError("points are located on the sphere only: this embedding is one into the plane");
  require_sound(embedding);
  Embedding map;
  map.positions = embedding.positions;
  map.faces = embedding.faces;
  Tree tree = tree_of(map);
  state_ = std::make_unique<State>(State{std::move(map), copies_of(embedding), std::move(tree)});
}

PointLocator::~PointLocator() = default;
PointLocator::PointLocator(PointLocator&&) noexcept = default;

const std::vector<Matrix3>& PointLocator::elements() const { return state_->elements; }

SurfacePoints PointLocator::locate(const Points& directions) const {
  const int count = static_cast<int>(directions.rows());
  SurfacePoints result = {std::vector<int>(count, -1), Points::Constant(count, 3, nan),
                          std::vector<int>(count, -1)};
  parallel_ranges(count, [&](int begin, int end) {
    std::vector<int> near;
    for (int k = begin; k < end; ++k) {
      const Vector3 direction = directions.row(k);
      const double length = direction.stableNorm();
      if (!(length > 0) || !std::isfinite(length)) continue;
      const Location found = state_->locate(direction / length, near);
      result.face[k] = found.face;
      result.element[k] = found.element;
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
      (!points.element.empty() && points.element.size() != count))
    throw ArgumentError(fmt::format("there are {} faces, {} rows of coordinates and {} copies", count,
                                    points.barycentric.rows(), points.element.size()));
}

}  // namespace

Points map_points(const Embedding& embedding, const SurfacePoints& points) {
  require_lengths(points);
  require_sound(embedding);
  const std::vector<Matrix3> elements =
      points.element.empty() ? std::vector{Matrix3(Matrix3::Identity())} : copies_of(embedding);
  Points images = Points::Constant(points.count(), 3, nan);
  parallel_ranges(points.count(), [&](int begin, int end) {
    for (int k = begin; k < end; ++k) {
      const int face = points.face[k], element = points.element.empty() ? 0 : points.element[k];
      if (face == -1) continue;
      const Vector3 coordinates = points.barycentric.row(k);
      require_index(face, static_cast<std::size_t>(embedding.faces.rows()), "face", k);
      require_index(element, elements.size(), "copy", k);
      require_coordinates(coordinates, k);
      const SphericalCorners corners = corners_of(embedding, face);
      const Vector3 image = embedding.geometry == Geometry::spherical
                                ? spherical_point(corners, coordinates)
                                : Vector3(coordinates[0] * corners[0] + coordinates[1] * corners[1] +
                                          coordinates[2] * corners[2]);
      images.row(k) = (elements[element] * image).transpose();
    }
  });
  return images;
}

}  // namespace orbitutte
