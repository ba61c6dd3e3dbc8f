// SPDX-License-Identifier: MIT
#include "orbitutte/orbifold/precise_generators.h"

#include "orbitutte/geometry/precise_isometry.h"
#include "orbitutte/orbifold/seam_group.h"

namespace orbitutte {
namespace {

Vector3Of<Precise> point_with_digits(Space space, const Vector3& position) {
  return precise_retract<Precise>(space, position.cast<Precise>());
}

}  // namespace

// A half turn is 2 p n^T - 1, with n = (k x, k y, z).
Matrix3Of<Precise> precise_rotation_about(Space space, const Mark& mark, const Vector3& position) {
  if (mark.kind == ConeKind::corner) return Matrix3Of<Precise>::Identity();
  const Vector3Of<Precise> p = point_with_digits(space, position);
  if (mark.order() != 2 || space.curvature() == 0)
    return precise_rotation<Precise>(space, p, precise_angle<Precise>(mark));
  const Vector3Of<Precise> n(space.curvature() * p.x(), space.curvature() * p.y(), p.z());
  return Precise(2) * (p * n.transpose()) - Matrix3Of<Precise>::Identity();
}

std::vector<Matrix3Of<Precise>> precise_rotations(Space space, const MarkOrder& marks,
                                                  const Points& positions) {
  std::vector<Matrix3Of<Precise>> result;
  result.reserve(marks.count());
  for (int i = 0; i < marks.count(); ++i)
    result.push_back(precise_rotation_about(space, marks.marks()[i], positions.row(i)));
  return result;
}

std::vector<Matrix3Of<Precise>> precise_generators(Space space, const MarkOrder& marks,
                                                   const Points& positions) {
  const std::vector<Matrix3Of<Precise>> about = precise_rotations(space, marks, positions);
  std::vector<Matrix3Of<Precise>> result = about;
  const Matrix3Of<Precise> identity = Matrix3Of<Precise>::Identity();
  for (const int corner : marks.corners()) {
    const Matrix3Of<Precise> between = marks.product_up_to_corner(corner, about, identity);
    const Vector3Of<Precise> here = point_with_digits(space, positions.row(corner)),
                             next = between *
                                    point_with_digits(space, positions.row(marks.corner_after(corner)));
    result[corner] = precise_reflection<Precise>(space, here.cross(next));
  }
  return result;
}

Matrix3Of<Precise> precise_product(const std::vector<Matrix3Of<Precise>>& factors) {
  Matrix3Of<Precise> result = Matrix3Of<Precise>::Identity();
  for (const Matrix3Of<Precise>& factor : factors) result = (result * factor).eval();
  return result;
}

Isometry rounded_isometry(Space space, const Matrix3Of<Precise>& precise) {
  const Matrix3Of<Precise> inverse = precise_inverse(space, precise);
  return {precise.cast<double>(), inverse.cast<double>()};
}

}  // namespace orbitutte
