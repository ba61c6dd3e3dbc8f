// SPDX-License-Identifier: MIT
// The shapes that a cone surface with given angles may have: where its marks lie in the space that it is
// developed in. With k marks they are 2k - 6 numbers.
#pragma once

#include <optional>
#include <vector>

#include "orbitutte/geometry/space.h"

namespace orbitutte {

/// An isometry g that depends on parameters m_1 .. m_q. An infinitesimal isometry is a vector w of R^3, which
/// stands for x -> J (w x x) with J = diag(1, 1, k): a rotation about w where that is a point of the space.
/// Isometries g that keep orientations act on such vectors as on points: g exp(w) g^-1 = exp(g w).
struct VaryingIsometry {
  Isometry value;

  /// 3 x q: dg/dm_j g^-1.
  Eigen::Matrix3Xd rate;

  VaryingIsometry operator*(const VaryingIsometry& first) const {
    return {value * first.value, rate + value.matrix() * first.rate};
  }

  VaryingIsometry inverse() const { return {value.inverse(), -value.inverse_matrix() * rate}; }
};

/// The matrix of x -> J (w x x).
Matrix3 infinitesimal_isometry(Space space, const Vector3& w);

/// Cone surfaces of the sphere's topology with marks of given angles. The marks are numbered as the boundary
/// of the cut surface meets them first, counterclockwise, and p_1 .. p_k (k x 3) are their images there. With
/// the rotations R_i about p_i by the angle of mark i, the gluing of the boundary's sides are products R_a
/// ... R_b of the rotations in between (free_tile.h), and the surface closes:
///     R_1 ... R_k = 1.
/// Marks move in the tangent planes at p_1 .. p_k, two coordinates each in an orthonormal frame: a step is a
/// vector of 2k numbers.
class Moduli {
 public:
  /// Throws ArgumentError unless the space has such surfaces: three angles or more, each above 0 and below 2
  /// pi; an area (cone_area) of at least 1e-9 if the space is curved; and, on the sphere, angles within M.
  /// Troyanov's bound ("Prescribing curvature on compact surfaces with conical singularities", 1991): their
  /// sum may exceed (2k - 4) pi by less than twice the least of them.
  Moduli(Space space, std::vector<double> angles);

  Space space() const { return space_; }
  int mark_count() const { return static_cast<int>(angles_.size()); }
  const std::vector<double>& angles() const { return angles_; }

  /// 2k - 6.
  int dimension() const { return 2 * mark_count() - 6; }

  /// By Gauss and Bonnet; 0 in the plane, where it is free.
  double area() const;

  /// R_1 .. R_k.
  std::vector<Isometry> rotations(const Points& marks) const;

  /// The same, depending on the steps of the marks: q = 2k.
  std::vector<VaryingIsometry> varying_rotations(const Points& marks) const;

  /// The product R_1 ... R_k at first order, as an infinitesimal isometry: zero if the surface closes, or if
  /// the product is a half turn. In the plane two numbers, since the product is a translation.
  Eigen::VectorXd closing(const Points& marks) const;

  /// Its derivative by the steps of the marks: 3 x 2k, in the plane 2 x 2k.
  Eigen::MatrixXd closing_jacobian(const Points& marks) const;

  /// Of marks that close: an orthonormal basis (2k x (2k - 6)) of the steps that keep the surface closed, and
  /// that no isometry (in the plane: similarity) makes.
  Eigen::MatrixXd basis(const Points& marks) const;

  /// The step as tangent vectors of R^3 at the marks: k x 3.
  Points tangents(const Points& marks, const Eigen::VectorXd& step) const;

  /// The coordinates (2k) of tangent vectors at the marks (k x 3).
  Eigen::VectorXd coordinates(const Points& marks, const Points& tangents) const;

  /// The marks moved as little as possible so that the surface closes (Newton's method, each step of least
  /// norm); nothing if it does not converge, or leads to a surface of another area (encloses_area).
  std::optional<Points> closed(const Points& marks) const;

  /// closed() of the marks moved by a step along geodesics.
  std::optional<Points> retract(const Points& marks, const Eigen::VectorXd& step) const;

  /// Is the signed area of the surface what it has to be, on the sphere up to multiples of its own area? If
  /// it is not, the rotations close, but belong to another kind of surface. Always in the plane.
  bool encloses_area(const Points& marks) const;

  /// A polygon with an inscribed circle around (0, 0, 1), doubled: its corners are the marks,
  /// counterclockwise, its angles half of theirs.
  Points doubled_polygon() const;

 private:
  /// Orthonormal tangent vectors at p (3 x 2).
  Eigen::Matrix<double, 3, 2> frame(const Vector3& p) const;

  Space space_;
  std::vector<double> angles_;
};

/// k (4 pi - sum of (2 pi - angle)): by Gauss and Bonnet the area of a sphere of the space's curvature k with
/// cones of these angles, negative if it has none, and zero in the plane.
double cone_area(Space space, const std::vector<double>& angles);

}  // namespace orbitutte
