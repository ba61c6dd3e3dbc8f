// SPDX-License-Identifier: MIT
// Where the points of a space are drawn.
#pragma once

#include <optional>

#include "orbitutte/geometry/space.h"

namespace orbitutte {

/// The sphere and the plane are drawn as they are. The hyperbolic plane is drawn as Poincaré's disk (its
/// conformal picture, see Space::conformal), of radius 1 in the plane z = 1, with the point `middle` in its
/// middle.
class DrawnSpace {
 public:
  DrawnSpace(Space space, const Vector3& middle);

  /// What a line of sight meets: the sphere or the plane.
  Space surface() const { return is_disk() ? Space::plane() : space_; }

  /// A ball that holds all of the picture.
  struct Ball {
    Vector3 centre;
    double radius;
  };

  /// Nothing for the plane, which is drawn without an end.
  std::optional<Ball> whole() const;

  /// Where a point of the space is drawn, on the surface.
  Vector3 at(const Vector3& p) const;

  /// The point that is drawn at a point of the surface; nothing beyond the disk.
  std::optional<Vector3> point_at(const Vector3& drawn) const;

  /// How long a unit of length is drawn at a point of the space.
  double scale(const Vector3& p) const;

 private:
  bool is_disk() const { return space_.curvature() < 0; }

  Space space_;
  Isometry to_middle_;
};

}  // namespace orbitutte
