// SPDX-License-Identifier: MIT
#include "orbitutte/map/vertex_map.h"

#include <fmt/compile.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <limits>

#include "orbitutte/map/divided_ears.h"
#include "orbitutte/map/surface_pair.h"
#include "orbitutte/mesh/connectivity.h"

namespace orbitutte {
namespace {

constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();

SurfacePoints no_points(int count) {
  return {std::vector<int>(count, -1), Points::Constant(count, 3, not_a_number), {}};
}

VertexMap no_images(int count) { return {no_points(count), Triangles::Constant(count, 3, -1)}; }

int count_vertices(const Embedding& embedding) {
  int count = 0;
  for (const int v : embedding.source_vertex) count = std::max(count, v + 1);
  return count;
}

// Those of the triangles that the images lie in.
void name_corners(const Embedding& to, VertexMap& map) {
  for (int v = 0; v < map.count(); ++v)
    if (const int t = map.images.triangle[v]; t >= 0)
      for (int k = 0; k < 3; ++k) map.corners(v, k) = to.source_vertex[to.triangles(t, k)];
}

// The images on one surface of the vertices of the other, which the member names.
VertexMap vertices_of_overlay(const Overlay& overlay, int OverlayVertex::*vertex, const SurfacePoints& places,
                              const std::array<const Embedding*, 2>& from_and_to) {
  const auto& [from, to] = from_and_to;
  VertexMap map = no_images(count_vertices(*from));
  for (int k = 0; k < overlay.vertex_count(); ++k) {
    const int v = overlay.vertices[k].*vertex, t = places.triangle[k];
    if (v < 0) continue;
    map.images.triangle[v] = t;
    map.images.barycentric.row(v) = places.barycentric.row(k);
  }
  name_corners(*to, map);
  return map;
}

// Walks from the vertices of a surface to points of its triangles, which become sites of the walker.
class PointWalks {
 public:
  explicit PointWalks(SurfacePair& pair)
      : pair_(pair), walker_(pair.walker()), fixes_(pair.locate_vertices()) {}

  SurfacePoints images(const SurfacePoints& points) {
    SurfacePoints result = no_points(points.count());
    for (int k = 0; k < points.count(); ++k) {
      if (points.triangle[k] < 0) continue;
      const Reached reached = reach(points.triangle[k], points.barycentric.row(k));
      result.triangle[k] = reached.place.triangle();
      result.barycentric.row(k) = pair_.coordinates(reached.place, reached.site).transpose();
    }
    return result;
  }

  SurfacePoints polyline(const SurfacePoints& points) {
    std::vector<int> triangles;
    std::vector<Vector3> coordinates;
    for (int k = 0; k < points.count(); ++k) {
      const SurfacePoints piece = k + 1 < points.count() ? piece_from(points, k) : SurfacePoints{};
      for (int i = 0; i + 1 < piece.count(); ++i) {
        triangles.push_back(piece.triangle[i]);
        coordinates.emplace_back(piece.barycentric.row(i));
      }
      if (k + 1 < points.count()) continue;
      const SurfacePoints last = images({{points.triangle[k]}, points.barycentric.row(k), {}});
      triangles.push_back(last.triangle[0]);
      coordinates.emplace_back(last.barycentric.row(0));
    }
    SurfacePoints result = no_points(static_cast<int>(triangles.size()));
    result.triangle = triangles;
    for (std::size_t k = 0; k < coordinates.size(); ++k)
      result.barycentric.row(static_cast<Eigen::Index>(k)) = coordinates[k].transpose();
    return result;
  }

 private:
  // A site of the walker, and its place for the frame of its triangle.
  struct Reached {
    int site;
    Place place;
  };

  // Walks there from the nearest corner.
  Reached reach(int triangle, const Vector3& coordinates) {
    int corner = 0;
    coordinates.maxCoeff(&corner);
    const int h = 3 * triangle + corner, start = walker_.site_of(h);
    Place place = place_at_corner(h);
    if (coordinates[corner] == 1) return {start, place};
    const int site = add_site(triangle, coordinates);
    pair_.tracer().trace({start, site}, place, walk_);
    return {site, walk_.stops.back()};
  }

  // The place of the vertex where a half-edge begins, for the frame of its triangle.
  Place place_at_corner(int h) const {
    Fix fix = fixes_[walker_.vertex_of(h)];
    const int limit = static_cast<int>(walker_.triangles.size());
    for (int turned = 0; fix.halfedge != h && turned < limit; ++turned) {
      const int back = previous_halfedge(fix.halfedge), o = walker_.opposite[back];
      if (o < 0) return place_clockwise(h);
      fix.place.element = pair_.elements().product(fix.place.element, walker_.beyond[back]);
      fix.halfedge = o;
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

  // With all digits: what doubles lose in a triangle that has shrunk shows in full size on the other surface.
  int add_site(int triangle, const Vector3& coordinates) {
    const int site = pair_.walker_sites().append(Vector3::Zero());
    pair_.walker_sites().set_exact(site, exact_position(triangle, coordinates));
    return site;
  }

  // Up to its length, which no sign depends on.
  Vector3Of<MostPrecise> exact_position(int triangle, const Vector3& coordinates) const {
    Vector3Of<MostPrecise> sum = Vector3Of<MostPrecise>::Zero();
    for (int i = 0; i < 3; ++i)
      if (coordinates[i] != 0)
        sum += MostPrecise(coordinates[i]) * walker_.sites.exact(walker_.site_of(3 * triangle + i));
    return sum;
  }

  // The image of the line from one point to the next.
  SurfacePoints piece_from(const SurfacePoints& points, int k) {
    const int triangle = common_triangle(points, k);
    const Vector3 begin = coordinates_in(triangle, points, k), end = coordinates_in(triangle, points, k + 1);
    if (begin == end) return no_points(0);
    Reached from = reach(triangle, begin);
    int corner = 0;
    const int to =
        end.maxCoeff(&corner) == 1 ? walker_.site_of(3 * triangle + corner) : add_site(triangle, end);
    pair_.tracer().trace({from.site, to}, from.place, walk_);
    SurfacePoints result = no_points(static_cast<int>(walk_.stops.size()));
    for (int i = 0; i < result.count(); ++i) {
      const Place& stop = walk_.stops[i];
      const bool is_crossing = i > 0 && i + 1 < result.count() && stop.kind == Place::Kind::on_edge;
      result.triangle[i] = stop.triangle();
      result.barycentric.row(i) = (is_crossing ? crossing_coordinates(stop, {from.site, to})
                                               : pair_.coordinates(stop, i == 0 ? from.site : to))
                                      .transpose();
    }
    return result;
  }

  Vector3 crossing_coordinates(const Place& stop, const Course& course) const {
    const DevelopedSurface& walked = pair_.walked();
    const int h = stop.halfedge, next = next_halfedge(h);
    const auto corner = [&](int at) { return pair_.signs().placed(walked.sites, walked.site_of(at)); };
    const auto end = [&](int site) { return pair_.signs().placed(walker_.sites, site, stop.element); };
    const double share =
        pair_.signs().share({corner(h), corner(next)}, {end(course.from), end(course.to)}).value;
    Vector3 result = Vector3::Zero();
    result[h % 3] = 1 - share;
    result[next % 3] = share;
    return result;
  }

  // A triangle that holds the points k and k + 1: one around the vertex that the first is nearest to.
  int common_triangle(const SurfacePoints& points, int k) const {
    int corner = 0;
    points.barycentric.row(k).maxCoeff(&corner);
    const int first = walker_.first_halfedge[walker_.vertex_of(3 * points.triangle[k] + corner)];
    int h = first;
    do {
      if (lies_in(h / 3, points, k) && lies_in(h / 3, points, k + 1)) return h / 3;
      h = walker_.opposite[previous_halfedge(h)];
    } while (h >= 0 && h != first);
    throw ArgumentError(fmt::format("points {} and {} do not lie in one triangle", k, k + 1));
  }

  bool lies_in(int triangle, const SurfacePoints& points, int k) const {
    for (int i = 0; i < 3; ++i)
      if (points.barycentric(k, i) != 0 &&
          walker_.corner_at(triangle, walker_.vertex_of(3 * points.triangle[k] + i)) < 0)
        return false;
    return true;
  }

  Vector3 coordinates_in(int triangle, const SurfacePoints& points, int k) const {
    Vector3 result = Vector3::Zero();
    for (int i = 0; i < 3; ++i)
      if (const double weight = points.barycentric(k, i); weight != 0)
        result[walker_.corner_at(triangle, walker_.vertex_of(3 * points.triangle[k] + i)) % 3] = weight;
    return result;
  }

  SurfacePair& pair_;
  const DevelopedSurface& walker_;
  std::vector<Fix> fixes_;
  Walk walk_;
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
  const DividedEars of_from(from), of_to(to);
  SurfacePair pair(of_to.parts(), of_from.parts());
  const std::vector<Fix> fixes = pair.locate_vertices();
  const int count = count_vertices(from);  // without the middles of ears
  VertexMap map = no_images(count);
  for (int v = 0; v < count; ++v) {
    const Fix& fix = fixes[v];
    if (fix.halfedge < 0) continue;
    map.images.triangle[v] = fix.place.triangle();
    map.images.barycentric.row(v) =
        pair.coordinates(fix.place, pair.walker().site_of(fix.halfedge)).transpose();
  }
  map.images = of_to.on_whole(std::move(map.images));
  name_corners(to, map);
  return map;
}

VertexMaps vertex_maps(const Overlay& overlay, const Embedding& a, const Embedding& b) {
  return {vertices_of_overlay(overlay, &OverlayVertex::a_vertex, overlay.on_b, {&a, &b}),
          vertices_of_overlay(overlay, &OverlayVertex::b_vertex, overlay.on_a, {&b, &a})};
}

SurfacePoints images_of_points(const Embedding& from, const Embedding& to, const SurfacePoints& points) {
  require_points(from, points);
  const DividedEars of_from(from), of_to(to);
  SurfacePair pair(of_to.parts(), of_from.parts());
  return of_to.on_whole(PointWalks(pair).images(of_from.on_parts(points)));
}

SurfacePoints image_of_polyline(const Embedding& from, const Embedding& to, const SurfacePoints& points) {
  require_points(from, points);
  for (int k = 0; k < points.count(); ++k)
    if (points.triangle[k] < 0) throw ArgumentError(fmt::format("point {} of a polyline is none", k));
  const DividedEars of_from(from), of_to(to);
  SurfacePair pair(of_to.parts(), of_from.parts());
  return of_to.on_whole(PointWalks(pair).polyline(of_from.polyline_on_parts(points)));
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
