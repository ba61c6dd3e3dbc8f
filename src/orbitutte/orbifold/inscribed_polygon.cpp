// SPDX-License-Identifier: MIT
#include "orbitutte/orbifold/inscribed_polygon.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace orbitutte {
namespace {

using std::numbers::pi;

// From the centre, the angle between corner i and where the circle, of radius r, touches a side there is
// phi_i, with sin phi_i = cos beta_i/cs(r) and beta_i half the angle of the corner; the sum of all phi_i is
// pi. All follow from phi of the least corner, which alone may be obtuse:
// sin phi_i = sin phi cos beta_i/cos beta. `excess` is phi + beta - pi/2: positive on the sphere, negative in
// the hyperbolic plane.
class InscribedPolygon {
 public:
  InscribedPolygon(Space space, const std::vector<double>& angles) : space_(space) {
    for (const double angle : angles) beta_.push_back(angle / 2);
    least_ = static_cast<int>(std::min_element(beta_.begin(), beta_.end()) - beta_.begin());
    find_excess();
  }

  // Counterclockwise.
  Points corners() const {
    const std::vector<double> phi = central_angles(excess_);
    Points result(static_cast<Eigen::Index>(beta_.size()), 3);
    double direction = 0;
    for (std::size_t i = 0; i < beta_.size(); ++i) {
      if (i > 0) direction += phi[i - 1] + phi[i];
      // sn(D) = sn(r)/sin(beta), cs(D) = cot(phi) cot(beta)
      const double sn = inscribed_sn() / std::sin(beta_[i]), cs = 1 / (std::tan(phi[i]) * std::tan(beta_[i]));
      const Vector3 corner(sn * std::cos(direction), sn * std::sin(direction), cs);
      result.row(static_cast<Eigen::Index>(i)) =
          space_.curvature() < 0 ? space_.lift(corner.x(), corner.y()) : space_.retract(corner);
    }
    return result;
  }

 private:
  double least_phi(double excess) const { return pi / 2 - beta_[least_] + excess; }

  std::vector<double> central_angles(double excess) const {
    const double scale = std::sin(least_phi(excess)) / std::cos(beta_[least_]);
    std::vector<double> phi;
    for (const double beta : beta_) phi.push_back(std::asin(std::min(scale * std::cos(beta), 1.0)));
    phi[least_] = least_phi(excess);
    return phi;
  }

  // At the excess 0 the angles add up to pi less k area/2. At the other end they fall to 0 in the hyperbolic
  // plane; on the sphere they exceed pi within Troyanov's bound.
  void find_excess() {
    const int k = space_.curvature();
    if (k == 0) return;
    double low = k > 0 ? 0 : beta_[least_] - pi / 2, high = k > 0 ? 2 * beta_[least_] : 0;
    for (double middle = (low + high) / 2; low < middle && middle < high; middle = (low + high) / 2) {
      double sum = 0;
      for (const double phi : central_angles(middle)) sum += phi;
      (sum < pi ? low : high) = middle;
    }
    excess_ = high;
  }

  // sn(r)^2 = k (1 - cs(r)^2) = k sin(excess) cos(phi - beta)/sin(phi)^2; in the plane the size is free.
  double inscribed_sn() const {
    if (space_.curvature() == 0) return 1;
    const double phi = least_phi(excess_);
    return std::sqrt(std::max(space_.curvature() * std::sin(excess_) * std::cos(phi - beta_[least_]), 0.0)) /
           std::sin(phi);
  }

  Space space_;
  std::vector<double> beta_;
  int least_ = 0;
  double excess_ = 0;
};

}  // namespace

Points inscribed_polygon(Space space, const std::vector<double>& angles) {
  return InscribedPolygon(space, angles).corners();
}

}  // namespace orbitutte
