// SPDX-License-Identifier: MIT
// What rays can hit: triangles, tubes, balls and copies of whole scenes, through Embree.
#pragma once

#include <array>
#include <bitset>
#include <limits>
#include <memory>
#include <optional>
#include <vector>

#include "orbitutte/render/short_pieces.h"
#include "orbitutte/types.h"

struct RTCSceneTy;

namespace orbitutte {

using Vector3f = Eigen::Vector3f;

struct Ray {
  Vector3f origin;
  Vector3f direction;
  /// In lengths of `direction`.
  float length = std::numeric_limits<float>::infinity();
};

/// Rays that are cast together: eight that run side by side cost no more than two or three alone. Those of
/// negative length meet nothing.
constexpr int packet_size = 8;
using Packet = std::array<Ray, packet_size>;

/// The first thing on a ray.
struct Hit {
  /// In lengths of the ray's direction.
  float distance = 0;
  /// As add_... returned it.
  int shape = -1;
  /// Of triangles: the face.
  int primitive = -1;
  /// As add_copy returned it; -1 if the shape is the scene's own.
  int copy = -1;
  /// Of triangles: the hit is (1 - u - v) a + u b + v c.
  float u = 0, v = 0;
  /// Unit, of the shape as it stands, on either side.
  Vector3f normal;
};

/// Of every ray of a packet.
using Hits = std::array<std::optional<Hit>, packet_size>;

/// In single precision: coordinates should be of the order of one. Triangles are those of an edge-manifold
/// mesh. Add shapes, commit, then cast rays from
/// any thread. Throws std::bad_alloc if memory runs out.
class RayScene {
 public:
  RayScene();

  int add_triangles(const Points& V, const Triangles& F);

  /// A round tube along a polyline of n >= 2 points (n x 3).
  int add_tube(const Points& points, double radius);
  int add_ball(const Vector3& centre, double radius);

  /// A committed scene once more, under an orthogonal transform; its geometry is shared, not copied.
  int add_copy(const RayScene& original, const Matrix3& transform);

  void commit();

  std::optional<Hit> first_hit(const Ray& ray) const;
  Hits first_hits(const Packet& rays) const;

  bool is_blocked(const Ray& ray) const;
  std::bitset<packet_size> are_blocked(const Packet& rays) const;

 private:
  struct Shape {
    /// Of triangles that were divided.
    std::vector<Piece> pieces = {};
    /// Of a copy.
    Eigen::Matrix3f transform = Eigen::Matrix3f::Identity();
    std::shared_ptr<const std::vector<Shape>> original = {};
  };

  /// The hit in the coordinates of its face, with the normal of its copy.
  Hit in_its_shape(Hit hit) const;

  std::shared_ptr<RTCSceneTy> scene_;
  /// Shared with the copies of the scene.
  std::shared_ptr<std::vector<Shape>> shapes_ = std::make_shared<std::vector<Shape>>();
};

}  // namespace orbitutte
