// SPDX-License-Identifier: MIT
#include "orbitutte/orbifold/varying_marks.h"

#include <Eigen/Geometry>
#include <utility>

#include "orbitutte/orbifold/precise_generators.h"

namespace orbitutte {
namespace {

// R moves with p, which exp(w) moves: exp(w) R exp(-w).
VaryingIsometry rotation_about(const VaryingPoint& p, const Isometry& rotation) {
  return {rotation, p.motion * p.motion.inverse().seen_through(rotation)};
}

// The bearing of a point q as it is seen from p: its derivatives by the parameters of q. In coordinates X
// along the line from p to q and Y to its left, q lies at X = sn(d) and Y = 0, and the bearing is atan(Y/X).
class Bearing {
 public:
  Bearing(const Vector3& p, const VaryingPoint& q) : q_(q) {
    const Space space = q.motion.space;
    const Vector3 towards = space.tangent(p, q.position - p), left = space.normal(Space::line(p, q.position));
    sn_ = space.norm(towards);
    along_ = rate(space, towards / sn_);
    across_ = rate(space, left);
  }

  Eigen::RowVectorXd first() const { return across_ * q_.motion.velocities(q_.position) / sn_; }

  Eigen::MatrixXd second() const {
    const Eigen::Index count = q_.motion.parameters();
    const Eigen::Matrix3Xd velocity = q_.motion.velocities(q_.position);
    const Eigen::RowVectorXd Y = across_ * velocity, X = along_ * velocity,
                             acceleration = across_ * q_.motion.accelerations(q_.position);
    const Eigen::MatrixXd mixed = X.transpose() * Y;
    return Eigen::Map<const Eigen::MatrixXd>(acceleration.data(), count, count) / sn_ -
           (mixed + mixed.transpose()) / (sn_ * sn_);
  }

 private:
  // <direction, .>.
  static Eigen::RowVector3d rate(Space space, const Vector3& direction) {
    return {direction.x(), direction.y(), space.curvature() * direction.z()};
  }

  const VaryingPoint& q_;
  double sn_;
  Eigen::RowVector3d along_, across_;
};

// The line through two moving points, a and b, is where exp(v) takes it from where it was, v of those
// infinitesimal isometries that turn about its points: v = s a + t b. That exp(-v) exp(u) a lies on it, m . p
// = 0 with m = a x b, says what t is, to first and to second order; b says what s is.
class VaryingLine {
 public:
  VaryingLine(const VaryingPoint& a, const VaryingPoint& b)
      : a_(a), b_(b), line_(Space::line(a.position, b.position)) {
    const Space space = a.motion.space;
    Vector3 raised = line_;
    raised.z() *= space.curvature();
    squared_ = line_.dot(raised);
    motion_ = VaryingMotion::none(space, a.motion.parameters(),
                                  a.motion.has_second() ? Order::second : Order::first);
    motion_.first = turn(offsets(&VaryingMotion::velocities));
    // To second order exp(-v) exp(u) has the second derivatives of exp(u), less those of v: with v known to
    // first order alone, what is left over is what those of v have to take away.
    if (motion_.has_second()) motion_.second = turn(offsets(&VaryingMotion::accelerations));
  }

  const Vector3& line() const { return line_; }
  const VaryingMotion& motion() const { return motion_; }

 private:
  using Derivatives = Eigen::Matrix3Xd (VaryingMotion::*)(const Vector3&) const;
  struct Offsets {
    Eigen::RowVectorXd a, b;
  };

  // By how much exp(-v) exp(u) takes both points off the line, v as it is known so far.
  Offsets offsets(Derivatives derivatives) const {
    const auto off = [&](const VaryingPoint& point) -> Eigen::RowVectorXd {
      const VaryingMotion rest = motion_.inverse() * point.motion;
      return line_.transpose() * (rest.*derivatives)(point.position);
    };
    return {off(a_), off(b_)};
  }

  // m . J (s a x b) = s m . J m, and m . J (t b x a) = -t m . J m.
  Eigen::Matrix3Xd turn(const Offsets& off) const {
    return (a_.position * off.b - b_.position * off.a) / squared_;
  }

  const VaryingPoint &a_, &b_;
  Vector3 line_;
  double squared_;
  VaryingMotion motion_;
};

}  // namespace

VaryingMarks::VaryingMarks(Space space, const MarkOrder& marks, const Points& positions,
                           const Eigen::MatrixXd& directions, Order order)
    : space_(space), marks_(marks), parameters_(directions.cols()), order_(order) {
  for (int i = 0; i < marks.count(); ++i) {
    const Vector3 p = positions.row(i);
    const Eigen::Matrix3Xd steps = tangent_frame(space, p) * directions.middleRows<2>(2 * i);
    VaryingPoint point = {p, VaryingMotion::none(space, parameters_, order)};
    for (Eigen::Index a = 0; a < parameters_; ++a) point.motion.first.col(a) = moving(space, p, steps.col(a));
    rotations_.push_back(
        marks.is_corner(i) ? identity() : rotation_about(point, space.rotation(p, marks.marks()[i].angle)));
    points_.push_back(std::move(point));
  }
}

VaryingPoint VaryingMarks::next_corner(int corner) const {
  const VaryingIsometry between = marks_.product_up_to_corner(corner, rotations_, identity());
  return points_[marks_.corner_after(corner)].seen_through(between);
}

VaryingPoint VaryingMarks::last_corner(int corner) const {
  const int last = marks_.corner_before(corner);
  return points_[last].seen_through(marks_.product_up_to_corner(last, rotations_, identity()).inverse());
}

void VaryingMarks::carry(int moved, int other, const VaryingIsometry& motion) {
  std::swap(points_[moved], points_[other]);
  std::swap(rotations_[moved], rotations_[other]);
  points_[other] = points_[other].seen_through(motion);
  points_[other].position = space_.retract(points_[other].position);
  rotations_[other] = motion * rotations_[other] * motion.inverse();
}

// The reflection r moves as exp(v) r exp(-v), and leaves v as it is, turned around: exp(2 v) r.
VaryingIsometry VaryingMarks::mirror(int corner) const {
  const VaryingPoint next = next_corner(corner);
  const VaryingLine line(points_[corner], next);
  VaryingMotion motion = line.motion();
  motion.first *= 2;
  motion.second *= 2;
  return {space_.reflection(line.line()), motion};
}

std::vector<VaryingIsometry> VaryingMarks::generators() const {
  std::vector<VaryingIsometry> result = rotations_;
  for (const int corner : marks_.corners()) result[corner] = mirror(corner);
  return result;
}

// Of a sphere.
VaryingIsometry VaryingMarks::product_of_rotations() const {
  VaryingIsometry product = identity();
  Matrix3Of<Precise> value = Matrix3Of<Precise>::Identity();
  for (int i = 0; i < marks_.count(); ++i) {
    product.motion = product.motion * rotations_[i].motion.seen_through(product.value);
    value = (value * precise_rotation_about(space_, marks_.marks()[i], points_[i].position)).eval();
    product.value = rounded_isometry(space_, value);
  }
  return product;
}

// The angle at a corner p changes as if p stayed where it is and its own motion were taken off both others.
template <typename Visit>
void VaryingMarks::for_bearings(const Visit& visit) const {
  const std::vector<int> corners = marks_.corners();
  for (std::size_t row = 0; row < corners.size(); ++row) {
    const VaryingPoint& p = points_[corners[row]];
    VaryingPoint next = next_corner(corners[row]), last = last_corner(corners[row]);
    next.motion = p.motion.inverse() * next.motion;
    last.motion = p.motion.inverse() * last.motion;
    visit(static_cast<Eigen::Index>(row), Bearing(p.position, next), Bearing(p.position, last));
  }
}

Eigen::MatrixXd VaryingMarks::angle_rates() const {
  Eigen::MatrixXd result(static_cast<Eigen::Index>(marks_.corners().size()), parameters_);
  for_bearings([&](Eigen::Index row, const Bearing& next, const Bearing& last) {
    result.row(row) = last.first() - next.first();
  });
  return result;
}

Eigen::MatrixXd VaryingMarks::closing_rates() const {
  if (marks_.is_disk()) return angle_rates();
  const VaryingIsometry whole = product_of_rotations();
  Eigen::MatrixXd result(closing_rows(space_), parameters_);
  for (Eigen::Index q = 0; q < parameters_; ++q) {
    const Matrix3 change = infinitesimal_isometry(space_, whole.motion.first.col(q)) * whole.value.matrix();
    result.col(q) = infinitesimal_part(space_, change).head(closing_rows(space_));
  }
  return result;
}

Eigen::MatrixXd VaryingMarks::closing_curvature(const Eigen::VectorXd& multipliers) const {
  Eigen::MatrixXd result = Eigen::MatrixXd::Zero(parameters_, parameters_);
  if (marks_.is_disk()) {
    for_bearings([&](Eigen::Index row, const Bearing& next, const Bearing& last) {
      result += multipliers[row] * (last.second() - next.second());
    });
    return result;
  }
  // The square of an infinitesimal isometry has no part that is one.
  const Eigen::RowVectorXd sum =
      multipliers.transpose() * product_of_rotations().motion.second.topRows(multipliers.size());
  return Eigen::Map<const Eigen::MatrixXd>(sum.data(), parameters_, parameters_);
}

}  // namespace orbitutte
