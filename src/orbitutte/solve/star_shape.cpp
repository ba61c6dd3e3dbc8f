// SPDX-License-Identifier: MIT
#include "orbitutte/solve/star_shape.h"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

namespace orbitutte {
namespace {

constexpr int most_newton_steps = 60, most_halvings = 6;
constexpr double negligible_gain = 1e-3;   // of the distortion, by a step of Newton's
constexpr double flat_part = 0.01;         // of a ratio, that the area of a flat triangle counts for
constexpr double flattest_of_star = 1e-6;  // a source triangle's least height, relative to its base
constexpr double no_bound = std::numeric_limits<double>::infinity();

// The altitude of the source triangle in the image, were the star's vertex moved by a tangent step.
Vector3 image_of_altitude(const StarShape::Triangle& triangle, const Vector3& step) {
  return triangle.a + triangle.foot * (triangle.b - triangle.a) - step;
}

// The Dirichlet energy of the linear map of a triangle, its base c mapped to c', its height h to h':
//   (b h/2) (|c'|^2/b^2 + |h'|^2/h^2)
// Sums of cotangents (U. Pinkall, K. Polthier 1993) are the same, but lose digits in thin triangles.
double energy_of_image(const StarShape::Triangle& triangle, const Vector3& step) {
  return triangle.weight * image_of_altitude(triangle, step).squaredNorm() + triangle.fixed_energy;
}

// s1/s2; infinite unless the triangle is positive then. The energy over the area of the image is
// s1/s2 + s2/s1.
double ratio_of_singular_values(const StarShape::Triangle& triangle, const Vector3& step) {
  const double twice_area = triangle.value + triangle.gradient.dot(step);
  if (!(twice_area > 0)) return std::numeric_limits<double>::infinity();
  const double sum = std::max(energy_of_image(triangle, step) / (0.5 * twice_area), 2.0);
  return 0.5 * (sum + std::sqrt(std::max(sum * sum - 4, 0.0)));
}

// A barrier in place of the ratio of a triangle that is flat in the source, which no map distorts less for
// being wider, but which must be positive: -c log(2 A/r^2), r the star's radius.
double barrier(const StarShape& shape, const StarShape::Triangle& triangle, const Vector3& step) {
  const double twice_area = triangle.value + triangle.gradient.dot(step);
  if (!(twice_area > 0)) return std::numeric_limits<double>::infinity();
  return flat_part * std::max(0.0, -std::log(twice_area / (shape.radius * shape.radius)));
}

// Of q where q + 1/q = E/A; E is quadratic, and A linear. With s = E/A and r = sqrt(s^2 - 4),
//   s' = (E' - s A')/A    s'' = (E'' - s' A'^T - A' s'^T)/A
//   q' = q/r s'           q'' = q/r s'' + q/r^2 (1 - s/r) s' s'^T
void add_derivatives(const StarShape& shape, const StarShape::Triangle& triangle, const Vector3& step,
                     DistortionDerivatives& sum) {
  const double area = 0.5 * (triangle.value + triangle.gradient.dot(step));
  const double s = energy_of_image(triangle, step) / area, r = std::sqrt(std::max(s * s - 4, 1e-8)),
               q = 0.5 * (s + r);
  const Eigen::Vector2d area_1 = 0.5 * shape.axes.transpose() * triangle.gradient;
  const Vector3 pull = triangle.weight * image_of_altitude(triangle, step);
  const Eigen::Vector2d s_1 = (-2 * shape.axes.transpose() * pull - s * area_1) / area;
  const Eigen::Matrix2d mixed = s_1 * area_1.transpose(),
                        energy_2 = 2 * triangle.weight * shape.axes.transpose() * shape.axes;
  sum.gradient += q / r * s_1;
  sum.hessian += q / r * (energy_2 - mixed - mixed.transpose()) / area +
                 q / (r * r) * (1 - s / r) * s_1 * s_1.transpose();
}

void add_derivatives_of_barrier(const StarShape& shape, const StarShape::Triangle& triangle,
                                const Vector3& step, DistortionDerivatives& sum) {
  const Eigen::Vector2d slope =
      shape.axes.transpose() * triangle.gradient / (triangle.value + triangle.gradient.dot(step));  // A'/A
  sum.gradient -= flat_part * slope;
  sum.hessian += flat_part * slope * slope.transpose();
}

// Newton's step, of eigenvalues' absolute values; along a mirror only, if the vertex lies on one.
Eigen::Vector2d newton_step(const StarShape& shape, const Vector3& from) {
  const auto [gradient, hessian] = derivatives_of_distortion(shape, from);
  if (shape.on_mirror) return {-gradient.x() / std::abs(hessian(0, 0)), 0};
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> eigen;
  eigen.computeDirect(hessian);
  const Eigen::Vector2d along = eigen.eigenvectors().transpose() * gradient;
  return -eigen.eigenvectors() * along.cwiseQuotient(eigen.eigenvalues().cwiseAbs());
}

}  // namespace

void set_source(const Vector3& va, const Vector3& vb, StarShape::Triangle& triangle) {
  triangle.source = {va.squaredNorm(), vb.squaredNorm(), (vb - va).squaredNorm()};
  const double C2 = triangle.source[2];
  triangle.base = std::sqrt(C2);
  const double height = triangle.base > 0 ? va.cross(vb).norm() / triangle.base : 0.0,
               least = flattest_of_star * std::max(triangle.base, va.norm());
  triangle.is_flat = !(height > least);
  triangle.height = std::max(height, least);
  triangle.foot = C2 > 0 ? -va.dot(vb - va) / C2 : 0.0;
  triangle.weight = triangle.base / (2 * triangle.height);
  const double base = std::max(triangle.base, 1e-300);
  triangle.fixed_energy = triangle.height / (2 * base) * (triangle.b - triangle.a).squaredNorm();
}

double distortion(const StarShape& shape, const Vector3& step, double bound) {
  double sum = 0;
  for (const StarShape::Triangle& triangle : shape.triangles) {
    sum += triangle.is_flat ? barrier(shape, triangle, step) : ratio_of_singular_values(triangle, step);
    if (sum >= bound) break;
  }
  return sum;
}

DistortionDerivatives derivatives_of_distortion(const StarShape& shape, const Vector3& step) {
  DistortionDerivatives sum;
  for (const StarShape::Triangle& triangle : shape.triangles)
    triangle.is_flat ? add_derivatives_of_barrier(shape, triangle, step, sum)
                     : add_derivatives(shape, triangle, step, sum);
  return sum;
}

SmoothedStar least_distortion(const StarShape& shape) {
  Eigen::Vector2d best(0, 0);
  const double at_first = distortion(shape, Vector3::Zero(), no_bound);
  double least = at_first;
  for (int k = 0; k < most_newton_steps && std::isfinite(least); ++k) {
    Eigen::Vector2d step = newton_step(shape, shape.axes * best);
    if (!step.allFinite()) break;
    step *= std::min(1.0, 0.5 * shape.radius / step.norm());
    const double before = least;
    for (int halving = 0; halving < most_halvings && !(least < before); ++halving, step /= 2)
      if (const double there = distortion(shape, shape.axes * (best + step), least); there < least) {
        least = there;
        best += step;
      }
    if (!(least < (1 - negligible_gain) * before)) break;
  }
  return {best, at_first, least};
}

}  // namespace orbitutte
