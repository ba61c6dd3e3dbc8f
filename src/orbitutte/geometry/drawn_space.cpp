// SPDX-License-Identifier: MIT
#include "orbitutte/geometry/drawn_space.h"

namespace orbitutte {

DrawnSpace::DrawnSpace(Space space, const Vector3& middle) : space_(space) {
  if (is_disk()) to_middle_ = space.to_origin(middle);
}

std::optional<DrawnSpace::Ball> DrawnSpace::whole() const {
  if (is_disk()) return Ball{Space::origin(), 1};
  if (space_.is_closed()) return Ball{Vector3::Zero(), 1};
  return std::nullopt;
}

Vector3 DrawnSpace::at(const Vector3& p) const {
  if (!is_disk()) return p;
  const Eigen::Vector2d in_disk = 0.5 * Space::conformal(to_middle_ * p);
  return {in_disk.x(), in_disk.y(), 1};
}

std::optional<Vector3> DrawnSpace::point_at(const Vector3& drawn) const {
  if (!is_disk()) return drawn;
  const double x = drawn.x(), y = drawn.y(), room = 1 - x * x - y * y;
  if (!(room > 0)) return std::nullopt;
  return to_middle_.inverse() * Vector3(2 * x / room, 2 * y / room, (2 - room) / room);
}

double DrawnSpace::scale(const Vector3& p) const {
  return is_disk() ? 0.5 * (1 - at(p).head<2>().squaredNorm()) : 1;
}

}  // namespace orbitutte
