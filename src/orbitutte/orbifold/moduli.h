// SPDX-License-Identifier: MIT
// The shapes that a cone surface with given angles may have: where its marks lie in the space that it is
// developed in. A sphere with k marks has 2k - 6 numbers to choose.
#pragma once

#include <optional>
#include <utility>
#include <vector>

#include "orbitutte/orbifold/varying_marks.h"

namespace orbitutte {

/// Surfaces with marks of given angles: spheres with cones, and disks with corners on their boundary and
/// cones inside. The marks are numbered as the boundary of the cut surface meets them first,
/// counterclockwise, and p_1 .. p_k (k x 3) are their images there. The gluings of the boundary's sides are
/// words in the generators g_1 .. g_k (free_tile.h, edge_words.h):
/// - of a cone, the rotation R_i about p_i by its angle;
/// - of a corner, the reflection in the mirror that begins there. The mirror leads to the next corner p_j,
///   which is seen from here through the cones that are met in between, at R_(i + 1) ... R_(j - 1) p_j.
///
/// A sphere closes if the product of all rotations is the identity:
///     R_1 ... R_k = 1.
/// A disk, which begins at a corner, closes if its mirrors meet in the angles of its corners. A disk without
/// corners begins at any point of its boundary, a corner of pi.
/// Marks move in the tangent planes at p_1 .. p_k, two coordinates each in an orthonormal frame: a step is a
/// vector of 2k numbers.
class Moduli {
 public:
  /// A sphere with cones of these angles. Throws ArgumentError unless the space has such surfaces: three
  /// angles or more, each positive; an area (area()) of at least 1e-9 if the space is curved; and, on the
  /// sphere, angles below 2 pi and within Troyanov's bound (M. Troyanov, "Prescribing curvature on compact
  /// surfaces with conical singularities", 1991): their sum may exceed (2k - 4) pi by less than twice the
  /// least of them.
  Moduli(Space space, const std::vector<double>& angles);

  /// A disk if the first mark is a corner, otherwise a sphere. Of a disk the same is asked as of the sphere
  /// that is two copies of it, glued along their boundaries.
  Moduli(Space space, std::vector<Mark> marks);

  Space space() const { return space_; }
  int mark_count() const { return order_.count(); }
  const std::vector<Mark>& marks() const { return order_.marks(); }
  const MarkOrder& order() const { return order_; }

  /// 2k - 6 for a sphere; for a disk with m corners 2k - m - 3.
  int dimension() const;

  /// By Gauss and Bonnet; 0 in the plane, where it is free.
  double area() const;

  /// g_1 .. g_k.
  std::vector<Isometry> generators(const Points& marks) const;

  /// The marks, moved by steps along some directions (2k x q); positions as `marks` above.
  VaryingMarks varying(const Points& marks, const Eigen::MatrixXd& directions, Order order) const {
    return {space_, order_, marks, directions, order};
  }

  /// The same, moved by any steps, to first order: q = 2k.
  VaryingMarks varying(const Points& marks) const;

  /// What is zero if the surface closes. Of a sphere, the product R_1 ... R_k at first order, as an
  /// infinitesimal isometry, which is zero also if the product is a half turn: three numbers, in the plane
  /// two, since there it is a translation. Of a disk, for each corner, the angle between its mirrors less
  /// its own, modulo pi.
  Eigen::VectorXd closing(const Points& marks) const;

  /// Its derivative by the steps of the marks: a row for each number of closing, 2k columns.
  Eigen::MatrixXd closing_jacobian(const Points& marks) const;

  /// Of marks that close: an orthonormal basis (2k x dimension) of the steps that keep the surface closed,
  /// and that no isometry (in the plane: similarity) makes.
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

  /// Is the signed area of the surface what it has to be, on the sphere up to multiples of its own area, or
  /// of half of it for disks? If it is not, the rotations close, but belong to another kind of surface.
  /// Always in the plane.
  bool encloses_area(const Points& marks) const;

  /// Marks of a closed surface. A sphere is two copies of a polygon with an inscribed circle around (0, 0,
  /// 1), whose corners are the marks, counterclockwise, its angles half of theirs. A disk is such a polygon
  /// itself, with the corners of the disk among its own, and with every cone at a corner whose sides, at
  /// right angles to those beyond, are glued to each other.
  Points inscribed_polygon() const;

 private:
  /// The identity in place of corners.
  std::vector<Isometry> rotations(const Points& marks) const;

  /// Both corners beside a corner, as they are seen from there: the next and the last.
  std::pair<Vector3, Vector3> corners_beside(int corner, const std::vector<Isometry>& rotations,
                                             const Points& marks) const;
  bool closes(const Points& marks) const;

  Space space_;
  MarkOrder order_;
};

}  // namespace orbitutte
