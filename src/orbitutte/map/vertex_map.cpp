// SPDX-License-Identifier: MIT
#include "orbitutte/map/vertex_map.h"

#include <fmt/compile.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <limits>

#include "orbitutte/geometry/precise_isometry.h"
#include "orbitutte/map/surface_pair.h"
#include "orbitutte/mesh/connectivity.h"

namespace orbitutte {
namespace {

constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();

SurfacePoints no_points(int count) {
  return {std::vector<int>(count, -1), Points::Constant(count, 3, not_a_number), {}};
}

// Puts points of a surface among its sites, and walks to each from the corner that is nearest to it.
class PointWalks {
 public:
  PointWalks(SurfacePair& pair, Space space, const SurfacePoints& points)
      : pair_(pair),
        walker_(pair.walker()),
        space_(space),
        points_(points),
        fixes_(pair.locate_vertices()),
        first_site_(walker_.sites.count()) {
    add_sites();
  }

  SurfacePoints run() {
    SurfacePoints result = no_points(points_.count());
    Walk walk;
    for (int k = 0; k < points_.count(); ++k) {
      if (points_.triangle[k] < 0) continue;
      const int h = nearest_corner(k);
      Place place = place_at_corner(h);
      int site = walker_.site_of(h);
      if (points_.barycentric(k, h % 3) != 1) {
        pair_.tracer().trace({site, first_site_ + k}, place, walk);
        place = walk.stops.back();
        site = first_site_ + k;
      }
      result.triangle[k] = place.triangle();
      result.barycentric.row(k) = pair_.coordinates(place, site).transpose();
    }
    return result;
  }

 private:
  int nearest_corner(int k) const {
    int corner = 0;
    points_.barycentric.row(k).maxCoeff(&corner);
    return 3 * points_.triangle[k] + corner;
  }

  // The place of the vertex where a half-edge begins, for the frame of its triangle.
  Place place_at_corner(int h) const {
    Fix fix = fixes_[walker_.vertex_of(h)];
    const int limit = static_cast<int>(walker_.triangles.size());
    for (int turned = 0; fix.halfedge != h && turned < limit; ++turned) {
      const int back = previous_halfedge(fix.halfedge), o = walker_.opposite[back];
      if (o < 0) return place_clockwise(h);
      fix.halfedge = o;
      fix.place.element = pair_.elements().product(fix.place.element, walker_.beyond[back]);
    }
    return fix.place;
  }

  Place place_clockwise(int h) const {
    Fix fix = fixes_[walker_.vertex_of(h)];
    while (fix.halfedge != h) {
      const int o = walker_.opposite[fix.halfedge];
      fix.place.element = pair_.elements().product(fix.place.element, walker_.beyond[fix.halfedge]);
      fix.halfedge = next_halfedge(o);
    }
    return fix.place;
  }

  void add_sites() {
    Points rows = Points::Zero(points_.count(), 3);
    for (int k = 0; k < points_.count(); ++k)
      if (points_.triangle[k] >= 0) rows.row(k) = rough_position(k).transpose();
    pair_.walker_sites().append(rows);
    for (int k = 0; k < points_.count(); ++k)
      if (points_.triangle[k] >= 0 && needs_digits(k))
        pair_.walker_sites().set_exact(first_site_ + k, exact_position(k));
  }

  int corner_site(int k, int i) const { return walker_.site_of(3 * points_.triangle[k] + i); }

  Vector3 rough_position(int k) const {
    const auto corner = [&](int i) { return walker_.sites.rough(corner_site(k, i)); };
    return barycentric_point(space_, {corner(0), corner(1), corner(2)}, points_.barycentric.row(k));
  }

  // Points between corners that have further digits have them, too: they stay on mirrors and in limbs.
  bool needs_digits(int k) const {
    for (int i = 0; i < 3; ++i)
      if (points_.barycentric(k, i) != 0 && !walker_.sites.is_double(corner_site(k, i))) return true;
    return false;
  }

  Vector3Of<MostPrecise> exact_position(int k) const {
    Vector3Of<MostPrecise> sum = Vector3Of<MostPrecise>::Zero();
    for (int i = 0; i < 3; ++i)
      if (const double weight = points_.barycentric(k, i); weight != 0)
        sum += MostPrecise(weight) * walker_.sites.exact(corner_site(k, i));
    return precise_retract(space_, sum);
  }

  SurfacePair& pair_;
  const DevelopedSurface& walker_;
  Space space_;
  const SurfacePoints& points_;
  std::vector<Fix> fixes_;
  int first_site_;
};

void require_points(const Embedding& embedding, const SurfacePoints& points) {
  constexpr double bound = 1e-6;
  if (!points.copy.empty()) throw ArgumentError("points of a surface have no copies");
  if (points.barycentric.rows() != points.count())
    throw ArgumentError(fmt::format("there are {} triangles and {} rows of coordinates", points.count(),
                                    points.barycentric.rows()));
  for (int k = 0; k < points.count(); ++k) {
    const int t = points.triangle[k];
    if (t == -1) continue;
    if (t < 0 || t >= embedding.triangles.rows())
      throw ArgumentError(
          fmt::format("point {} names the triangle {}; there are {}", k, t, embedding.triangles.rows()));
    const auto row = points.barycentric.row(k);
    if (!row.allFinite() || row.minCoeff() < 0 || std::abs(row.sum() - 1) > bound)
      throw ArgumentError(fmt::format(
          "point {} has the barycentric coordinates ({}, {}, {}); they must be finite, not negative, and add "
          "up to 1",
          k, row[0], row[1], row[2]));
  }
}

void require_rows(const VertexMap& map, Eigen::Index rows) {
  const Eigen::Index needed = map.corners.size() > 0 ? map.corners.maxCoeff() + 1 : 0;
  if (rows < needed)
    throw ArgumentError(
        fmt::format("there are values for {} vertices, and the map needs those of {}", rows, needed));
}

}  // namespace

VertexMap images_of_vertices(const Embedding& from, const Embedding& to) {
  SurfacePair pair(to, from);
  const std::vector<Fix> fixes = pair.locate_vertices();
  const int count = static_cast<int>(fixes.size());
  VertexMap map = {no_points(count), Triangles::Constant(count, 3, -1)};
  for (int v = 0; v < count; ++v) {
    const Fix& fix = fixes[v];
    if (fix.halfedge < 0) continue;
    const int triangle = fix.place.triangle();
    map.images.triangle[v] = triangle;
    map.images.barycentric.row(v) =
        pair.coordinates(fix.place, pair.walker().site_of(fix.halfedge)).transpose();
    for (int k = 0; k < 3; ++k) map.corners(v, k) = pair.walked().vertex_of(3 * triangle + k);
  }
  return map;
}

SurfacePoints images_of_points(const Embedding& from, const Embedding& to, const SurfacePoints& points) {
  require_points(from, points);
  SurfacePair pair(to, from);
  return PointWalks(pair, from.space(), points).run();
}

std::vector<MatrixEntry> transfer_matrix(const VertexMap& map) {
  std::vector<MatrixEntry> entries;
  entries.reserve(3 * static_cast<std::size_t>(map.count()));
  for (int v = 0; v < map.count(); ++v) {
    if (map.images.triangle[v] < 0) continue;
    const std::size_t first = entries.size();
    for (int k = 0; k < 3; ++k)
      if (const double weight = map.images.barycentric(v, k); weight != 0)
        entries.push_back({v, map.corners(v, k), weight});
    std::sort(entries.begin() + static_cast<std::ptrdiff_t>(first), entries.end(),
              [](const MatrixEntry& x, const MatrixEntry& y) { return x.column < y.column; });
  }
  return entries;
}

Eigen::MatrixXd transfer(const VertexMap& map, const Eigen::MatrixXd& values) {
  require_rows(map, values.rows());
  Eigen::MatrixXd result = Eigen::MatrixXd::Constant(map.count(), values.cols(), not_a_number);
  for (int v = 0; v < map.count(); ++v) {
    if (map.images.triangle[v] < 0) continue;
    result.row(v).setZero();
    for (int k = 0; k < 3; ++k)
      if (const double weight = map.images.barycentric(v, k); weight != 0)
        result.row(v) += weight * values.row(map.corners(v, k));
  }
  return result;
}

std::vector<int> transfer_labels(const VertexMap& map, const std::vector<int>& labels) {
  require_rows(map, static_cast<Eigen::Index>(labels.size()));
  std::vector<int> result(map.count(), -1);
  for (int v = 0; v < map.count(); ++v) {
    if (map.images.triangle[v] < 0) continue;
    int corner = 0;
    map.images.barycentric.row(v).maxCoeff(&corner);
    result[v] = labels[map.corners(v, corner)];
  }
  return result;
}

std::string point_lines(const SurfacePoints& points) {
  std::string text;
  const auto out = std::back_inserter(text);
  for (int k = 0; k < points.count(); ++k)
    fmt::format_to(out, FMT_COMPILE("{} {} {} {}\n"), points.triangle[k], points.barycentric(k, 0),
                   points.barycentric(k, 1), points.barycentric(k, 2));
  return text;
}

}  // namespace orbitutte
