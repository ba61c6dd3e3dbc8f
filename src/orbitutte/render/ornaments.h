// SPDX-License-Identifier: MIT
// Balls at the marked vertices and tubes along the seams: what a picture shows besides surfaces.
#pragma once

#include <vector>

#include "orbitutte/export/colour.h"
#include "orbitutte/render/ray_scene.h"

namespace orbitutte {

/// Coloured tubes and balls that rays can hit.
class Ornaments {
 public:
  /// points: n x 3; fewer than two are ignored.
  void add_tube(const Points& points, double radius, const Rgb& colour);
  void add_ball(const Vector3& centre, double radius, const Rgb& colour);

  /// Copies of other ornaments under orthogonal transforms. They must be committed.
  void add_copies(const Ornaments& original, const std::vector<Matrix3>& transforms);

  void commit() { scene_.commit(); }

  std::optional<Hit> first_hit(const Ray& ray) const { return scene_.first_hit(ray); }
  Hits first_hits(const Packet& rays) const { return scene_.first_hits(rays); }
  std::bitset<packet_size> are_blocked(const Packet& rays) const { return scene_.are_blocked(rays); }
  Colour colour(const Hit& hit) const;

 private:
  RayScene scene_;
  /// By shape.
  std::vector<Colour> colours_;
  /// By shape: the colours inside, if it is a copy.
  std::vector<std::vector<Colour>> of_copies_;
};

/// The rows of `positions` at these vertices.
Points polyline(const Points& positions, const std::vector<int>& vertices);

}  // namespace orbitutte
