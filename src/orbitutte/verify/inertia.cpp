// SPDX-License-Identifier: MIT
#include "orbitutte/verify/inertia.h"

#include <Eigen/SparseCholesky>
#include <cmath>

#include "orbitutte/verify/mumps_inertia.h"

namespace orbitutte {
namespace {

constexpr double residual_bound = 1e-6;

#ifdef ORBITUTTE_HAS_MUMPS
constexpr const char* breakdown = "Eigen's LDL', which does not pivot, broke down; choose MUMPS";
#else
constexpr const char* breakdown =
    "Eigen's LDL', which does not pivot, broke down; install MUMPS (libmumps-seq-dev) and build again";
#endif

class EigenCounter : public InertiaCounter {
 public:
  EigenCounter(const SymmetricMatrix& lower, Eigen::VectorXd scale)
      : lower_(lower), scale_(std::move(scale)) {
    factor_.analyzePattern(lower_);
  }

  long eigenvalues_below(double shift) override {
    SymmetricMatrix shifted = lower_;
    shifted.diagonal() -= shift * scale_;
    factor_.factorize(shifted);
    if (factor_.info() != Eigen::Success || !trustworthy(shifted)) throw InertiaNotFound(breakdown);
    return (factor_.vectorD().array() < 0).count();
  }

 private:
  /// Solves a system with a known solution: pivots that are too small make L grow, and then the residual is
  /// large.
  bool trustworthy(const SymmetricMatrix& shifted) const {
    const Eigen::VectorXd x = Eigen::VectorXd::LinSpaced(shifted.rows(), 1, 2);
    const Eigen::VectorXd b = shifted.selfadjointView<Eigen::Lower>() * x;
    const Eigen::VectorXd solution = factor_.solve(b);
    const Eigen::VectorXd residual = b - shifted.selfadjointView<Eigen::Lower>() * solution;
    return residual.norm() <= residual_bound * b.norm();  // false for NaN, too
  }

  SymmetricMatrix lower_;
  Eigen::VectorXd scale_;
  Eigen::SimplicialLDLT<SymmetricMatrix, Eigen::Lower> factor_;
};

}  // namespace

std::vector<InertiaMethod> available_inertia_methods() {
#ifdef ORBITUTTE_HAS_MUMPS
  return {InertiaMethod::mumps, InertiaMethod::eigen};
#else
  return {InertiaMethod::eigen};
#endif
}

std::unique_ptr<InertiaCounter> inertia_counter(const SymmetricMatrix& lower, const Eigen::VectorXd& scale,
                                                InertiaMethod method) {
  if (method == InertiaMethod::eigen) return std::make_unique<EigenCounter>(lower, scale);
#ifdef ORBITUTTE_HAS_MUMPS
  return mumps_inertia_counter(lower, scale);
#else
  throw ArgumentError("this binary was built without MUMPS (libmumps-seq-dev)");
#endif
}

}  // namespace orbitutte
