// SPDX-License-Identifier: MIT
#include "orbitutte/cones/scale_field.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>
#include <numeric>

#include "orbitutte/geometry/morton.h"
#include "orbitutte/orbifold/signature.h"

namespace orbitutte {
namespace {

using std::numbers::pi;

// log of a complex number; of 0 that of a very small one.
Complex finite_log(const Complex& a) {
  constexpr double least = -700, safe = 1e-290;
  const double square = std::norm(a), angle = std::atan2(a.imag(), a.real());
  if (square > safe) return {0.5 * std::log(square), angle};
  const double length = std::abs(a);
  return length > 0 ? Complex(std::log(length), angle) : Complex(least, 0);
}

// atan2(y, x) up to 2e-8 (M. Abramowitz, I. Stegun, "Handbook of Mathematical Functions" (1964), 4.4.49); not
// both are 0.
double quick_angle(double y, double x) {
  const double along = std::abs(x), across = std::abs(y),
               t = std::min(along, across) / std::max(along, across), q = t * t;
  const double power_series =
      1 + q * (-0.3333314528 +
               q * (0.1999355085 +
                    q * (-0.1420889944 +
                         q * (0.1065626393 +
                              q * (-0.0752896400 +
                                   q * (0.0429096138 + q * (-0.0161657367 + q * 0.0028662257)))))));
  const double octant = t * power_series, quadrant = across > along ? pi / 2 - octant : octant;
  return std::copysign(x < 0 ? pi - quadrant : quadrant, y);
}

// finite_log for tables, which need no more digits.
Complex quick_log(const Complex& a) {
  constexpr double safe = 1e-290;
  const double square = std::norm(a);
  if (!(square > safe)) return finite_log(a);
  return {0.5 * std::log(square), quick_angle(a.imag(), a.real())};
}

// Of the sphere; the double of a disk has twice the disk's.
double area_of_target(const Target& target) { return 4 * pi / target.group_order; }

// log of the scale of the map to 222, relative to |n dd - d dn|. Its cones lie at infinity, 1 and 0.
double log_scale_of_222(const ChartPoint& point) {
  static const ConeMetric metric({0.5, 0.5, 0.5});
  static const ChartPoint one = exact_point(1, 1);
  return metric.log_scale({point.denominator, bracket(point, one), -point.numerator});
}

ScaleSample sample_of(const KnownMap& map, const OrbifoldChart& chart, int f, double weight) {
  const FaceDistortion& face = map.faces[f];
  ScaleSample sample;
  sample.point = chart.of_triangle(f);
  sample.weight = weight;
  sample.log_scale =
      0.5 * std::log(face.area * area_of_target(map.embedding.target)) - log_scale_of_222(sample.point);
  sample.log_length = 0.5 * std::log(face.share);
  return sample;
}

bool is_measured(const FaceDistortion& face) { return face.area > 0 && face.share > 0; }

// The place of a point of the unit cube on Morton's curve.
std::uint64_t morton_code(const Vector3& p) {
  const auto cell = [&](int i) { return static_cast<std::uint64_t>(std::clamp(p[i] * 1024, 0.0, 1023.0)); };
  return place_on_curve(cell(0), cell(1), cell(2));
}

// The weight of every triangle that is taken: of `count` levels spread evenly over the area, the share of
// those that it holds. Every one its own share if there are not more.
std::vector<std::pair<int, double>> spread_over_area(const KnownMap& map, int count) {
  const std::vector<FaceDistortion>& faces = map.faces;
  std::vector<std::pair<int, double>> result;
  double total = 0;
  for (const FaceDistortion& face : faces)
    if (is_measured(face)) total += face.share;
  if (static_cast<int>(faces.size()) <= count) {
    for (const int f : map.order)
      if (is_measured(faces[f])) result.emplace_back(f, faces[f].share / total);
    return result;
  }
  double below = 0;
  int next = 0;
  for (const int f : map.order) {
    if (!is_measured(faces[f])) continue;
    below += faces[f].share / total;
    int levels = 0;
    for (; next < count && (next + 0.5) / count < below; ++next) ++levels;
    if (levels > 0) result.emplace_back(f, static_cast<double>(levels) / count);
  }
  return result;
}

// A triangle at each of the vertices that was measured.
std::vector<int> triangles_beside(const KnownMap& map, const std::vector<int>& vertices) {
  std::vector<int> triangle(map.surface.vertex_count(), -1);
  const Triangles& F = map.surface.triangles;
  for (int f = 0; f < F.rows(); ++f)
    if (is_measured(map.faces[f]))
      for (int k = 0; k < 3; ++k) triangle[F(f, k)] = f;
  std::vector<int> result;
  for (const int v : vertices)
    if (triangle[v] >= 0) result.push_back(triangle[v]);
  std::sort(result.begin(), result.end());
  result.erase(std::unique(result.begin(), result.end()), result.end());
  return result;
}

// The edges from a triangle's first corner to the others, in the plane.
struct PlaneEdges {
  Complex first, second;
};

PlaneEdges laid_out(const Vector3& first, const Vector3& second) {
  const double length = std::max(first.norm(), 1e-300);
  return {length, {first.dot(second) / length, first.cross(second).norm() / length}};
}

// By how much the Dirichlet energy of the linear map between two triangles exceeds the area, where the image
// is measured in twice the lengths: 8 times the square of its part that reverses orientations, times the
// area. 0 where a triangle has no area.
double excess_of(const PlaneEdges& from, const PlaneEdges& to) {
  const double area = (std::conj(from.first) * from.second).imag();
  return area > 0 ? std::norm(to.first * from.second - to.second * from.first) / area : 0;
}

// Of the cones of the surface, or of a disk's double, as parts of a full turn.
std::vector<double> angles_of_double(const Target& target) {
  std::vector<double> angles;
  for (int k = 0; k < static_cast<int>(target.marks.size()); ++k) {
    const double angle = 1.0 / target.marks[k].order();
    angles.push_back(angle);
    if (target.topology == Topology::disk && k < target.inner_marks) angles.push_back(angle);
  }
  return angles;
}

}  // namespace

std::vector<int> order_in_space(const Surface& surface) {
  const Triangles& F = surface.triangles;
  const Vector3 low = surface.V.colwise().minCoeff();
  const double size = std::max((surface.V.colwise().maxCoeff() - low.transpose()).maxCoeff(), 1e-300);
  std::vector<std::pair<std::uint64_t, int>> codes;
  codes.reserve(F.rows());
  for (int f = 0; f < F.rows(); ++f) {
    const Vector3 sum = surface.V.row(F(f, 0)) + surface.V.row(F(f, 1)) + surface.V.row(F(f, 2));
    codes.emplace_back(morton_code((sum / 3 - low) / size), f);
  }
  std::sort(codes.begin(), codes.end());
  std::vector<int> order;
  order.reserve(codes.size());
  for (const auto& [code, f] : codes) order.push_back(f);
  return order;
}

std::vector<ScaleSample> scale_samples(const KnownMap& map, int count, const std::vector<int>& vertices) {
  const OrbifoldChart chart(map.embedding);
  std::vector<ScaleSample> samples;
  for (const auto& [f, weight] : spread_over_area(map, count))
    samples.push_back(sample_of(map, chart, f, weight));
  for (const int f : triangles_beside(map, vertices)) samples.push_back(sample_of(map, chart, f, 0));
  return samples;
}

bool has_closed_form(const Target& target) {
  if (target.is_polygon() || target.has_free_tile || target.topology == Topology::projective_plane)
    return false;
  const std::size_t cones = angles_of_double(target).size();
  return cones == 2 || cones == 3;
}

VertexStars::VertexStars(const Surface& s)
    : surface(s), halfedges(group_by(static_cast<int>(s.triangles.size()), s.vertex_count(), [&](int h) {
        return halfedge_origin(s.triangles, h);
      })) {}

ScaleField::ScaleField(const OrbifoldChart& chart, const VertexStars& stars, std::vector<ScaleSample> samples)
    : chart_(chart), stars_(stars), samples_(std::move(samples)) {}

ScaleField::ScaleField(const ScaleField& other, std::vector<ScaleSample> samples)
    : chart_(other.chart_), stars_(other.stars_), samples_(std::move(samples)), metrics_(other.metrics_) {}

std::vector<ScaleField::Place> ScaleField::places(const MarkedTarget& choice) {
  const Target& target = choice.target;
  std::vector<Place> result;
  for (int k = 0; k < static_cast<int>(target.marks.size()); ++k) {
    const double angle = 1.0 / target.marks[k].order();
    result.push_back({choice.cones[k], false, angle});
    if (target.topology == Topology::disk && k < target.inner_marks)
      result.push_back({choice.cones[k], true, angle});
  }
  return result;
}

const ChartPoint& ScaleField::point(const Place& place) {
  const auto [at, is_new] = points_.try_emplace(place.key());
  if (is_new) {
    const ChartPoint point = chart_.of_vertex(place.vertex);
    at->second = place.is_mirrored ? conjugate(point) : point;
  }
  return at->second;
}

Complex ScaleField::log_bracket(const Place& a, const Place& b) {
  return finite_log(bracket(point(a), point(b)));
}

const ScaleField::Column& ScaleField::column(const Place& place) {
  const auto [at, is_new] = columns_.try_emplace(place.key());
  if (is_new) {
    const ChartPoint& cone = point(place);
    at->second.reserve(samples_.size());
    for (const ScaleSample& sample : samples_) at->second.push_back(quick_log(bracket(sample.point, cone)));
  }
  return at->second;
}

// P_i = [s, c_i] [c_j, c_k] for the sample s and the cones c: their sum is zero, and P_0 dP_1 - P_1 dP_0 is
// [c_0, c_1] [c_1, c_2] [c_2, c_0] times the chart's form.
void ScaleField::add_three_cones(const std::vector<Place>& cones, std::vector<double>& u) {
  const std::array<double, 3> angles = {cones[0].angle, cones[1].angle, cones[2].angle};
  const ConeMetric& metric = metrics_->try_emplace(angles, angles).first->second;
  const Complex k0 = log_bracket(cones[1], cones[2]), k1 = log_bracket(cones[2], cones[0]),
                k2 = log_bracket(cones[0], cones[1]);
  const double all = (k0 + k1 + k2).real();
  for (double& value : u) value += all;
  metric.add_quick_log_scales({column(cones[0]).data(), column(cones[1]).data(), column(cones[2]).data()},
                              {k0, k1, k2}, u);
}

// With z = [s, c_0]/[s, c_1] and m the scale along the axis, rho(z) = 2 a e^m |z|^(a-1) / (1 + e^(2m)
// |z|^(2a)).
void ScaleField::add_two_cones(const MarkedTarget& choice, const std::vector<Place>& cones,
                               std::vector<double>& u) {
  const double a = cones[0].angle, m = choice.cones.size() == 1 ? 0 : balance_along_axis(cones).log_scale,
               all = std::log(2 * a) + log_bracket(cones[0], cones[1]).real();
  const Column &c0 = column(cones[0]), &c1 = column(cones[1]);
  for (std::size_t s = 0; s < u.size(); ++s) {
    const double to_0 = c0[s].real(), to_1 = c1[s].real(), along = std::abs(a * (to_0 - to_1) + m);
    u[s] += all - to_0 - to_1 - along - std::log1p(std::exp(-2 * along));
  }
}

// rho = product of |[s, c_i]|^(a_i - 1), up to a factor.
void ScaleField::add_flat_cones(const std::vector<Place>& cones, std::vector<double>& u) {
  for (const Place& cone : cones) {
    const Column& c = column(cone);
    for (std::size_t s = 0; s < u.size(); ++s) u[s] += (cone.angle - 1) * c[s].real();
  }
}

// The excess of the triangles at a cone, whose images are laid out around it: z -> z^a with z = [s, cone]/[s,
// other].
double ScaleField::excess_at(const Place& cone, const Place& other) {
  const Surface& surface = stars_.surface;
  const auto log_ratio = [&](int v) {
    const Place place = {v, false, 0};
    return log_bracket(place, cone) - log_bracket(place, other);
  };
  double sum = 0;
  for (int k = stars_.halfedges.start[cone.vertex]; k < stars_.halfedges.start[cone.vertex + 1]; ++k) {
    const int h = stars_.halfedges.items[k], v = halfedge_target(surface.triangles, h),
              w = halfedge_target(surface.triangles, next_halfedge(h));
    const PlaneEdges from = laid_out(surface.V.row(v) - surface.V.row(cone.vertex),
                                     surface.V.row(w) - surface.V.row(cone.vertex));
    const Complex log_v = log_ratio(v), log_w = log_ratio(w);
    const double turn = std::remainder(log_w.imag() - log_v.imag(), 2 * pi);
    const PlaneEdges to = {std::exp(cone.angle * log_v.real()),
                           std::polar(std::exp(cone.angle * log_w.real()), cone.angle * turn)};
    sum += excess_of(from, to);
  }
  return sum;
}

// Maps to NN and *NN may slide along their axis, which does not change their Dirichlet energy. What holds
// them are the linear elements at both cones: their energy exceeds the area by the square of their size times
// what excess_at says, and the sum of both is least where they are equal.
const ScaleField::AxisBalance& ScaleField::balance_along_axis(const std::vector<Place>& cones) {
  const auto [at, is_new] = balances_.try_emplace({cones[0].vertex, cones[1].vertex, cones[0].angle});
  if (is_new) {
    const double first = excess_at(cones[0], cones[1]), second = excess_at(cones[1], cones[0]);
    if (first > 0 && second > 0)
      at->second = {0.25 * std::log(second / first), 2 * std::sqrt(first * second)};
  }
  return at->second;
}

double ScaleField::relative_error(const MarkedTarget& choice) {
  constexpr double most = 0.1;
  if (!are_opposite(choice.target.marks)) return 0;
  return std::min(2 * balance_along_axis(places(choice)).excess / area_of_target(choice.target), most);
}

double ScaleField::mean_over_samples(const std::vector<double>& u) const {
  double sum = 0;
  for (std::size_t s = 0; s < u.size(); ++s) sum += samples_[s].weight * u[s];
  return sum;
}

double ScaleField::variance_over_samples(const std::vector<double>& u) const {
  const double mean = mean_over_samples(u);
  double sum = 0;
  for (std::size_t s = 0; s < u.size(); ++s) sum += samples_[s].weight * (u[s] - mean) * (u[s] - mean);
  return sum;
}

double ScaleField::area_over_samples(const std::vector<double>& u) const {
  double area = 0;
  for (std::size_t s = 0; s < u.size(); ++s) area += samples_[s].weight * std::exp(2 * u[s]);
  return area;
}

std::vector<double> ScaleField::log_scale(const MarkedTarget& choice) {
  if (!has_closed_form(choice.target))
    throw ArgumentError("the scale of maps to " + choice.target.signature + " has no closed form");
  const std::vector<Place> cones = places(choice);
  std::vector<double> u;
  u.reserve(samples_.size());
  for (const ScaleSample& sample : samples_) u.push_back(sample.log_scale);
  if (choice.target.space.has_similarities())
    add_flat_cones(cones, u);
  else if (cones.size() == 2)
    add_two_cones(choice, cones, u);
  else
    add_three_cones(cones, u);
  const double area =
      choice.target.space.has_similarities() ? area_over_samples(u) : area_of_target(choice.target);
  const double half_log_area = 0.5 * std::log(area);
  for (double& value : u) value -= half_log_area;
  return u;
}

double ScaleField::sigma(const MarkedTarget& choice) {
  return std::sqrt(variance_over_samples(log_scale(choice)));
}

ScaleSummary ScaleField::spread_of(const std::vector<double>& u) const {
  double least = std::numeric_limits<double>::infinity(), greatest = -least;
  ScaleSummary result;
  result.log_least_length = least;
  for (std::size_t s = 0; s < u.size(); ++s) {
    least = std::min(least, u[s]);
    greatest = std::max(greatest, u[s]);
    result.log_least_length = std::min(result.log_least_length, u[s] + samples_[s].log_length);
  }
  result.sigma = std::sqrt(variance_over_samples(u));
  result.range = (greatest - least) / std::log(2);
  return result;
}

ScaleSummary ScaleField::spread(const MarkedTarget& choice) { return spread_of(log_scale(choice)); }

ScaleSummary ScaleField::summary(const MarkedTarget& choice) {
  const std::vector<double> u = log_scale(choice);
  ScaleSummary result = spread_of(u);
  double inverse = 0;
  for (std::size_t s = 0; s < u.size(); ++s) {
    const double weight = samples_[s].weight;
    inverse += weight * std::exp(std::min(-2 * u[s], 600.0));
    if (std::abs(u[s]) <= std::log(2)) result.within_4 += weight;
    if (u[s] < -std::log(8)) result.below_64 += weight;
  }
  result.symmetric_dirichlet = (1 + inverse) / 2;
  return result;
}

}  // namespace orbitutte
