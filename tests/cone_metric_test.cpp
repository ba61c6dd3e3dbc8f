// SPDX-License-Identifier: MIT
#include "orbitutte/cones/cone_metric.h"

#include <cmath>
#include <numbers>

#include "orbitutte/errors.h"
#include "test_meshes.h"

namespace orbitutte {
namespace {

using std::numbers::pi;
using Complex = std::complex<double>;
using Angles = std::array<double, 3>;

const std::vector<Angles> some_angles = {{1. / 3, 1. / 4, 1. / 2},  {1. / 2, 1. / 2, 1. / 2},
                                         {1. / 5, 1. / 3, 1. / 2},  {0.6, 0.8, 0.5},
                                         {1. / 12, 1. / 2, 1. / 2}, {1. / 3, 1. / 3, 1. / 2}};

// z is 0, 1 and infinity at the cones 0, 1 and 2; the form that scales are relative to is |dz|.
ConeCoordinates coordinates(Complex z) { return {-z, z - 1.0, 1}; }

double log_rho(const ConeMetric& metric, Complex z) { return metric.log_scale(coordinates(z)); }

std::vector<Complex> some_points() {
  std::vector<Complex> points;
  for (const double r : {0.03, 0.4, 0.97, 1.3, 6.0, 40.0})
    for (const double angle : {0.2, 1.04, pi / 3, 2.0, 3.0, -0.7, -2.4})
      points.push_back(std::polar(r, angle));
  return points;
}

// K = -(laplacian of log rho)/rho^2.
TEST(ConeMetric, HasCurvatureOne) {
  for (const Angles& angles : some_angles) {
    const ConeMetric metric(angles);
    for (const Complex z : some_points()) {
      const double h = 3e-4 * std::min(std::abs(z), std::abs(z - 1.0));
      const Complex i(0, 1);
      const double laplacian = (log_rho(metric, z + h) + log_rho(metric, z - h) + log_rho(metric, z + h * i) +
                                log_rho(metric, z - h * i) - 4 * log_rho(metric, z)) /
                               (h * h);
      const double unit = std::exp(2 * log_rho(metric, z)) + std::pow(std::abs(z), -2) * 1e-4;
      EXPECT_NEAR(-laplacian / unit, std::exp(2 * log_rho(metric, z)) / unit, 2e-3) << z;
    }
  }
}

TEST(ConeMetric, IsTheSameForAllNumberingsOfTheCones) {
  for (const Angles& a : some_angles) {
    for (const Complex z : some_points()) {
      const ConeCoordinates P = coordinates(z);
      const double value = ConeMetric(a).log_scale(P);
      EXPECT_NEAR(ConeMetric({a[1], a[0], a[2]}).log_scale({P[1], P[0], P[2]}), value, 1e-9);
      EXPECT_NEAR(ConeMetric({a[2], a[0], a[1]}).log_scale({P[2], P[0], P[1]}), value, 1e-9);
      EXPECT_NEAR(ConeMetric(a).log_scale(coordinates(std::conj(z))), value, 1e-9);
    }
  }
}

// Neighbours across the lines where one numbering takes over from another.
TEST(ConeMetric, IsContinuousWhereNumberingsMeet) {
  for (const Angles& a : some_angles) {
    const ConeMetric metric(a);
    for (double t = 0.1; t < 3; t += 0.1) {
      const Complex on_circle = std::polar(1.0, t), on_line(0.5, t);
      EXPECT_NEAR(log_rho(metric, on_circle * 0.9999999), log_rho(metric, on_circle * 1.0000001), 1e-5);
      EXPECT_NEAR(log_rho(metric, on_line - 1e-7), log_rho(metric, on_line + 1e-7), 1e-5);
    }
  }
}

// In coordinates in which the area element is smooth at the cones: z = r^(1/a) e^(i t) and its images.
double integrated_area(const Angles& angles) {
  const ConeMetric metric(angles);
  const int n = 400;
  double area = 0;
  for (int cone = 0; cone < 3; ++cone) {
    const double a = angles[cone];
    for (int i = 0; i < n; ++i) {
      for (int j = 0; j < n; ++j) {
        const double s = (i + 0.5) / n, t = 2 * pi * (j + 0.5) / n, r = std::pow(s, 1 / a);
        const Complex z = std::polar(r, t);
        // The part of the sphere where the cone's own coordinate is the least.
        if (r > std::abs(1.0 - z)) continue;
        ConeCoordinates P;
        P[cone] = -z;
        P[(cone + 1) % 3] = z - 1.0;
        P[(cone + 2) % 3] = 1;
        area += std::exp(2 * metric.log_scale(P)) * r * r / (a * s) * (1.0 / n) * (2 * pi / n);
      }
    }
  }
  return area;
}

TEST(ConeMetric, HasTheAreaOfGaussAndBonnet) {
  for (const Angles& angles : some_angles)
    EXPECT_NEAR(integrated_area(angles) / ConeMetric(angles).area(), 1, 5e-3);
}

// 222 is the sphere under half turns about the axes, Z = (w^2 + 1)^2/(4 w^2) its invariant.
TEST(ConeMetric, OfThreeHalfTurnsIsTheRoundSphere) {
  const ConeMetric metric({0.5, 0.5, 0.5});
  for (const Complex w : some_points()) {
    const Complex Z = (w * w + 1.0) * (w * w + 1.0) / (4.0 * w * w),
                  slope = (w * w * w * w - 1.0) / (2.0 * w * w * w);
    EXPECT_NEAR(log_rho(metric, Z) + std::log(std::abs(slope)), std::log(2 / (1 + std::norm(w))), 1e-9) << w;
  }
}

TEST(ConeMetric, TheTableAgreesWithTheSeries) {
  for (const Angles& angles : some_angles) {
    const ConeMetric metric(angles);
    for (const Complex z : some_points()) {
      const ConeCoordinates P = coordinates(z);
      const ConeCoordinates logs = {std::log(P[0]), std::log(P[1]), std::log(P[2])};
      std::vector<double> u = {0};
      metric.add_quick_log_scales({&logs[0], &logs[1], &logs[2]}, {}, u);
      EXPECT_NEAR(u[0], metric.log_scale(P), 5e-4) << angles[0] << " " << z;
    }
  }
}

TEST(ConeMetric, RefusesAnglesOfNoTriangle) {
  EXPECT_THROW(ConeMetric({1. / 3, 1. / 3, 1. / 3}), ArgumentError);
  EXPECT_THROW(ConeMetric({0.9, 0.3, 0.1}), ArgumentError);
  EXPECT_THROW(ConeMetric({0.5, 0.5, 1}), ArgumentError);
  EXPECT_THROW(ConeMetric({0.5, 0.5, 0}), ArgumentError);
}

}  // namespace
}  // namespace orbitutte
