// SPDX-License-Identifier: MIT
#include "orbitutte/orbifold/braid.h"

#include <Eigen/Geometry>
#include <complex>
#include <utility>

namespace orbitutte {
namespace {

// The place of the cone that stays where it is, and of the one that is moved by the rotation about it.
struct TwistedPlaces {
  explicit TwistedPlaces(const HalfTwist& twist)
      : centre(twist.place + (twist.is_forth ? 1 : 0)), moved(twist.place + (twist.is_forth ? 0 : 1)) {}

  int centre, moved;
};

// By what the second of them is moved, from the rotation about the first.
template <typename Rotation>
Rotation motion_of(const HalfTwist& twist, const Rotation& rotation) {
  return twist.is_forth ? rotation.inverse() : rotation;
}

Isometry motion_of(const HalfTwist& twist, const Moduli& moduli, const Points& cones) {
  const int centre = TwistedPlaces(twist).centre;
  return motion_of(twist, moduli.space().rotation(cones.row(centre), moduli.marks()[centre].angle));
}

Points after_half_twist(const Moduli& moduli, const Points& cones, const HalfTwist& twist) {
  const auto [centre, moved] = TwistedPlaces(twist);
  const Isometry motion = motion_of(twist, moduli, cones);
  Points result = cones;
  result.row(moved) = cones.row(centre);
  result.row(centre) = moduli.space().retract(motion * Vector3(cones.row(moved))).transpose();
  return result;
}

}  // namespace

Braid inverse(const Braid& braid) {
  Braid result(braid.rbegin(), braid.rend());
  for (HalfTwist& twist : result) twist.is_forth = !twist.is_forth;
  return result;
}

Braid product(const Braid& first, const Braid& second) {
  Braid result = first;
  for (const HalfTwist& twist : second) {
    if (!result.empty() && result.back() == HalfTwist{twist.place, !twist.is_forth})
      result.pop_back();
    else
      result.push_back(twist);
  }
  return result;
}

Braid full_twist(int first, int last, bool is_forth) {
  Braid way;
  for (int place = last - 1; place > first; --place) way.push_back({place, true});
  const Braid back = inverse(way);
  way.push_back({first, is_forth});
  way.push_back({first, is_forth});
  way.insert(way.end(), back.begin(), back.end());
  return way;
}

Points braided(const Moduli& moduli, Points cones, const Braid& braid) {
  for (const HalfTwist& twist : braid) cones = after_half_twist(moduli, cones, twist);
  return cones;
}

std::vector<Isometry> motions(const Moduli& moduli, Points cones, const Braid& braid) {
  std::vector<Isometry> result(cones.rows());
  for (const HalfTwist& twist : braid) {
    const auto [centre, moved] = TwistedPlaces(twist);
    const Isometry motion = motion_of(twist, moduli, cones);
    cones = after_half_twist(moduli, cones, twist);
    std::swap(result[moved], result[centre]);
    result[centre] = motion * result[centre];
  }
  return result;
}

// The rotation about c takes z to c + e^(i angle) (z - c).
Eigen::MatrixXcd braid_matrix(int count, const Braid& braid, double angle) {
  Eigen::MatrixXcd result = Eigen::MatrixXcd::Identity(count, count);
  for (const HalfTwist& twist : braid) {
    const auto [centre, moved] = TwistedPlaces(twist);
    const Eigen::RowVectorXcd of_centre = result.row(centre), of_moved = result.row(moved);
    result.row(moved) = of_centre;
    const std::complex<double> turn = std::polar(1.0, twist.is_forth ? -angle : angle);
    result.row(centre) = of_centre + turn * (of_moved - of_centre);
  }
  return result;
}

VaryingMarks braided(VaryingMarks marks, const Braid& braid) {
  for (const HalfTwist& twist : braid) {
    const auto [centre, moved] = TwistedPlaces(twist);
    marks.carry(moved, centre, motion_of(twist, marks.rotations()[centre]));
  }
  return marks;
}

}  // namespace orbitutte
