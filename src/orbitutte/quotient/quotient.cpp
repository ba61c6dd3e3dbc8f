// SPDX-License-Identifier: MIT
#include "orbitutte/quotient/quotient.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "orbitutte/cones/chart.h"
#include "orbitutte/orbifold/exact_positions.h"
#include "orbitutte/orbifold/families.h"
#include "orbitutte/orbifold/signature.h"
#include "orbitutte/parallel.h"
#include "orbitutte/quotient/centring.h"

namespace orbitutte {
namespace {

// Which curve of the chart the boundary of a disk comes to lie on.
enum class ChartMirror { real_line, unit_circle };

bool has_one_axis(const ConwaySymbol& symbol) {
  const Family* family = find_family(symbol);
  return family && family->has_one_axis;
}

// z^N, z = (x + iy)/(1 + z) of a unit vector.
ChartPoint power(const Vector3& p, int order) {
  const double radius = std::hypot(p.x(), p.y()), angle = order * std::atan2(p.y(), p.x());
  const double log_size =
      order * (p.z() >= 0 ? std::log(radius / (1 + p.z())) : std::log((1 - p.z()) / radius));
  if (log_size > 0) return {1, std::polar(std::exp(-log_size), -angle), nullptr};
  return {std::polar(std::exp(log_size), angle), 1, nullptr};
}

// The chart's points of the input vertices.
std::vector<ChartPoint> chart_points(const Surface& surface, const Embedding& base) {
  std::vector<ChartPoint> points(surface.vertex_count());
  const auto fill = [&](const auto& of_vertex) {
    parallel_ranges(surface.vertex_count(), [&](int begin, int end) {
      for (int v = begin; v < end; ++v) points[v] = of_vertex(v);
    });
  };
  if (has_orbifold_chart(base.target)) {
    const OrbifoldChart chart(base);
    fill([&](int v) { return chart.of_vertex(v); });
  } else {
    const Points positions = base.canonical_positions();
    const int order = base.target.marks[0].order();
    fill([&](int v) { return power(positions.row(v), order); });
  }
  return points;
}

ChartMirror mirror_of(const Target& base) {
  const bool has_cone_inside = base.inner_marks > 0;
  return has_cone_inside ? ChartMirror::unit_circle : ChartMirror::real_line;
}

// Takes the chart of a disk to a hemisphere: its mirror to the equator.
Moebius to_equator(ChartMirror mirror) {
  if (mirror == ChartMirror::unit_circle) return {};
  return Moebius::rotation(Eigen::AngleAxisd(std::acos(0.0), Vector3::UnitX()).toRotationMatrix());
}

Moebius half_turn() { return Moebius::rotation(Vector3(1, -1, -1).asDiagonal()); }

void carry_by(const Moebius& moebius, std::vector<ChartPoint>& points) {
  parallel_ranges(static_cast<int>(points.size()), [&](int begin, int end) {
    for (int v = begin; v < end; ++v) points[v] = moebius(points[v]);
  });
}

// The sum of the heights: which side of the equator most points are on.
double height_of(const std::vector<ChartPoint>& points) {
  return parallel_sum(static_cast<int>(points.size()), [&](int v) { return sphere_point(points[v]).z(); });
}

bool is_closed_surface(const Target& onto) { return onto.topology == Topology::sphere; }

// What the elements of the group leave as it is.
Matrix3 fixed_by(const Target& onto) {
  return is_closed_surface(onto) ? Matrix3(Matrix3::Identity()) : Matrix3(Vector3(1, 1, 0).asDiagonal());
}

// The shortest rotation that takes one unit vector to another; between opposite points, about an axis that is
// as near to (0, 0, 1) as can be.
Matrix3 rotation_between(const Vector3& from, const Vector3& to) {
  if ((from + to).norm() > 1e-9) return Eigen::Quaterniond::FromTwoVectors(from, to).toRotationMatrix();
  const Vector3 pole = std::abs(from.z()) < 0.9 ? Vector3::UnitZ() : Vector3::UnitX();
  return Eigen::AngleAxisd(std::acos(-1.0), Vector3(pole - pole.dot(from) * from).normalized())
      .toRotationMatrix();
}

constexpr double rounding_of_points = 1e-12;

void require_point_of_sphere(const Surface& surface, const PolygonCorner& at) {
  if (at.vertex < 0 || at.vertex >= surface.vertex_count())
    throw MeshError(fmt::format("vertex {} is to lie at a given point, but the mesh has the vertices 0 to {}",
                                at.vertex, surface.vertex_count() - 1));
  if (!(std::abs(at.position.norm() - 1) <= rounding_of_points))
    throw ArgumentError(fmt::format("the point for vertex {} is not on the unit sphere", at.vertex));
}

void require_point_of_equator(const PolygonCorner& at, bool is_outer) {
  if (!is_outer)
    throw MeshError(
        fmt::format("vertex {} is inside the disk; on a hemisphere, give points for vertices of the boundary",
                    at.vertex));
  if (!(std::abs(at.position.z()) <= rounding_of_points))
    throw ArgumentError(fmt::format(
        "the point for vertex {} of the boundary is not on the equator of the hemisphere, z = 0", at.vertex));
}

void require_different(const std::vector<PolygonCorner>& points) {
  constexpr double apart = 1e-9;
  for (std::size_t k = 0; k < points.size(); ++k)
    for (std::size_t i = 0; i < k; ++i)
      if (points[i].vertex == points[k].vertex || (points[i].position - points[k].position).norm() < apart)
        throw ArgumentError(
            fmt::format("the vertices {} and {} are to lie at given points, but they or their points are the "
                        "same; give others",
                        points[i].vertex, points[k].vertex));
}

// Of three vertices to three points.
Moebius through_three(const std::vector<ChartPoint>& points, const std::vector<PolygonCorner>& at) {
  std::array<ChartPoint, 3> from, to;
  for (int k = 0; k < 3; ++k) {
    from[k] = points[at[k].vertex];
    to[k] = chart_point_of(at[k].position);
  }
  return Moebius::through(from, to);
}

// The boost that makes two opposite points a pair as near to each other as p and q, on either side of the
// direction between these; its inverse is the boost of the opposite velocity.
Vector3 velocity_towards(const Vector3& p, const Vector3& q) {
  const Vector3 sum = p + q;
  if (!(sum.norm() > 1e-15)) return Vector3::Zero();
  const Vector3 between = sum.normalized();
  return std::atanh(between.dot(p)) * between;
}

// Of two vertices to two points. What is left, the boosts between opposite images, is centred.
Moebius through_two(const SphereImages& images, const QuotientOptions& options) {
  const std::vector<PolygonCorner>& at = options.points;
  const Centre wanted = options.centre.value_or(Centre::area);
  Moebius moebius = centring(images, wanted);
  const auto image = [&](int k) { return sphere_point(moebius(images.points[at[k].vertex])); };
  moebius = Moebius::boost(-velocity_towards(image(0), image(1))) * moebius;
  const Vector3 axis = image(0), axis_there = (at[0].position - at[1].position).normalized();
  std::vector<ChartPoint> points = images.points;
  carry_by(moebius, points);
  moebius = centring({images.surface, points, axis * axis.transpose()}, wanted) * moebius;
  return Moebius::boost(velocity_towards(at[0].position, at[1].position)) *
         Moebius::rotation(rotation_between(axis, axis_there)) * moebius;
}

Moebius wanted_map(const SphereImages& images, const QuotientOptions& options) {
  const std::vector<PolygonCorner>& at = options.points;
  if (at.size() == 3) return through_three(images.points, at);
  if (at.size() == 2) return through_two(images, options);
  Moebius centred = centring(images, options.centre.value_or(Centre::area));
  if (at.empty()) return centred;
  const Vector3 now = sphere_point(centred(images.points[at[0].vertex]));
  return Moebius::rotation(rotation_between(now, at[0].position)) * centred;
}

// What the group leaves as it is, in the frame of the embedding.
Matrix3 fixed_by_group_of(const Embedding& embedding) {
  const Isometry& placement = embedding.placement;
  return placement.matrix() * fixed_by(embedding.target) * placement.inverse_matrix();
}

// Moves all positions, offsets included.
void boost_positions(const Vector3& velocity, Embedding& embedding) {
  const Vector3 half_way = half_way_of(velocity);
  Embedding moved = embedding;
  moved.offsets.clear();
  const ExactPositions positions(embedding);
  for (int v = 0; v < static_cast<int>(embedding.positions.rows()); ++v) {
    if (const int offsets = positions.offset_count(v); offsets > 0) {
      store(moved, v, boosted(half_way, positions.exact(v)), offsets);
    } else {
      const Vector3 point = embedding.positions.row(v);
      moved.positions.row(v) = boosted(half_way, point).normalized().transpose();
    }
  }
  embedding = std::move(moved);
}

}  // namespace

Target quotient_target(const Target& base) {
  const bool has_symbol = !base.is_polygon() && !base.has_free_tile;
  if (!has_symbol || !(has_orbifold_chart(base) || has_one_axis(base.symbol)))
    throw ArgumentError(
        fmt::format("the quotient of a map to {} is not known; there are those of NN, *NN, N*, 222 and *222",
                    base.signature));
  return parse_orbifold(base.topology == Topology::sphere ? "1" : "*");
}

Target quotient_base(const Target& whole) { return standard_target(whole.topology); }

void require_points(const Surface& surface, const Target& onto, const std::vector<PolygonCorner>& points) {
  if (points.size() > 3)
    throw ArgumentError(fmt::format(
        "{} vertices are to lie at given points; three decide the map, so give no more", points.size()));
  const std::vector<char> is_outer =
      is_closed_surface(onto) ? std::vector<char>() : surface.boundary_vertices();
  for (const PolygonCorner& at : points) {
    require_point_of_sphere(surface, at);
    if (!is_closed_surface(onto)) require_point_of_equator(at, is_outer[at.vertex] != 0);
  }
  require_different(points);
}

QuotientMap::QuotientMap(const Surface& surface, const Embedding& base, const Target& onto,
                         const QuotientOptions& options)
    : chart_(chart_points(surface, base)) {
  require_points(surface, onto, options.points);
  const auto images = [&] {
    std::vector<ChartPoint> points = chart_;
    carry_by(moebius_, points);
    return points;
  };
  if (!is_closed_surface(onto)) {
    moebius_ = to_equator(mirror_of(base.target));
    if (height_of(images()) < 0) moebius_ = half_turn() * moebius_;
  }
  moebius_ = wanted_map({surface, images(), fixed_by(onto)}, options) * moebius_;
  if (!is_closed_surface(onto) && height_of(images()) < 0)
    throw ArgumentError(
        fmt::format("the points for the vertices {}, {} and {} run around the hemisphere clockwise, seen "
                    "from above, where the boundary of the disk runs counterclockwise; exchange two of them",
                    options.points[0].vertex, options.points[1].vertex, options.points[2].vertex));
}

Points QuotientMap::positions() const { return positions_after(moebius_, chart_); }

void centre_anew(const Surface& surface, Centre centre, Embedding& embedding) {
  constexpr int most_boosts = 5;
  constexpr double enough = 1e-15;
  if (centre != Centre::area && centre != Centre::vertices) return;
  const Eigen::VectorXd shares = vertex_shares(surface, centre);
  const Matrix3 fixed = fixed_by_group_of(embedding);
  for (int k = 0; k < most_boosts; ++k) {
    const Vector3 velocity = step_to_centre(embedding.positions.topRows(shares.size()), shares, fixed);
    if (!(velocity.norm() > enough)) return;
    boost_positions(velocity, embedding);
  }
}

double distance_from_centre(const Surface& surface, Centre centre, const Embedding& embedding) {
  const Eigen::VectorXd shares = vertex_shares(surface, centre);
  const Vector3 sum = embedding.positions.topRows(shares.size()).transpose() * shares;
  return (fixed_by_group_of(embedding) * sum).norm();
}

}  // namespace orbitutte
