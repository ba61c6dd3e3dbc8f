// SPDX-License-Identifier: MIT
#include "orbitutte/cones/fitted_angles.h"

#include <fmt/format.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

namespace orbitutte {
namespace {

using std::numbers::pi;

// Multipliers of the wrong sign that are smaller than this, relative to the pull, are rounding.
constexpr double multiplier_rounding = 1e-11;

// The state of the active-set method: x within its bounds, some entries of it held there.
class ActiveSet {
 public:
  ActiveSet(const CurvatureFit& fit, const CurvatureBounds& bounds)
      : fit_(fit), bounds_(bounds), is_held_(bounds.least.size(), 0) {
    const Eigen::VectorXd width = bounds.greatest - bounds.least;
    const double share = bounds.sum ? (*bounds.sum - bounds.least.sum()) / width.sum() : 0.5;
    x_ = bounds.least + share * width;
  }

  // Goes to the minimum over what is free, or to the first bound on the way, where that entry is held.
  // Was the minimum reached?
  bool descend() {
    const std::vector<Eigen::Index> free = free_entries();
    const Eigen::VectorXd target = minimum_over(free);
    double step = 1;
    Eigen::Index blocking = -1;
    for (std::size_t i = 0; i < free.size(); ++i) {
      const double move = target[i] - x_[free[i]],
                   room = (move > 0 ? bounds_.greatest : bounds_.least)[free[i]] - x_[free[i]];
      if (move != 0 && room / move < step) step = room / move, blocking = free[i];
    }
    for (std::size_t i = 0; i < free.size(); ++i) x_[free[i]] += step * (target[i] - x_[free[i]]);
    if (blocking < 0) return true;
    const bool at_greatest =
        bounds_.greatest[blocking] - x_[blocking] < x_[blocking] - bounds_.least[blocking];
    x_[blocking] = (at_greatest ? bounds_.greatest : bounds_.least)[blocking];
    is_held_[blocking] = at_greatest ? 1 : -1;
    return false;
  }

  // Releases the entry that its bound keeps from the minimum the most. Was there one?
  bool release() {
    const Eigen::VectorXd slope = fit_.gram * x_ - fit_.pull;
    Eigen::Index worst = -1;
    double most = multiplier_rounding * (1 + fit_.pull.cwiseAbs().maxCoeff());
    for (Eigen::Index i = 0; i < x_.size(); ++i) {
      const double gain = is_held_[i] * (slope[i] + multiplier_);
      if (is_held_[i] != 0 && gain > most) most = gain, worst = i;
    }
    if (worst >= 0) is_held_[worst] = 0;
    return worst >= 0;
  }

  const Eigen::VectorXd& x() const { return x_; }

 private:
  std::vector<Eigen::Index> free_entries() const {
    std::vector<Eigen::Index> free;
    for (Eigen::Index i = 0; i < x_.size(); ++i)
      if (is_held_[i] == 0) free.push_back(i);
    return free;
  }

  // Solves [gram 1; 1' 0] [x; multiplier] = [pull; sum] for the free entries, the others being held.
  Eigen::VectorXd minimum_over(const std::vector<Eigen::Index>& free) {
    const Eigen::Index count = static_cast<Eigen::Index>(free.size()), rows = count + (bounds_.sum ? 1 : 0);
    Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(rows, rows);
    Eigen::VectorXd right(rows);
    Eigen::VectorXd held = x_;
    for (const Eigen::Index i : free) held[i] = 0;
    const Eigen::VectorXd pull = fit_.pull - fit_.gram * held;
    for (Eigen::Index i = 0; i < count; ++i) {
      right[i] = pull[free[i]];
      for (Eigen::Index j = 0; j < count; ++j) matrix(i, j) = fit_.gram(free[i], free[j]);
      if (bounds_.sum) matrix(i, count) = matrix(count, i) = 1;
    }
    if (bounds_.sum) right[count] = *bounds_.sum - held.sum();
    if (rows == 0) return right;
    const Eigen::VectorXd solution = matrix.partialPivLu().solve(right);
    multiplier_ = bounds_.sum ? solution[count] : 0;
    return solution.head(count);
  }

  const CurvatureFit& fit_;
  const CurvatureBounds& bounds_;
  Eigen::VectorXd x_;

  /// Of every entry: 1 if it is held at its greatest, -1 at its least, 0 if it is free.
  std::vector<int> is_held_;
  double multiplier_ = 0;
};

// Cones, and the fit and the bounds of their curvatures.
struct AngleFit {
  const ScaleKernel& kernel;
  const std::vector<int>& cones;
  CurvatureFit fit;
  CurvatureBounds bounds;
};

// Of each cone the number of its triangles.
std::vector<int> triangles_around(const Surface& surface, const std::vector<int>& cones) {
  std::vector<int> at_vertex(surface.vertex_count(), 0), result;
  for (const int v : surface.triangles.reshaped()) ++at_vertex[v];
  result.reserve(cones.size());
  for (const int v : cones) result.push_back(at_vertex[v]);
  return result;
}

// What equal triangles around a cone add to E/2A for each part of the target that they get: (K + 1/K)/2 - 1,
// K the ratio of singular values where an isosceles triangle gets another angle at its tip.
double excess_around(int triangles, double own_angle, double angle) {
  const double ratio = std::tan(own_angle / (2 * triangles)) / std::tan(angle / (2 * triangles));
  return (ratio + 1 / ratio) / 2 - 1;
}

// Angles that spare the triangles around small cones.
class SparedCones {
 public:
  SparedCones(AngleFit at, const FitOptions& options)
      : at_(std::move(at)),
        options_(options),
        triangles_(triangles_around(at_.kernel.surface(), at_.cones)) {}

  // The curvatures of least sigma; or, step by step, those with larger angles at the cones whose triangles
  // bear too much, until there are none. Where sigma would grow too much for that, the last step for which it
  // grows by as much as it may in vain: often the cones only vie with each other.
  Eigen::VectorXd run() {
    Eigen::VectorXd curvatures = least_sigma(at_.fit, at_.bounds), in_vain = curvatures;
    const double sigma = at_.fit.sigma(curvatures);
    const auto grows_by_at_most = [&](double part) {
      return at_.fit.sigma(curvatures) <= (1 + part) * sigma;
    };
    for (Eigen::VectorXd loads = loads_of(curvatures); loads.maxCoeff() > 1; loads = loads_of(curvatures)) {
      if (!enlarge(curvatures, loads)) return in_vain;
      curvatures = least_sigma(at_.fit, at_.bounds);
      if (!grows_by_at_most(options_.sigma_for_shares)) return in_vain;
      if (grows_by_at_most(options_.sigma_in_vain)) in_vain = curvatures;
    }
    return curvatures;
  }

 private:
  // What the triangles around each cone get of the target and add to E/2A, whichever is more, 1 being as much
  // as they may. Nothing where the angle is not smaller than theirs.
  Eigen::VectorXd loads_of(const Eigen::VectorXd& curvatures) const {
    Eigen::VectorXd loads = at_.kernel.target_shares(at_.cones, curvatures);
    for (Eigen::Index i = 0; i < loads.size(); ++i) {
      const double flat = at_.kernel.flat_angle(at_.cones[i]),
                   own = flat - at_.kernel.curvature(at_.cones[i]), angle = flat - curvatures[i],
                   excess = excess_around(triangles_[i], own, angle);
      loads[i] *= angle < own ? std::max(1 / options_.greatest_share, excess / options_.greatest_excess) : 0;
    }
    return loads;
  }

  // Bounds a little above the angles with too much load. False if no angles would be left.
  bool enlarge(const Eigen::VectorXd& curvatures, const Eigen::VectorXd& loads) {
    constexpr double growth = 1.05;
    CurvatureBounds& bounds = at_.bounds;
    for (Eigen::Index i = 0; i < loads.size(); ++i) {
      const double flat = at_.kernel.flat_angle(at_.cones[i]);
      if (loads[i] > 1) bounds.greatest[i] = flat - growth * (flat - curvatures[i]);
    }
    return bounds.can_be_met() && (bounds.greatest - bounds.least).minCoeff() > 0;
  }

  AngleFit at_;
  const FitOptions& options_;
  std::vector<int> triangles_;
};

void require_vertices(const ScaleKernel& kernel, const std::vector<int>& cones) {
  for (const int v : cones) {
    if (v < 0 || v >= kernel.surface().vertex_count() || !(kernel.flat_angle(v) > 0))
      throw MeshError(fmt::format("vertex {} cannot be a cone: no face of the mesh uses it", v));
    if (std::count(cones.begin(), cones.end(), v) > 1)
      throw MeshError(fmt::format("vertex {} is marked twice; mark every cone once", v));
  }
}

}  // namespace

double CurvatureFit::sigma(const Eigen::VectorXd& x) const {
  return std::sqrt(std::max(variance - 2 * pull.dot(x) + x.dot(gram * x), 0.0));
}

bool CurvatureBounds::can_be_met() const { return !sum || (least.sum() <= *sum && *sum <= greatest.sum()); }

Eigen::VectorXd least_sigma(const CurvatureFit& fit, const CurvatureBounds& bounds) {
  ActiveSet state(fit, bounds);
  const int most_steps = 20 * static_cast<int>(fit.pull.size()) + 20;
  for (int step = 0; step < most_steps; ++step)
    if (state.descend() && !state.release()) break;
  return state.x();
}

CurvatureBounds bounds_of(const ScaleKernel& kernel, const std::vector<int>& vertices,
                          const FitOptions& options) {
  const Eigen::Index count = static_cast<Eigen::Index>(vertices.size());
  CurvatureBounds bounds = {Eigen::VectorXd(count), Eigen::VectorXd(count), std::nullopt};
  for (Eigen::Index i = 0; i < count; ++i) {
    const double flat = kernel.flat_angle(vertices[i]);
    bounds.least[i] = flat * (1 - options.greatest());
    bounds.greatest[i] = flat * (1 - options.least_angle);
  }
  if (options.area) bounds.sum = kernel.total_curvature() - *options.area;
  return bounds;
}

void refuse_bounds(const CurvatureBounds& bounds) {
  throw MeshError(
      fmt::format("{} cones have a curvature between {:.4g} pi and {:.4g} pi together, but {:.4g} pi is "
                  "needed; take {} cones, or another area",
                  bounds.least.size(), bounds.least.sum() / pi, bounds.greatest.sum() / pi, *bounds.sum / pi,
                  *bounds.sum > bounds.greatest.sum() ? "more" : "fewer"));
}

FittedAngles fit_angles(const ScaleKernel& kernel, const std::vector<int>& cones, const FitOptions& options) {
  require_vertices(kernel, cones);
  const CurvatureBounds bounds = bounds_of(kernel, cones, options);
  if (!bounds.can_be_met()) refuse_bounds(bounds);
  const CurvatureFit fit = {kernel.potentials(cones)(cones, Eigen::all), kernel.even_potential()(cones),
                            kernel.even_variance()};
  const Eigen::VectorXd curvatures = SparedCones({kernel, cones, fit, bounds}, options).run();
  const double area = options.area.value_or(kernel.total_curvature() - curvatures.sum());
  FittedAngles result = {{}, area, fit.sigma(curvatures)};
  for (std::size_t i = 0; i < cones.size(); ++i)
    result.angles.push_back(kernel.flat_angle(cones[i]) - curvatures[static_cast<Eigen::Index>(i)]);
  return result;
}

}  // namespace orbitutte
