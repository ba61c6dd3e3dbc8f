// SPDX-License-Identifier: MIT
// The three geometries of constant curvature as one: the sphere, the plane and the hyperbolic plane.
#pragma once

#include <algorithm>
#include <optional>
#include <string>

#include "orbitutte/geometry/isometry.h"

namespace orbitutte {

/// The room in which a point may move: its position is any position that it may have, plus room * unknowns
/// (3 x 0 to 3 x 3, one direction a column).
using Room = Eigen::Matrix<double, 3, Eigen::Dynamic, Eigen::ColMajor, 3, 3>;

/// The points p = (x, y, z) of R^3 with k (x^2 + y^2) + z^2 = 1, k the curvature: the unit sphere for k = 1,
/// the plane z = 1 for k = 0, the hyperboloid (its sheet z > 0) for k = -1. Isometries are linear maps,
/// geodesics lie in planes through the origin, and the sign of det[a b c] is the orientation of the triangle
/// a, b, c, all three times. sn and cs are sin and cos, d and 1, sinh and cosh.
class Space {
 public:
  /// The sphere.
  constexpr Space() = default;

  static constexpr Space sphere() { return Space(1); }
  static constexpr Space plane() { return Space(0); }
  static constexpr Space hyperbolic_plane() { return Space(-1); }

  /// 1, 0 or -1.
  constexpr int curvature() const { return k_; }

  bool operator==(const Space& other) const = default;

  /// "spherical", "euclidean" or "hyperbolic".
  std::string name() const;

  /// The point (0, 0, 1), which lies in all three.
  static Vector3 origin() { return Vector3::UnitZ(); }

  // -- Points and tangent vectors --

  /// The diagonal of J = diag(1, 1, k). J v is the covector of a tangent vector v: u . J v = <u, v>.
  Vector3 metric() const { return {1, 1, static_cast<double>(k_)}; }

  /// k (p_x q_x + p_y q_y) + p_z q_z in numbers of any precision: 1 for p = q in the space, cs d for two
  /// points, and 0 for a point and a vector that is tangent there.
  template <typename Vector>
  typename Vector::Scalar form(const Vector& p, const Vector& q) const {
    return p.z() * q.z() + k_ * (p.x() * q.x() + p.y() * q.y());
  }

  /// <v, v> in numbers of any precision.
  template <typename Vector>
  typename Vector::Scalar squared_norm(const Vector& v) const {
    return v.x() * v.x() + v.y() * v.y() + k_ * (v.z() * v.z());
  }

  /// Positive if the line from the origin of R^3 through p meets the space at p/c with c > 0 rather than
  /// c < 0, near `there`: a line meets the sphere twice, p . there tells where; the other spaces once, p_z
  /// tells.
  template <typename Vector>
  typename Vector::Scalar side(const Vector& p, const Vector& there) const {
    return k_ > 0 ? typename Vector::Scalar(p.dot(there)) : p.z();
  }

  /// <u, v> = u_x v_x + u_y v_y + k u_z v_z: the metric on tangent vectors.
  double dot(const Vector3& u, const Vector3& v) const;

  /// sqrt(<v, v>) of a tangent vector.
  double norm(const Vector3& v) const;

  /// The part of v in the tangent plane at p.
  Vector3 tangent(const Vector3& p, const Vector3& v) const;

  /// The point of the space on the line from the origin of R^3 through p; off z = 0 in the plane, inside the
  /// cone of the hyperboloid.
  Vector3 retract(const Vector3& p) const;

  /// The distance between two points; accurate for neighbours, and on the sphere for antipodes.
  double distance(const Vector3& p, const Vector3& q) const;

  /// Two points nearer to each other than this are joined by one shortest geodesic: pi on the sphere,
  /// otherwise infinite.
  double longest_unique() const;

  /// The point at a distance from p in the direction of the unit tangent vector u: cs(d) p + sn(d) u.
  Vector3 at(const Vector3& p, const Vector3& u, double d) const;

  /// The point at a distance from (0, 0, 1) in the direction of an angle: (sn d cos a, sn d sin a, cs d).
  Vector3 polar(double distance, double angle) const;

  /// The tangent vector u at p turned counterclockwise by a right angle: J (p x u).
  Vector3 turned_left(const Vector3& p, const Vector3& u) const;

  /// The tangent vector v at p, moved along the geodesic to q: v - k <v, q>/(1 + cs d) (p + q).
  Vector3 moved_along(const Vector3& v, const Vector3& p, const Vector3& q) const;

  /// d from sn(d/2); on the sphere pi where that exceeds 1.
  double length_of_half_sn(double half_sn) const;

  /// The point over (x, y): z = sqrt(1 - k (x^2 + y^2)); on the sphere the upper one, on the equator where
  /// (x, y) lies outside.
  Vector3 lift(double x, double y) const;

  /// (x, y) of a point: orthographic on the sphere.
  Eigen::Vector2d flatten(const Vector3& p) const { return p.head<2>(); }

  /// The conformal picture of the space seen from the point opposite to (0, 0, 1), at the scale 1 there:
  /// 2 (x, y)/(1 + z). Stereographic on the sphere, (x, y) in the plane, Poincare's disk of radius 2.
  static Eigen::Vector2d conformal(const Vector3& p) { return 2 / std::max(1 + p.z(), 1e-12) * p.head<2>(); }

  /// Is the area of the space finite, and does it have no end?
  constexpr bool is_closed() const { return k_ > 0; }

  /// Are there maps of the space that change all distances by one factor? Then angles do not say how large a
  /// surface is.
  constexpr bool has_similarities() const { return k_ == 0; }

  /// Is the distance of two points convex along geodesics, so that the energy of maps onto one tile has one
  /// minimum (P. Hartman, "On homotopic harmonic maps", 1967)? It is where the curvature is not positive.
  constexpr bool has_convex_distances() const { return k_ <= 0; }

  /// How far along a line of sight, from a point outside on the side z > 0 in direction of a unit vector, the
  /// space is met first; nothing if it is missed.
  std::optional<double> meeting(const Vector3& from, const Vector3& direction) const;

  /// The unit vector of R^3 that stands upright on the space at p, in pictures: along (k x, k y, z).
  Vector3 upright(const Vector3& p) const { return Vector3(k_ * p.x(), k_ * p.y(), p.z()).normalized(); }

  /// By how much a point is off the space: |sqrt(k (x^2 + y^2) + z^2) - 1|; infinite where that is no number.
  double defect(const Vector3& p) const;

  /// By how much the rounding of doubles may move a point along the space: that of the larger of x and y, or,
  /// on the sphere, of the second largest coordinate, since the rounding of the largest moves the point off
  /// it.
  double tangential_rounding(const Vector3& p) const;

  // -- Triangles --

  /// The signed area of the triangle a, b, c, positive if it is counterclockwise from outside: with the
  /// squared chords c_ij, tan(k area/2) = 2 k det[a b c]/(8 - k (c_ab + c_bc + c_ca)) (Oosterom, Strackee
  /// 1983), half the determinant for k = 0. In (-2 pi, 2 pi) on the sphere.
  double area(const Vector3& a, const Vector3& b, const Vector3& c) const;

  /// The angle at p from the geodesic to q counterclockwise to that to r, in (-pi, pi].
  double angle(const Vector3& p, const Vector3& q, const Vector3& r) const;

  /// The side opposite to the angle a of a triangle with the angles a, b, c, by the law of cosines for
  /// angles: cs = (cos a + cos b cos c)/(sin b sin c). In the plane only the shape is known: sin a, the side
  /// of the triangle whose circumscribed circle has diameter one.
  double side_opposite(double a, double b, double c) const;

  // -- Lines, as covectors: the line m . p = 0 --

  /// The line through p and q, its left where m . x > 0: p x q.
  static Vector3 line(const Vector3& p, const Vector3& q) { return p.cross(q); }

  /// The unit vector that is tangent to the space and normal to the line at all of its points, towards the
  /// left.
  Vector3 normal(const Vector3& line) const;

  // -- Isometries --

  /// The matrix with its inverse as this space has it: J^-1 M^T J with J = diag(1, 1, k); in the plane that
  /// of [R t; 0 1]. `matrix` must be an isometry (isometry_defect).
  Isometry isometry(const Matrix3& matrix) const;

  /// By how much a matrix fails to be an isometry: the largest entry of M^-1 M - 1, with the inverse that an
  /// isometry would have, and of what else the space asks for. Infinite where entries are not finite.
  double isometry_defect(const Matrix3& matrix) const;

  /// The isometry nearest to a matrix that is almost one, up to the square of its defect: M (3 - M^-1 M)/2.
  Isometry nearest_isometry(const Matrix3& matrix) const;

  /// Counterclockwise about a point.
  Isometry rotation(const Vector3& point, double angle) const;

  /// In a line.
  Isometry reflection(const Vector3& line) const;

  /// Takes p to (0, 0, 1) and keeps orientations: the half turn about the point midway.
  Isometry to_origin(const Vector3& p) const;

  // -- Unknowns --

  /// The directions of R^3 in which points of the space differ: all, or those of the plane z = 1.
  Room room() const;

  /// The directions in which points of a mirror differ, an orthonormal basis of those that the reflection
  /// leaves as they are.
  Room room_on(const Isometry& reflection) const;

 private:
  explicit constexpr Space(int curvature) : k_(curvature) {}

  int k_ = 1;
};

/// Calls visit(Curvature<k>()) for the curvature k of the space: loops over many points are compiled for each
/// geometry.
template <typename Visit>
auto visit_curvature(Space space, const Visit& visit);

/// positions + step * directions, retracted to the space (all n x 3), into memory that is used again.
void move_points(Space space, const Points& positions, const Points& directions, double step, Points& moved);

/// Of tangent vectors, one a row, the covectors J v (Space::metric).
void lower_rows(Space space, Points& vectors);

/// Every row retracted.
void retract_points(Space space, Points& positions);

}  // namespace orbitutte

#include "orbitutte/geometry/curvature.h"

namespace orbitutte {

template <typename Visit>
auto visit_curvature(Space space, const Visit& visit) {
  if (space.curvature() > 0) return visit(Curvature<1>());
  if (space.curvature() == 0) return visit(Curvature<0>());
  return visit(Curvature<-1>());
}

}  // namespace orbitutte
