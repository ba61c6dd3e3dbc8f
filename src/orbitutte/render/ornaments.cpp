// SPDX-License-Identifier: MIT
#include "orbitutte/render/ornaments.h"

namespace orbitutte {

void Ornaments::add_tube(const Points& points, double radius, const Rgb& colour) {
  if (points.rows() < 2) return;
  scene_.add_tube(points, radius);
  colours_.push_back(linear(colour));
  of_copies_.emplace_back();
}

void Ornaments::add_ball(const Vector3& centre, double radius, const Rgb& colour) {
  scene_.add_ball(centre, radius);
  colours_.push_back(linear(colour));
  of_copies_.emplace_back();
}

void Ornaments::add_copies(const Ornaments& original, const std::vector<Matrix3>& transforms) {
  for (const Matrix3& transform : transforms) {
    scene_.add_copy(original.scene_, transform);
    colours_.emplace_back(Colour::Zero());
    of_copies_.push_back(original.colours_);
  }
}

Colour Ornaments::colour(const Hit& hit) const {
  return hit.copy < 0 ? colours_[hit.shape] : of_copies_[hit.copy][hit.shape];
}

Points polyline(const Points& positions, const std::vector<int>& vertices) {
  Points points(static_cast<Eigen::Index>(vertices.size()), 3);
  for (std::size_t i = 0; i < vertices.size(); ++i)
    points.row(static_cast<Eigen::Index>(i)) = positions.row(vertices[i]);
  return points;
}

}  // namespace orbitutte
