// SPDX-License-Identifier: MIT
// Isometries that depend on parameters, to first or second order.
#pragma once

#include "orbitutte/geometry/space.h"

namespace orbitutte {

/// To which order in the parameters something is known.
enum class Order { first, second };

/// An isometry near the identity, exp(u(t)), that depends on parameters t_1 .. t_q:
///     u(t) = sum of t_a first_a + 1/2 sum of t_a t_b second_ab.
/// u is an infinitesimal isometry: a vector w of R^3 stands for x -> J (w x x) with J = diag(1, 1, k), a
/// rotation about w where that is a point of the space. Isometries g act on such vectors as on points, and
/// turn them around if they reverse orientations: g exp(w) g^-1 = exp(det(g) g w).
struct VaryingMotion {
  Space space;

  /// 3 x q.
  Eigen::Matrix3Xd first;

  /// 3 x q^2: ab in column q a + b, symmetric; 3 x 0 if the motion is known to first order alone.
  Eigen::Matrix3Xd second;

  /// One that does not move.
  static VaryingMotion none(Space space, Eigen::Index parameters, Order order);

  Eigen::Index parameters() const { return first.cols(); }
  bool has_second() const { return second.cols() > 0; }

  /// exp(u) exp(v), by the formula of Baker, Campbell and Hausdorff: u + v + [u, v]/2.
  VaryingMotion operator*(const VaryingMotion& v) const;

  /// exp(-u).
  VaryingMotion inverse() const { return {space, -first, -second}; }

  /// g exp(u) g^-1.
  VaryingMotion seen_through(const Isometry& g) const;

  /// How a point moves: its derivatives in R^3, as columns like those above.
  Eigen::Matrix3Xd velocities(const Vector3& point) const;
  Eigen::Matrix3Xd accelerations(const Vector3& point) const;
};

/// exp(u(t)) g.
struct VaryingIsometry {
  Isometry value;
  VaryingMotion motion;

  VaryingIsometry operator*(const VaryingIsometry& first) const {
    return {value * first.value, motion * first.motion.seen_through(value)};
  }

  VaryingIsometry inverse() const {
    return {value.inverse(), motion.inverse().seen_through(value.inverse())};
  }
};

/// exp(u(t)) p.
struct VaryingPoint {
  Vector3 position;
  VaryingMotion motion;

  /// The point seen through g.
  VaryingPoint seen_through(const VaryingIsometry& g) const {
    return {g.value * position, g.motion * motion.seen_through(g.value)};
  }
};

/// The matrix of x -> J (w x x).
Matrix3 infinitesimal_isometry(Space space, const Vector3& w);

/// Its inverse, of the part of a matrix that is one: w.
Vector3 infinitesimal_part(Space space, const Matrix3& M);

/// The first entries of an infinitesimal isometry, which say all of it if it is a translation in the plane:
/// two there, otherwise three.
int closing_rows(Space space);

/// The commutator of two infinitesimal isometries: J (u x v).
Vector3 commutator(Space space, const Vector3& u, const Vector3& v);

/// Orthonormal tangent vectors at p (3 x 2).
Eigen::Matrix<double, 3, 2> tangent_frame(Space space, const Vector3& p);

/// The infinitesimal isometry that moves p by the tangent vector v and does not turn about p, so that p runs
/// along a geodesic.
Vector3 moving(Space space, const Vector3& p, const Vector3& v);

}  // namespace orbitutte
