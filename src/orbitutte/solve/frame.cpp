// SPDX-License-Identifier: MIT
#include "orbitutte/solve/frame.h"

#include <Eigen/Geometry>

namespace orbitutte {
namespace {

constexpr double small = 1e-7;  // edges shorter than this have fewer than nine digits
constexpr int sweeps = 200;

}  // namespace

std::optional<Matrix3> resolving_frame(const SphericalEnergy& energy, const Points& positions) {
  const auto [vertex, length] = energy.smallest_spot(positions);
  if (!(length < small)) return std::nullopt;
  return Eigen::Quaterniond::FromTwoVectors(Vector3(positions.row(vertex)), Vector3::UnitX())
      .toRotationMatrix();
}

Points settle_in_frame(const Points& positions, const Matrix3& frame, const SphericalEnergy& energy,
                       const BoundaryConditions& boundary) {
  Points result = (positions * frame.transpose()).rowwise().normalized();
  for (Eigen::Index v = 0; v < result.rows(); ++v) {
    const Basis& room = boundary.basis(static_cast<int>(v));
    if (room.cols() == 0) result.row(v) = boundary.held.row(v);
    if (room.cols() == 2)
      result.row(v) = (room * (room.transpose() * result.row(v).transpose())).normalized();
  }
  energy.relax_small(result, 10 * small, sweeps);
  return result;
}

}  // namespace orbitutte
