// SPDX-License-Identifier: MIT
// J. Nocedal, S. J. Wright, "Numerical Optimization", algorithm 7.4 (two loops); W. W. Hager, H. Zhang, "A
// new conjugate gradient method with guaranteed descent and an efficient line search", SIAM J. Optim. 16
// (2005): the approximate Wolfe test, which sees descent in the slope where the energy's rounding hides it.
#include "orbitutte/solve/lbfgs.h"

#include <cmath>
#include <deque>
#include <utility>

#include "orbitutte/parallel.h"

namespace orbitutte {
namespace {

// Vectors are read once for all their inner products, range by range: they are far larger than any cache.
constexpr Eigen::Index range_rows = 1024;

// Calls visit(r, begin, count) for the numbers of the r-th range of rows, three a row.
template <typename Visit>
void for_ranges(Eigen::Index rows, const Visit& visit) {
  parallel_for(static_cast<int>((rows + range_rows - 1) / range_rows), [&](int r) {
    const Eigen::Index begin = r * range_rows;
    visit(r, 3 * begin, 3 * std::min(range_rows, rows - begin));
  });
}

// The sum of a_i b_i in double precision, as several sums that do not wait for each other.
template <typename A, typename B>
double inner_product(const A* a, const B* b, Eigen::Index count) {
  constexpr int lanes = 8;
  double sums[lanes] = {};
  Eigen::Index i = 0;
  for (; i + lanes <= count; i += lanes)
    for (int j = 0; j < lanes; ++j) sums[j] += static_cast<double>(a[i + j]) * static_cast<double>(b[i + j]);
  for (; i < count; ++i) sums[0] += static_cast<double>(a[i]) * static_cast<double>(b[i]);
  return ((sums[0] + sums[1]) + (sums[2] + sums[3])) + ((sums[4] + sums[5]) + (sums[6] + sums[7]));
}

// So many sums over all rows; visit(begin, length, sums) gives the parts of a range.
template <typename Visit>
std::vector<double> sums_over_ranges(Eigen::Index rows, std::size_t count, const Visit& visit) {
  std::vector<double> partial((static_cast<std::size_t>(rows / range_rows) + 1) * count, 0.0);
  for_ranges(rows, [&](int r, Eigen::Index begin, Eigen::Index length) {
    visit(begin, length, partial.data() + static_cast<std::size_t>(r) * count);
  });
  std::vector<double> result(count, 0.0);
  for (std::size_t at = 0; at < partial.size(); ++at) result[at % count] += partial[at];
  return result;
}

double dot(const Points& a, const Points& b) {
  return sums_over_ranges(a.rows(), 1,
                          [&](Eigen::Index begin, Eigen::Index length, double* sum) {
                            *sum = inner_product(a.data() + begin, b.data() + begin, length);
                          })
      .front();
}

double max_norm(const Points& a) {
  return parallel_max(static_cast<int>(a.rows()), [&](int v) { return a.row(v).cwiseAbs().maxCoeff(); });
}

double max_difference(const Points& a, const Points& b) {
  return parallel_max(static_cast<int>(a.rows()),
                      [&](int v) { return (a.row(v) - b.row(v)).cwiseAbs().maxCoeff(); });
}

// What is remembered of a pair, in single precision: it shapes the direction in which a minimum is looked
// for, not the minimum. This halves the memory of large meshes.
using Remembered = Eigen::Matrix<float, Eigen::Dynamic, 3, Eigen::RowMajor>;

// What changes from one state to the next.
struct Change {
  const Points& from;
  const Points& to;

  void write(Eigen::Index begin, Eigen::Index count, float* difference) const {
    const double *const a = from.data() + begin, *const b = to.data() + begin;
    for (Eigen::Index i = 0; i < count; ++i) difference[i] = static_cast<float>(b[i] - a[i]);
  }
};

// H g of the quasi-Newton matrix whose initial one is P. No multiple of P is a better one: P inverts the
// Hessian but for a term without derivatives, which only few smooth modes feel, so that almost all of its
// spectrum is 1. P g and the P y are given, and P is linear, so that each iteration solves with the Laplacian
// once. The two loops run over inner products (W. Chen, Z. Wang, J. Zhou, "Large-scale L-BFGS using
// MapReduce", NIPS 2014), of which only the newest are computed.
class InverseHessian {
 public:
  explicit InverseHessian(int memory) : memory_(static_cast<std::size_t>(memory)) {}

  // -H g, into memory that is used again; returns its product with g.
  double descend(const Points& gradient, const Points& preconditioned, Points& direction) const {
    const std::size_t count = pairs_.size();
    const std::vector<const float*> vectors = all_vectors();
    const std::vector<double> products = sums_over_ranges(  // s_k' g, and y_k' P g
        gradient.rows(), vectors.size(), [&](Eigen::Index begin, Eigen::Index length, double* sums) {
          for (std::size_t k = 0; k < vectors.size(); ++k)
            sums[k] = inner_product(vectors[k] + begin, gradient.data() + begin, length);
        });
    std::vector<double> alpha(count), along_s(count), coefficients;
    for (std::size_t k = count; k-- > 0;) {  // newest to oldest: alpha_k = s_k' q/s_k' y_k
      double sq = products[k];
      for (std::size_t j = k + 1; j < count; ++j) sq -= alpha[j] * sy_[j][k];
      alpha[k] = sq / sy_[k][k];
    }
    for (std::size_t k = 0; k < count; ++k) {  // oldest to newest: beta_k = y_k' r/s_k' y_k
      double yr = products[count + k];
      for (std::size_t j = 0; j < count; ++j) yr -= alpha[j] * ypy_[std::max(j, k)][std::min(j, k)];
      for (std::size_t j = 0; j < k; ++j) yr += along_s[j] * sy_[k][j];
      along_s[k] = alpha[k] - yr / sy_[k][k];
    }
    for (const double a : along_s) coefficients.push_back(-a);
    for (const double a : alpha) coefficients.push_back(a);
    direction.resize(gradient.rows(), 3);
    return sums_over_ranges(gradient.rows(), 1,
                            [&](Eigen::Index begin, Eigen::Index length, double* sum) {
                              double* const here = direction.data() + begin;
                              for (Eigen::Index i = 0; i < length; ++i)
                                here[i] = -preconditioned.data()[begin + i];
                              for (std::size_t k = 0; k < vectors.size(); ++k) {
                                const float* const vector = vectors[k] + begin;
                                const double factor = coefficients[k];
                                for (Eigen::Index i = 0; i < length; ++i)
                                  here[i] += factor * static_cast<double>(vector[i]);
                              }
                              *sum = inner_product(here, gradient.data() + begin, length);
                            })
        .front();
  }

  // Keeps a step s and the image Py under the preconditioner of the difference y of the gradients, of which
  // only products are needed later; unless their curvature is not positive.
  void update(const Change& s, const Change& y, const Change& Py) {
    const Eigen::Index rows = s.to.rows();
    pairs_.push_back({Remembered(rows, 3), Remembered(rows, 3)});
    const std::size_t count = pairs_.size();
    const std::vector<const float*> vectors = all_vectors();
    const std::vector<double> products = sums_over_ranges(  // s_k' y, and y_k' P y
        rows, vectors.size(), [&](Eigen::Index begin, Eigen::Index length, double* sums) {
          float y_here[3 * range_rows];
          y.write(begin, length, y_here);
          s.write(begin, length, pairs_.back().s.data() + begin);
          Py.write(begin, length, pairs_.back().Py.data() + begin);
          for (std::size_t k = 0; k < vectors.size(); ++k)
            sums[k] = inner_product(vectors[k] + begin, y_here, length);
        });
    const auto middle = products.begin() + static_cast<std::ptrdiff_t>(count);
    if (!(*(middle - 1) > 0) || !(products.back() > 0)) {
      pairs_.pop_back();
      return;
    }
    sy_.emplace_back(products.begin(), middle);
    ypy_.emplace_back(middle, products.end());
    if (pairs_.size() > memory_) drop_oldest();
  }

  void forget() {
    pairs_.clear();
    sy_.clear();
    ypy_.clear();
  }

  bool empty() const { return pairs_.empty(); }

 private:
  struct Pair {
    Remembered s, Py;
  };

  using Table = std::deque<std::deque<double>>;

  // The s, then the Py, oldest first.
  std::vector<const float*> all_vectors() const {
    std::vector<const float*> vectors;
    vectors.reserve(2 * pairs_.size());
    for (const Pair& pair : pairs_) vectors.push_back(pair.s.data());
    for (const Pair& pair : pairs_) vectors.push_back(pair.Py.data());
    return vectors;
  }

  void drop_oldest() {
    pairs_.pop_front();
    for (Table* table : {&sy_, &ypy_}) {
      table->pop_front();
      for (auto& products : *table) products.pop_front();
    }
  }

  std::size_t memory_;
  std::deque<Pair> pairs_;  // oldest first
  Table sy_, ypy_;          // sy_[j][i] = s_i' y_j, and y_i' P y_j, for i <= j
};

// Changes of the energy below this share of it are hidden by rounding: of positions of length one by their
// own, of longer ones, as in the hyperbolic plane, by that of squares of their length.
double energy_rounding_at(const Points& x) {
  const double longest = x.rows() > 0 ? x.col(2).cwiseAbs().maxCoeff() : 1;
  return 1e-14 * std::max(1.0, longest * longest);
}

struct State {
  Points x;
  DirichletEnergy::Value value;
};

class LineSearch {
 public:
  LineSearch(const DirichletEnergy& energy, double energy_rounding, int& evaluations)
      : energy_(energy), energy_rounding_(energy_rounding), evaluations_(evaluations) {}

  // Finds a step along `direction` that satisfies Armijo's condition, or, within the energy's rounding, the
  // approximate Wolfe one, and the state behind it, whose memory is used again. Is there one? slope: the
  // product of the gradient with the direction.
  bool run(const State& from, const Points& direction, double slope, State& to) const {
    if (!(slope < 0)) return false;
    double t = 1;
    for (int trial = 0; trial < 40; ++trial) {
      move_points(energy_.space(), from.x, direction, t, to.x);
      energy_.evaluate(to.x, to.value);
      ++evaluations_;
      if (accept(from, to, direction, t, slope)) return true;
      t = shorter(t, slope, to.value.energy - from.value.energy);
    }
    return false;
  }

 private:
  static constexpr double armijo = 1e-4;

  bool accept(const State& from, const State& to, const Points& direction, double t, double slope) const {
    const double change = to.value.energy - from.value.energy;
    if (!std::isfinite(change) || !std::isfinite(dot(to.value.gradient, to.value.gradient))) return false;
    const bool is_seen = std::abs(change) > energy_rounding_ * from.value.energy;
    if (is_seen) return change <= armijo * t * slope;
    return dot(to.value.gradient, direction) <= (2 * armijo - 1) * slope;
  }

  // The minimum of the parabola through both energies and the slope, kept within a tenth and a half of the
  // step.
  static double shorter(double t, double slope, double change) {
    const double parabola = -slope * t * t / (2 * (change - slope * t));
    return std::isfinite(parabola) ? std::min(std::max(parabola, 0.1 * t), 0.5 * t) : 0.1 * t;
  }

  const DirichletEnergy& energy_;
  double energy_rounding_;
  int& evaluations_;
};

// The rounding floor of the energy (DirichletEnergy::rounding_floor) at positions that are longer than one,
// as in the hyperbolic plane: images of the longest are rounded by their length, and the tangential part of a
// difference at a vertex of length z by z^2 times what the difference is, in three coordinates.
Eigen::VectorXd rounding_floor_at(const DirichletEnergy& energy, const Points& x) {
  if (!(energy.space().curvature() < 0)) return energy.rounding_floor();
  const Eigen::ArrayXd length = x.col(2).array().abs().max(1.0);
  const double longest = x.rows() > 0 ? length.maxCoeff() : 1, coordinates = longest > 1 ? 3 : 1;
  return coordinates * longest * energy.rounding_floor().array() * length.square();
}

bool gradient_vanishes(const Points& gradient, const Eigen::VectorXd& rounding_floor, double tolerance) {
  return parallel_max(static_cast<int>(gradient.rows()), [&](int v) {
           return gradient.row(v).cwiseAbs().maxCoeff() / std::max(rounding_floor[v], tolerance);
         }) <= 1;
}

// Does rounding hide this change of the energy, and are weights so large that some gradients are known less
// exactly than asked? Differences of gradients and steps are nothing but rounding then.
bool is_noise(double change, const State& state, const Eigen::VectorXd& rounding_floor, double tolerance) {
  return rounding_floor.maxCoeff() > tolerance &&
         std::abs(change) <= energy_rounding_at(state.x) * state.value.energy;
}

// Does a step lower the energy by so much that the Hessian is another at its end? What y tells of it is then
// less true than P. The length of a step says less: slow modes are long and change nothing.
bool is_far(double energy_before, double energy_after) {
  constexpr double share = 0.01;
  return energy_before - energy_after > share * energy_before;
}

// Where gradients are known less exactly than asked, steps are worth their time as long as they fall.
bool falls(const std::vector<Iteration>& history, double tolerance) {
  const std::size_t count = history.size();
  return count > 1 && history[count - 1].gradient_norm > tolerance &&
         history[count - 1].gradient_norm < 0.5 * history[count - 2].gradient_norm;
}

void check(const LbfgsOptions& options) {
  if (!(options.tolerance > 0)) throw ArgumentError("the tolerance must be positive");
  if (options.max_iterations < 0) throw ArgumentError("the number of iterations must not be negative");
  if (options.memory < 1) throw ArgumentError("the memory of L-BFGS must be at least one pair");
}

}  // namespace

Minimum minimize(const DirichletEnergy& energy, const Preconditioner& preconditioner, Points start,
                 const LbfgsOptions& options) {
  check(options);
  Minimum result;
  State state = {std::move(start), {}}, next;
  energy.evaluate(state.x, state.value);
  result.evaluations = 1;
  Points preconditioned = preconditioner.precondition(state.value.gradient);
  InverseHessian inverse_hessian(options.memory);
  const LineSearch line_search(energy, energy_rounding_at(state.x), result.evaluations);
  Points direction;
  double last_step = 0;

  const auto record = [&] {
    result.history.push_back({state.value.energy, max_norm(state.value.gradient), last_step});
    if (options.callback && !options.callback(result.iterations, result.history.back())) throw Cancelled();
  };
  record();
  for (;;) {
    const Eigen::VectorXd rounding_floor = rounding_floor_at(energy, state.x);
    const double slope = inverse_hessian.descend(state.value.gradient, preconditioned, direction);
    energy.make_feasible(direction);  // but for the single precision of what is remembered, it is
    const double step_tolerance = std::max(options.tolerance, 1e-12);
    if (gradient_vanishes(state.value.gradient, rounding_floor, options.tolerance) &&
        !falls(result.history, options.tolerance) &&
        (max_norm(direction) <= step_tolerance ||
         is_noise(slope, state, rounding_floor, options.tolerance))) {
      result.termination = Termination::converged;
      break;
    }
    if (result.iterations == options.max_iterations) {
      result.termination = Termination::max_iterations;
      break;
    }
    if (!line_search.run(state, direction, slope, next)) {
      if (inverse_hessian.empty()) {
        result.termination = gradient_vanishes(state.value.gradient, rounding_floor, options.tolerance)
                                 ? Termination::converged
                                 : Termination::line_search_failed;
        break;
      }
      inverse_hessian.forget();  // once more, along the preconditioned gradient alone
      continue;
    }
    direction.resize(0, 3);  // makes room for the solve
    ++result.iterations;
    last_step = max_difference(next.x, state.x);
    Points next_preconditioned = preconditioner.precondition(next.value.gradient);
    const double change = next.value.energy - state.value.energy;
    if (is_noise(change, state, rounding_floor, options.tolerance) ||
        is_far(state.value.energy, next.value.energy))
      inverse_hessian.forget();
    else
      inverse_hessian.update({state.x, next.x}, {state.value.gradient, next.value.gradient},
                             {preconditioned, next_preconditioned});
    preconditioned = std::move(next_preconditioned);
    std::swap(state, next);
    record();
  }
  result.positions = std::move(state.x);
  result.energy = state.value.energy;
  result.gradient_norm = max_norm(state.value.gradient);
  return result;
}

}  // namespace orbitutte
