// SPDX-License-Identifier: MIT
#include "orbitutte/quotient/centring.h"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <cmath>

#include "orbitutte/geometry/space.h"
#include "orbitutte/parallel.h"

namespace orbitutte {
namespace {

constexpr int most_centring_steps = 200, most_step_halvings = 40;
constexpr double longest_step = 3;       // the factor of scales is e to this power
constexpr double smallest_step = 1e-15;  // what rounding leaves

// Points with shares of the whole, carried along by the boosts.
struct SharedPoints {
  Points positions;
  Eigen::VectorXd share;

  int count() const { return static_cast<int>(share.size()); }
};

// The factor by which a boost shrinks lengths at a point: cosh t + sinh t <p, u>.
double shrinking(const Vector3& velocity, const Vector3& point) {
  const double t = velocity.norm();
  return t > 0 ? std::cosh(t) + std::sinh(t) / t * velocity.dot(point) : 1.0;
}

// The function whose derivative by boosts is the sum of shares * positions.
double potential_after(const SharedPoints& points, const Vector3& velocity) {
  return parallel_sum(points.count(), [&](int v) {
    return points.share[v] * std::log(shrinking(velocity, points.positions.row(v)));
  });
}

// The root of the derivative's linear part, among the vectors that the group fixes.
Vector3 newton_velocity(const Matrix3& slope, const Vector3& value, const Matrix3& fixed) {
  const Matrix3 restricted = fixed * slope * fixed + (Matrix3::Identity() - fixed);
  const Vector3 velocity = fixed * restricted.fullPivLu().solve(Vector3(fixed * value));
  const double length = velocity.norm();
  return length > longest_step ? Vector3(velocity * (longest_step / length)) : velocity;
}

Vector3 centre_of_mass(const SharedPoints& points) { return points.positions.transpose() * points.share; }

// The Newton step to where the centre of mass vanishes; shortened until the potential falls.
Vector3 barycentric_step(const SharedPoints& points, const Matrix3& fixed) {
  const Matrix3 slope =
      Matrix3::Identity() - points.positions.transpose() * points.share.asDiagonal() * points.positions;
  const Vector3 centre = centre_of_mass(points);
  Vector3 velocity = newton_velocity(slope, -centre, fixed);
  const double descent = centre.dot(velocity);
  if (velocity.norm() < 1e-3) return velocity;  // where Newton's method needs no watching
  for (int k = 0; k < most_step_halvings && potential_after(points, velocity) > 1e-4 * descent; ++k)
    velocity /= 2;
  return velocity;
}

// The faces' middles and log scales, for the least variance.
struct ScaledPoints {
  SharedPoints points;
  Eigen::VectorXd log_scale;
};

double variance_after(const ScaledPoints& scaled, const Vector3& velocity) {
  const SharedPoints& points = scaled.points;
  const auto scale = [&](int f) {
    return scaled.log_scale[f] - std::log(shrinking(velocity, points.positions.row(f)));
  };
  const double mean = parallel_sum(points.count(), [&](int f) { return points.share[f] * scale(f); });
  return parallel_sum(points.count(), [&](int f) {
    const double off = scale(f) - mean;
    return points.share[f] * off * off;
  });
}

// The step of Gauss and Newton: log scales change by -<p, velocity>.
Vector3 deviation_step(const ScaledPoints& scaled, const Matrix3& fixed) {
  const SharedPoints& points = scaled.points;
  const Vector3 middle = centre_of_mass(points);
  const Points off = points.positions.rowwise() - middle.transpose();
  Vector3 velocity = newton_velocity(off.transpose() * points.share.asDiagonal() * off,
                                     off.transpose() * points.share.cwiseProduct(scaled.log_scale), fixed);
  const double before = variance_after(scaled, Vector3::Zero());
  for (int k = 0; k < most_step_halvings; ++k, velocity /= 2)
    if (variance_after(scaled, velocity) < before) return velocity;
  return Vector3::Zero();
}

void carry_along(const Vector3& velocity, SharedPoints& points) {
  const Vector3 half_way = half_way_of(velocity);
  parallel_ranges(points.count(), [&](int begin, int end) {
    for (int v = begin; v < end; ++v) {
      const Vector3 point = points.positions.row(v);
      points.positions.row(v) = boosted(half_way, point).normalized().transpose();
    }
  });
}

// Images are taken from the chart in every step, so that no step's rounding adds to another's.
Moebius barycentric(const SphereImages& images, const Eigen::VectorXd& shares) {
  Moebius result;
  for (int step = 0; step < most_centring_steps; ++step) {
    const SharedPoints points = {positions_after(result, images.points), shares};
    const Vector3 velocity = barycentric_step(points, images.fixed);
    if (!velocity.allFinite() || velocity.norm() < smallest_step) break;
    result = Moebius::boost(velocity) * result;
  }
  return result;
}

ScaledPoints scaled_faces(const SphereImages& images) {
  const Triangles& F = images.surface.triangles;
  const Points positions = positions_after({}, images.points);
  ScaledPoints scaled = {{Points(F.rows(), 3), Eigen::VectorXd::Zero(F.rows())},
                         Eigen::VectorXd::Zero(F.rows())};
  for (int f = 0; f < static_cast<int>(F.rows()); ++f) {
    const Vector3 a = positions.row(F(f, 0)), b = positions.row(F(f, 1)), c = positions.row(F(f, 2));
    scaled.points.positions.row(f) = (a + b + c).normalized().transpose();
    const double source = images.surface.area(f), image = Space::sphere().area(a, b, c);
    if (!(source > 0) || !(image > 0)) continue;  // it has no scale
    scaled.points.share[f] = source;
    scaled.log_scale[f] = 0.5 * std::log(image / source);
  }
  scaled.points.share /= scaled.points.share.sum();
  return scaled;
}

Moebius least_deviation(const SphereImages& images) {
  constexpr double enough = 1e-10;
  ScaledPoints scaled = scaled_faces(images);
  Moebius result;
  for (int step = 0; step < most_centring_steps; ++step) {
    const Vector3 velocity = deviation_step(scaled, images.fixed);
    if (!velocity.allFinite() || velocity.norm() < enough) break;
    for (int f = 0; f < scaled.points.count(); ++f)
      scaled.log_scale[f] -= std::log(shrinking(velocity, scaled.points.positions.row(f)));
    carry_along(velocity, scaled.points);
    result = Moebius::boost(velocity) * result;
  }
  return result;
}

}  // namespace

Points positions_after(const Moebius& moebius, const std::vector<ChartPoint>& points) {
  Points result(static_cast<Eigen::Index>(points.size()), 3);
  parallel_ranges(static_cast<int>(points.size()), [&](int begin, int end) {
    for (int v = begin; v < end; ++v) result.row(v) = sphere_point(moebius(points[v])).transpose();
  });
  return result;
}

Eigen::VectorXd vertex_shares(const Surface& surface, Centre centre) {
  Eigen::VectorXd shares = Eigen::VectorXd::Zero(surface.vertex_count());
  if (centre == Centre::area) {
    shares = surface.vertex_areas();
  } else {
    for (const int v : surface.triangles.reshaped()) shares[v] = 1;
  }
  const double sum = shares.sum();
  return sum > 0 ? Eigen::VectorXd(shares / sum) : shares;
}

Vector3 step_to_centre(const Points& positions, const Eigen::VectorXd& shares, const Matrix3& fixed) {
  return barycentric_step({positions, shares}, fixed);
}

Vector3 half_way_of(const Vector3& velocity) {
  const double t = velocity.norm();
  return t > 0 ? Vector3(std::tanh(t / 2) / t * velocity) : velocity;
}

Moebius centring(const SphereImages& images, Centre centre) {
  if (centre == Centre::none) return {};
  if (centre == Centre::sigma) return least_deviation(images);
  return barycentric(images, vertex_shares(images.surface, centre));
}

}  // namespace orbitutte
