// SPDX-License-Identifier: MIT
#include "orbitutte/solve/trust_region.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

namespace orbitutte {
namespace {

// The step for a given shift of all eigenvalues, in the basis of the eigenvectors.
Eigen::VectorXd shifted_step(const Eigen::VectorXd& gradient, const Eigen::VectorXd& eigenvalues,
                             double shift) {
  Eigen::VectorXd step = -gradient;
  for (Eigen::Index k = 0; k < step.size(); ++k)
    if (step[k] != 0) step[k] /= eigenvalues[k] + shift;
  return step;
}

// The shift at which the step has the length of the radius. Steps become shorter as it grows.
double shift_for(const Eigen::VectorXd& gradient, const Eigen::VectorXd& eigenvalues, double radius) {
  const double least = std::max(0.0, -eigenvalues.minCoeff());
  const auto length = [&](double shift) { return shifted_step(gradient, eigenvalues, shift).norm(); };
  double low = least, high = least + gradient.norm() / radius;
  for (double middle = (low + high) / 2; low < middle && middle < high; middle = (low + high) / 2)
    (length(middle) > radius ? low : high) = middle;
  return high;
}

}  // namespace

Eigen::VectorXd trust_region_step(const QuadraticModel& model, double radius) {
  if (model.gradient.size() == 0 || model.gradient.isZero(0))
    return Eigen::VectorXd::Zero(model.gradient.size());
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(model.hessian);
  const Eigen::VectorXd& eigenvalues = eigen.eigenvalues();
  const Eigen::VectorXd gradient = eigen.eigenvectors().transpose() * model.gradient;
  if (eigenvalues[0] > 0)
    if (const Eigen::VectorXd newton = shifted_step(gradient, eigenvalues, 0); newton.norm() <= radius)
      return eigen.eigenvectors() * newton;
  const double shift = shift_for(gradient, eigenvalues, radius);
  return eigen.eigenvectors() * shifted_step(gradient, eigenvalues, shift);
}

}  // namespace orbitutte
