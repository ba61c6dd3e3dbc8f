// SPDX-License-Identifier: MIT
#include "orbitutte/map/guessed_rotation.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

#include "orbitutte/parallel.h"

namespace orbitutte {
namespace {

using std::numbers::pi;
using Rotation = Eigen::Quaterniond;

// Some points of the sphere, evenly spread (a spiral by the golden angle).
Points spread_points(int count) {
  const double golden = pi * (3 - std::sqrt(5.0));
  Points result(count, 3);
  for (int k = 0; k < count; ++k) {
    const double z = 1 - (2 * k + 1.0) / count, r = std::sqrt(1 - z * z);
    result.row(k) << r * std::cos(golden * k), r * std::sin(golden * k), z;
  }
  return result;
}

// Parts of a surface's area, where they lie on the sphere.
struct Masses {
  Points at;
  Eigen::VectorXd mass;
};

Masses masses_of(const WholeSphereMap& map) {
  const Points positions = map.embedding.canonical_positions();
  const Triangles& F = map.embedding.triangles;
  Masses result = {Points(F.rows(), 3), Eigen::VectorXd(F.rows())};
  for (Eigen::Index f = 0; f < F.rows(); ++f) {
    const Vector3 sum = positions.row(F(f, 0)) + positions.row(F(f, 1)) + positions.row(F(f, 2));
    result.at.row(f) = sum.normalized().transpose();
    result.mass[f] = map.surface.area(f);
  }
  result.mass /= result.mass.sum();
  return result;
}

// A function on the sphere by its values on a grid of longitudes and latitudes.
class SphereGrid {
 public:
  static constexpr int rows = 48, columns = 96;

  Vector3 point(int row, int column) const {
    const double polar = pi * (row + 0.5) / rows, longitude = 2 * pi * column / columns;
    return {std::sin(polar) * std::cos(longitude), std::sin(polar) * std::sin(longitude), std::cos(polar)};
  }

  double& at(int row, int column) { return values_(row, column); }

  // Between the four nearest points.
  double operator()(const Vector3& x) const {
    const double polar = std::acos(std::clamp(x.z(), -1.0, 1.0)) / pi * rows - 0.5;
    const double around = (std::atan2(x.y(), x.x()) / (2 * pi) + 1) * columns;
    const int row = std::clamp(static_cast<int>(std::floor(polar)), 0, rows - 2);
    const int column = static_cast<int>(around);
    const double s = std::clamp(polar - row, 0.0, 1.0), t = around - column;
    const int left = column % columns, right = (column + 1) % columns;
    return (1 - s) * ((1 - t) * values_(row, left) + t * values_(row, right)) +
           s * ((1 - t) * values_(row + 1, left) + t * values_(row + 1, right));
  }

 private:
  Eigen::MatrixXd values_ = Eigen::MatrixXd::Zero(rows, columns);
};

// log of the density of the masses, each spread by the kernel exp((cos d - 1)/width^2); a thousandth of the
// mean density is added, so that emptiness counts no more than that.
SphereGrid log_density(const Masses& masses, double width) {
  constexpr double least = 1e-3;
  const double sharpness = 1 / (width * width), mean = width * width / 2;
  SphereGrid grid;
  parallel_for(SphereGrid::rows, [&](int row) {
    for (int column = 0; column < SphereGrid::columns; ++column) {
      const Vector3 x = grid.point(row, column);
      const double sum = (((masses.at * x).array() - 1) * sharpness).exp().matrix().dot(masses.mass);
      grid.at(row, column) = std::log(sum / mean + least);
    }
  });
  return grid;
}

// Both functions at one blur.
class Correlation {
 public:
  Correlation(const Masses& from, const Masses& to, double width)
      : samples_(spread_points(600)), to_(log_density(to, width)) {
    const SphereGrid grid = log_density(from, width);
    values_.resize(samples_.rows());
    for (Eigen::Index k = 0; k < samples_.rows(); ++k) values_[k] = grid(samples_.row(k));
    values_.array() -= values_.mean();
  }

  // The mean of both together does not change, but for the grid.
  double operator()(const Rotation& rotation) const {
    const Matrix3 R = rotation.toRotationMatrix();
    double sum = 0;
    for (Eigen::Index k = 0; k < samples_.rows(); ++k)
      sum += values_[k] * to_(R * samples_.row(k).transpose());
    return sum;
  }

 private:
  Points samples_;
  SphereGrid to_;
  Eigen::VectorXd values_;
};

struct Candidate {
  Rotation rotation;
  double value = 0;
};

bool is_better(const Candidate& first, const Candidate& second) { return first.value > second.value; }

// The best rotations of a grid of some 15 degrees.
std::vector<Candidate> best_of_grid(const Correlation& correlation, std::size_t count) {
  constexpr int directions = 200, turns = 24;
  const Points poles = spread_points(directions);
  std::vector<Candidate> all(directions * turns);
  parallel_for(directions, [&](int d) {
    const Rotation to_pole = Rotation::FromTwoVectors(Vector3::UnitZ(), Vector3(poles.row(d)));
    for (int t = 0; t < turns; ++t) {
      const Rotation turn(Eigen::AngleAxisd(2 * pi * t / turns, Vector3::UnitZ()));
      all[d * turns + t] = {to_pole * turn, 0};
      all[d * turns + t].value = correlation(all[d * turns + t].rotation);
    }
  });
  std::stable_sort(all.begin(), all.end(), is_better);
  all.resize(std::min(count, all.size()));
  return all;
}

// Uphill by small rotations about the axes, halved where none leads up.
Candidate refined(const Correlation& correlation, Candidate best, double step, double finest) {
  best.value = correlation(best.rotation);
  while (step > finest) {
    const Candidate before = best;
    for (int axis = 0; axis < 3; ++axis)
      for (const double angle : {step, -step}) {
        Candidate next = {Rotation(Eigen::AngleAxisd(angle, Vector3::Unit(axis))) * before.rotation, 0};
        next.value = correlation(next.rotation);
        if (is_better(next, best)) best = next;
      }
    if (!is_better(best, before)) step /= 2;
  }
  return best;
}

}  // namespace

Isometry guessed_rotation(const WholeSphereMap& from, const WholeSphereMap& to) {
  constexpr std::size_t kept = 30;
  const Masses masses_from = masses_of(from), masses_to = masses_of(to);
  std::vector<Candidate> candidates = best_of_grid({masses_from, masses_to, 0.35}, kept);
  double step = pi / 12;
  for (const double width : {0.35, 0.2, 0.12}) {
    const Correlation correlation(masses_from, masses_to, width);
    const double finest = step / 20;
    parallel_for(static_cast<int>(candidates.size()),
                 [&](int k) { candidates[k] = refined(correlation, candidates[k], step, finest); });
    std::stable_sort(candidates.begin(), candidates.end(), is_better);
    candidates.resize((candidates.size() + 1) / 2);
    step /= 3;
  }
  return Space::sphere().nearest_isometry(candidates.front().rotation.toRotationMatrix());
}

}  // namespace orbitutte
