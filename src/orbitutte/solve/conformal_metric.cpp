// SPDX-License-Identifier: MIT
#include "orbitutte/solve/conformal_metric.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <utility>
#include <vector>

#include "orbitutte/linear/laplacian_matrix.h"
#include "orbitutte/mesh/intrinsic_triangulation.h"
#include "orbitutte/parallel.h"

namespace orbitutte {
namespace {

using std::numbers::pi;

// What remains of a triangle whose longest side is too long for the other two.
TriangleAngles flat_triangle(const std::array<double, 3>& half_sn) {
  TriangleAngles result;
  const auto longest = std::max_element(half_sn.begin(), half_sn.end()) - half_sn.begin();
  result.angle[(longest + 2) % 3] = pi;
  result.is_flat = true;
  return result;
}

// tan(x + y - z) of tan x, tan y and tan z.
double tan_of_sum(double x, double y, double minus_z) {
  return (x + y - minus_z + x * y * minus_z) / (1 - x * y + (x + y) * minus_z);
}

}  // namespace

// From sn of the half sides: with x, y, z the half sides, the angle a opposite to x has
// tan^2(a/2) = sn(x + y - z) sn(x - y + z)/(sn(x + y + z) sn(-x + y + z)).
TriangleAngles triangle_angles(int k, const std::array<double, 3>& half_sn) {
  std::array<double, 3> cs, rest, half_tan;
  for (int i = 0; i < 3; ++i) cs[i] = std::sqrt(std::max(1 - k * half_sn[i] * half_sn[i], 0.0));
  double perimeter = 0;
  for (int i = 0; i < 3; ++i) {
    const int j = (i + 1) % 3, o = (i + 2) % 3;
    const double sn = half_sn[j] * cs[o] + cs[j] * half_sn[o],
                 cs_of_sum = cs[j] * cs[o] - k * half_sn[j] * half_sn[o];
    rest[i] = sn * cs[i] - cs_of_sum * half_sn[i];
    if (i == 0) perimeter = sn * cs[i] + cs_of_sum * half_sn[i];
  }
  if (!(rest[0] > 0 && rest[1] > 0 && rest[2] > 0 && perimeter > 0)) return flat_triangle(half_sn);
  const double radius = std::sqrt(rest[0] * rest[1] * rest[2] / perimeter);
  TriangleAngles result;
  for (int i = 0; i < 3; ++i) {
    half_tan[i] = radius / rest[(i + 1) % 3];
    result.angle[i] = 2 * std::atan(half_tan[i]);
  }
  for (int i = 0; i < 3; ++i)
    result.coupling[i] = 0.5 * tan_of_sum(half_tan[i], half_tan[(i + 1) % 3], half_tan[(i + 2) % 3]);
  return result;
}

namespace {

// What the angles around each vertex add up to where nothing is marked; zero if no triangle uses it.
Eigen::VectorXd ordinary_angles(const Surface& surface) {
  Eigen::VectorXd angles = Eigen::VectorXd::Zero(surface.vertex_count());
  for (const int v : surface.triangles.reshaped()) angles[v] = 2 * pi;
  const std::vector<char> on_boundary = surface.boundary_vertices();
  for (Eigen::Index v = 0; v < angles.size(); ++v)
    if (on_boundary[v]) angles[v] = pi;
  return angles;
}

// One unknown for each vertex that a triangle uses.
std::vector<int> scale_counts(const Surface& surface) {
  std::vector<int> count(surface.vertex_count(), 0);
  for (const int v : surface.triangles.reshaped()) count[v] = 1;
  return count;
}

// Vertices a and b at the ends of a side, and its half-edges; on the boundary `other` is -1.
struct TriangleSide {
  int a, b, half_edge, other;
};

std::vector<TriangleSide> sides_of(const Surface& surface) {
  std::vector<TriangleSide> sides;
  sides.reserve(surface.triangles.size() / 2 + 1);
  for (int h = 0; h < static_cast<int>(surface.triangles.size()); ++h)
    if (const int other = surface.connectivity.opposite[h]; other < h)
      sides.push_back(
          {halfedge_origin(surface.triangles, h), halfedge_target(surface.triangles, h), h, other});
  return sides;
}

// The search for the scales.
class ConformalScale {
 public:
  explicit ConformalScale(const ConformalProblem& problem)
      : surface_(problem.surface),
        space_(problem.space),
        k_(space_.curvature()),
        wanted_(problem.angles),
        ordinary_(ordinary_angles(problem.surface)),
        angles_(problem.angles),
        area_(k_ * (problem.angles.sum() - pi * problem.surface.triangle_count())),
        sides_(sides_of(surface_)),
        length_(surface_.triangle_count(), 3),
        unknowns_(number_unknowns(problem.dissection.order, scale_counts(surface_))),
        preconditioner_(eliminate_laplacian(preconditioning_matrix(problem), unknowns_, problem.backend)) {
    for (Eigen::Index f = 0; f < length_.rows(); ++f)
      for (int i = 0; i < 3; ++i)
        length_(f, i) =
            (surface_.V.row(surface_.triangles(f, i)) - surface_.V.row(surface_.triangles(f, (i + 1) % 3)))
                .norm();
  }

  // On the sphere, where Newton's method may lead elsewhere from far away, by way of smaller areas.
  ConformalMetric solve() {
    constexpr double loose = 1, tight = 1e-4;
    State state;
    state.u = Eigen::VectorXd::Constant(surface_.vertex_count(), 0.5 * std::log(1 / surface_.total_area()));
    double area = 1;
    const std::vector<double> last = {1}, with_a_smaller = {0.3, 1};
    for (const double share : space_.has_convex_distances() ? last : with_a_smaller) {
      const double next = share * area_;
      angles_ = angles_with_area(next);
      const double growth = 0.5 * std::log(next / area), limit = -std::log(length_.maxCoeff());
      state = at(state.u.array() + std::min(growth, limit - state.u.maxCoeff()));
      descend(share < 1 ? loose : tight, state);
      area = next;
    }
    return metric_of(state);
  }

 private:
  // Scales, and the triangles that they make.
  struct State {
    Eigen::VectorXd u;

    // T x 3: sn of half of each side, the angles, and what couples the ends of each side.
    Points half_sn, angles, coupling;
    std::vector<char> is_flat;

    // n: by how much the angles around each vertex exceed what they are to be.
    Eigen::VectorXd excess;

    double defect() const { return excess.cwiseAbs().sum(); }
  };

  // What the angles are to be if all deficits are scaled so that the area is another one.
  Eigen::VectorXd angles_with_area(double area) const {
    const double deficits = (ordinary_ - wanted_).sum();
    return ordinary_ - (deficits + k_ * (area_ - area)) / deficits * (ordinary_ - wanted_);
  }

  void descend(double tolerance, State& state) const {
    constexpr int most_steps = 40;
    for (int step = 0; step < most_steps && state.defect() > tolerance; ++step) {
      std::optional<State> next = advanced(state, newton_direction(state));
      if (!next) return;
      state = std::move(*next);
    }
  }

  // The Laplacian, and on its diagonal what the curvature adds for the constants, made positive.
  SparseMatrix preconditioning_matrix(const ConformalProblem& problem) const {
    const IntrinsicTriangulation* triangulation = problem.weights.triangulation.get();
    const Connectivity& connectivity = triangulation ? triangulation->connectivity : surface_.connectivity;
    SparseMatrix A = assemble(unknowns_, vertex_neighbors(connectivity.edges, surface_.vertex_count()),
                              problem.weights.w, [](int, int) -> Block { return Block::Ones(1, 1); });
    const Eigen::VectorXd areas = surface_.vertex_areas(), share = areas / areas.sum();
    for (const int v : unknowns_.order)
      A.valuePtr()[A.outerIndexPtr()[unknowns_.first[v]]] += 2 * area_ * share[v];
    return A;
  }

  State at(Eigen::VectorXd u) const {
    const Triangles& F = surface_.triangles;
    State state;
    state.half_sn.resize(F.rows(), 3);
    state.angles.resize(F.rows(), 3);
    state.coupling.resize(F.rows(), 3);
    state.is_flat.resize(F.rows());
    const Eigen::VectorXd factor = (0.5 * u).array().exp();
    parallel_ranges(static_cast<int>(F.rows()), [&](int begin, int end) {
      for (int f = begin; f < end; ++f) {
        std::array<double, 3> half_sn;
        for (int i = 0; i < 3; ++i)
          half_sn[i] = 0.5 * length_(f, i) * factor[F(f, i)] * factor[F(f, (i + 1) % 3)];
        const TriangleAngles triangle = triangle_angles(k_, half_sn);
        for (int i = 0; i < 3; ++i) {
          state.half_sn(f, i) = half_sn[i];
          state.angles(f, i) = triangle.angle[i];
          state.coupling(f, i) = triangle.coupling[i];
        }
        state.is_flat[f] = triangle.is_flat ? 1 : 0;
      }
    });
    state.u = std::move(u);
    state.excess = -angles_;
    for (Eigen::Index f = 0; f < F.rows(); ++f)
      for (int i = 0; i < 3; ++i) state.excess[F(f, i)] += state.angles(f, i);
    return state;
  }

  // In a closed space no chord is longer than 2.
  bool fits(const State& state) const { return !space_.is_closed() || state.half_sn.maxCoeff() < 1; }

  // Of each side, the factors of (v_a - v_b)^2 and of (v_a + v_b)^2.
  struct CurvedLaplacian {
    Eigen::VectorXd difference, sum;
  };

  CurvedLaplacian curved_laplacian(const State& state) const {
    const auto count = static_cast<Eigen::Index>(sides_.size());
    CurvedLaplacian H = {Eigen::VectorXd(count), Eigen::VectorXd(count)};
    for (Eigen::Index s = 0; s < count; ++s) {
      const auto& [a, b, h, other] = sides_[s];
      const double w = state.coupling.data()[h] + (other < 0 ? 0 : state.coupling.data()[other]),
                   squared = k_ * state.half_sn.data()[h] * state.half_sn.data()[h];
      H.difference[s] = w;
      H.sum[s] = -w * squared / (1 - squared);
    }
    return H;
  }

  // The derivative of the excess along -v.
  Eigen::VectorXd product(const CurvedLaplacian& H, const Eigen::VectorXd& v) const {
    Eigen::VectorXd result = Eigen::VectorXd::Zero(v.size());
    for (std::size_t s = 0; s < sides_.size(); ++s) {
      const int a = sides_[s].a, b = sides_[s].b;
      const auto at = static_cast<Eigen::Index>(s);
      const double difference = H.difference[at] * (v[a] - v[b]), sum = H.sum[at] * (v[a] + v[b]);
      result[a] += sum + difference;
      result[b] += sum - difference;
    }
    return result;
  }

  Eigen::VectorXd preconditioned(const Eigen::VectorXd& r) const {
    SingleVector y(unknowns_.total);
    for (const int v : unknowns_.order) y[unknowns_.first[v]] = static_cast<float>(r[v]);
    preconditioner_.forward<1>(y);
    preconditioner_.backward<1>(y);
    Eigen::VectorXd result = Eigen::VectorXd::Zero(r.size());
    for (const int v : unknowns_.order) result[v] = static_cast<double>(y[unknowns_.first[v]]);
    return result;
  }

  // H v = excess, with H the curved Laplacian. A constant takes what H, which may be negative for it alone,
  // asks of it; the rest of v is found among the vectors v with 1 . H v = 0.
  Eigen::VectorXd newton_direction(const State& state) const {
    const CurvedLaplacian H = curved_laplacian(state);
    const Eigen::VectorXd ones = Eigen::VectorXd::Ones(state.u.size()), h = product(H, ones);
    const double constant = state.excess.sum() / h.sum();
    return solved_apart_from_constants(H, state.excess - constant * h, h) + constant * ones;
  }

  // Conjugate gradients, up to some digits, or to where H turns out not to be positive.
  Eigen::VectorXd solved_apart_from_constants(const CurvedLaplacian& H, Eigen::VectorXd residual,
                                              const Eigen::VectorXd& h) const {
    constexpr int most_steps = 50;
    constexpr double tolerance = 0.1;
    const auto projected = [&](const Eigen::VectorXd& r) {
      const Eigen::VectorXd z = preconditioned(r);
      return Eigen::VectorXd(z.array() - h.dot(z) / h.sum());
    };
    Eigen::VectorXd v = Eigen::VectorXd::Zero(residual.size()), z = projected(residual), direction = z;
    double size = residual.dot(z);
    const double enough = tolerance * tolerance * size;
    for (int step = 0; step < most_steps && size > enough; ++step) {
      const Eigen::VectorXd image = product(H, direction);
      const double curvature = direction.dot(image);
      if (!(curvature > 0)) return step == 0 ? direction : v;
      v += size / curvature * direction;
      residual -= size / curvature * image;
      z = projected(residual);
      const double before = std::exchange(size, residual.dot(z));
      direction = z + size / before * direction;
    }
    return v;
  }

  // The first of ever shorter steps that makes the excess smaller.
  std::optional<State> advanced(const State& from, const Eigen::VectorXd& direction) const {
    constexpr int most_trials = 12;
    const double before = from.excess.norm();
    double t = 1;
    for (int trial = 0; trial < most_trials; ++trial, t /= 2) {
      State next = at(from.u + t * direction);
      if (fits(next) && next.excess.norm() < (1 - 0.1 * t) * before) return next;
    }
    return std::nullopt;
  }

  ConformalMetric metric_of(const State& state) const {
    ConformalMetric metric;
    metric.lengths = state.half_sn.unaryExpr([this](double sn) { return space_.length_of_half_sn(sn); });
    metric.angles = state.angles;
    metric.is_flat = state.is_flat;
    metric.defect = state.defect();
    return metric;
  }

  const Surface& surface_;
  Space space_;
  int k_;
  const Eigen::VectorXd& wanted_;
  Eigen::VectorXd ordinary_;

  // Those that are searched for at present.
  Eigen::VectorXd angles_;
  double area_;

  std::vector<TriangleSide> sides_;

  // T x 3: of the half-edges, in space.
  Points length_;
  Unknowns unknowns_;
  LeadingFactor preconditioner_;
};

}  // namespace

ConformalMetric conformal_metric(const ConformalProblem& problem) { return ConformalScale(problem).solve(); }

}  // namespace orbitutte
