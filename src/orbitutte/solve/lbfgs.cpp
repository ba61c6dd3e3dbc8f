// SPDX-License-Identifier: MIT
// J. Nocedal, S. J. Wright, "Numerical Optimization", algorithm 7.4 (two loops); W. W. Hager, H. Zhang, "A
// new conjugate gradient method with guaranteed descent and an efficient line search", SIAM J. Optim. 16
// (2005): the approximate Wolfe test, which sees descent in the slope where the energy's rounding hides it.
#include "orbitutte/solve/lbfgs.h"

#include <cmath>
#include <deque>
#include <optional>

namespace orbitutte {
namespace {

double dot(const Points& a, const Points& b) { return a.cwiseProduct(b).sum(); }
double max_norm(const Points& a) { return a.size() ? a.cwiseAbs().maxCoeff() : 0.0; }

struct Pair {
  Points s, y, Py;  // step, difference of gradients, its image under the preconditioner
  double sy;
};

// H g of the quasi-Newton matrix whose initial one is gamma P, gamma = s'y/(y' P y) of the newest pair. P g
// and the P y are given, and P is linear, so that each iteration solves with the Laplacian once.
class InverseHessian {
 public:
  explicit InverseHessian(int memory) : memory_(memory) {}

  Points apply(const Points& gradient, const Points& preconditioned) const {
    Points q = gradient, Pq = preconditioned;
    std::vector<double> alpha(pairs_.size());
    for (std::size_t k = pairs_.size(); k-- > 0;) {  // newest to oldest
      alpha[k] = dot(pairs_[k].s, q) / pairs_[k].sy;
      q -= alpha[k] * pairs_[k].y;
      Pq -= alpha[k] * pairs_[k].Py;
    }
    Points r = gamma_ * Pq;
    for (std::size_t k = 0; k < pairs_.size(); ++k) {  // oldest to newest
      const double beta = dot(pairs_[k].y, r) / pairs_[k].sy;
      r += (alpha[k] - beta) * pairs_[k].s;
    }
    return r;
  }

  // Keeps the pair unless its curvature is not positive.
  void update(Points s, Points y, Points Py) {
    const double sy = dot(s, y), yPy = dot(y, Py);
    if (!(sy > 0) || !(yPy > 0)) return;
    gamma_ = sy / yPy;
    pairs_.push_back({std::move(s), std::move(y), std::move(Py), sy});
    if (static_cast<int>(pairs_.size()) > memory_) pairs_.pop_front();
  }

  void forget() {
    pairs_.clear();
    gamma_ = 1;
  }

  bool empty() const { return pairs_.empty(); }

 private:
  int memory_;
  double gamma_ = 1;
  std::deque<Pair> pairs_;  // oldest first
};

struct State {
  Points x;
  SphericalEnergy::Value value;
};

class LineSearch {
 public:
  LineSearch(const SphericalEnergy& energy, int& evaluations) : energy_(energy), evaluations_(evaluations) {}

  // A step along `direction` that satisfies Armijo's condition, or, within the energy's rounding, the
  // approximate Wolfe one.
  std::optional<State> run(const State& from, const Points& direction) const {
    const double slope = dot(from.value.gradient, direction);
    if (!(slope < 0)) return std::nullopt;
    double t = 1;
    for (int trial = 0; trial < 40; ++trial) {
      const Points x = (from.x + t * direction).rowwise().normalized();
      State to = {x, energy_.evaluate(x)};
      ++evaluations_;
      if (accept(from, to, direction, t, slope)) return to;
      t = shorter(t, slope, to.value.energy - from.value.energy);
    }
    return std::nullopt;
  }

 private:
  static constexpr double armijo = 1e-4;
  static constexpr double energy_rounding = 1e-14;

  static bool accept(const State& from, const State& to, const Points& direction, double t, double slope) {
    const double change = to.value.energy - from.value.energy;
    if (!std::isfinite(change) || !to.value.gradient.allFinite()) return false;
    if (change <= armijo * t * slope && std::abs(change) > energy_rounding * from.value.energy) return true;
    if (std::abs(change) > energy_rounding * from.value.energy) return false;
    return dot(to.value.gradient, direction) <= (2 * armijo - 1) * slope;
  }

  // The minimum of the parabola through both energies and the slope, kept within a tenth and a half of the
  // step.
  static double shorter(double t, double slope, double change) {
    const double parabola = -slope * t * t / (2 * (change - slope * t));
    return std::isfinite(parabola) ? std::min(std::max(parabola, 0.1 * t), 0.5 * t) : 0.1 * t;
  }

  const SphericalEnergy& energy_;
  int& evaluations_;
};

bool gradient_vanishes(const Points& gradient, const Eigen::VectorXd& rounding_floor, double tolerance) {
  const auto norms = gradient.cwiseAbs().rowwise().maxCoeff();
  return (norms.array() <= rounding_floor.array().max(tolerance)).all();
}

void check(const LbfgsOptions& options) {
  if (!(options.tolerance > 0)) throw ArgumentError("the tolerance must be positive");
  if (options.max_iterations < 0) throw ArgumentError("the number of iterations must not be negative");
  if (options.memory < 1) throw ArgumentError("the memory of L-BFGS must be at least one pair");
}

}  // namespace

std::string name(Termination termination) {
  switch (termination) {
    case Termination::converged:
      return "converged";
    case Termination::max_iterations:
      return "max_iterations";
    case Termination::line_search_failed:
      return "line_search_failed";
  }
  return {};
}

Minimum minimize(const SphericalEnergy& energy, const LaplacianSolver& laplacian, const Points& start,
                 const LbfgsOptions& options) {
  check(options);
  Minimum result;
  State state = {start, energy.evaluate(start)};
  result.evaluations = 1;
  Points preconditioned = laplacian.precondition(state.value.gradient);
  InverseHessian inverse_hessian(options.memory);
  const LineSearch line_search(energy, result.evaluations);
  double last_step = 0;

  const auto record = [&] {
    result.history.push_back({state.value.energy, max_norm(state.value.gradient), last_step});
    if (options.callback && !options.callback(result.iterations, result.history.back())) throw Cancelled();
  };
  record();
  for (;;) {
    const Points direction = -inverse_hessian.apply(state.value.gradient, preconditioned);
    const double step_tolerance = std::max(options.tolerance, 1e-12);
    if (gradient_vanishes(state.value.gradient, energy.rounding_floor(), options.tolerance) &&
        max_norm(direction) <= step_tolerance) {
      result.termination = Termination::converged;
      break;
    }
    if (result.iterations == options.max_iterations) {
      result.termination = Termination::max_iterations;
      break;
    }
    std::optional<State> next = line_search.run(state, direction);
    if (!next) {
      if (inverse_hessian.empty()) {
        result.termination =
            gradient_vanishes(state.value.gradient, energy.rounding_floor(), options.tolerance)
                ? Termination::converged
                : Termination::line_search_failed;
        break;
      }
      inverse_hessian.forget();  // once more, along the preconditioned gradient alone
      continue;
    }
    ++result.iterations;
    Points s = next->x - state.x;
    last_step = max_norm(s);
    Points next_preconditioned = laplacian.precondition(next->value.gradient);
    inverse_hessian.update(std::move(s), next->value.gradient - state.value.gradient,
                           next_preconditioned - preconditioned);
    preconditioned = std::move(next_preconditioned);
    state = std::move(*next);
    record();
  }
  result.positions = std::move(state.x);
  result.energy = state.value.energy;
  result.gradient_norm = max_norm(state.value.gradient);
  return result;
}

}  // namespace orbitutte
