// SPDX-License-Identifier: MIT
// The tile on the sphere, in the plane or in Poincaré's disk, in bold colour, among its pale copies.
#pragma once

#include <array>
#include <functional>
#include <limits>
#include <optional>

#include "orbitutte/export/palette.h"
#include "orbitutte/export/tiling.h"
#include "orbitutte/geometry/drawn_space.h"
#include "orbitutte/orbifold/embedding.h"
#include "orbitutte/render/camera.h"
#include "orbitutte/render/lighting.h"
#include "orbitutte/render/ornaments.h"

namespace orbitutte {

class SphereFigure {
 public:
  /// relief: n, how bright the source's surface is at every cut vertex, 0 .. 1; the tile and its copies carry
  /// it, so that the source can be recognised on the sphere.
  SphereFigure(const Embedding& embedding, std::vector<float> relief);

  const std::vector<TileCopy>& copies() const { return copies_; }

  Image draw(const Camera& camera, const Ornaments& ornaments) const;

 private:
  /// Where a ray meets the surface.
  struct Meeting {
    float distance = std::numeric_limits<float>::infinity();
    /// Of the embedding's space.
    std::optional<Vector3> point = {};
    Ray normal = {};
  };
  /// What the rays of a packet see. Where there is an ornament, there is no point of the surface.
  struct Seen {
    std::array<Meeting, packet_size> surface;
    Hits ornaments;
  };
  using SurfaceLight = std::function<Exposure(const Ray& normal)>;

  Meeting meeting(const Ray& ray) const;
  Seen look(const Ornaments& ornaments, Packet rays) const;
  Rgba surface_sum(const Seen& seen, const Camera& camera, const SurfaceLight& light) const;
  Colour surface_colour(const std::optional<Hit>& hit, double pixel) const;

  DrawnSpace drawn_;
  Points positions_;
  Triangles faces_;
  std::vector<float> relief_;
  std::vector<TileCopy> copies_;
  std::vector<Colour> copy_colours_;
  Colour around_ = linear(ink::figure);
  /// The mean, on the sphere.
  double edge_length_ = 0;
  RayScene scene_;
};

/// The radius of tubes along the tile's sides: thinner if the tile is small.
double seam_radius(const Target& target);

/// The radius of balls at the marked vertices: large enough for a number on them if the tile has room.
/// pixel: the length of a pixel's side, where the sphere's radius is 1.
double ball_radius(const Embedding& embedding, double pixel);

/// The seams of the tile in their colours, thin grey ones in all copies, and balls at the marked vertices.
/// Balls on the near side are seen whole: towards the outline they come forward from the sphere.
Ornaments sphere_ornaments(const Embedding& embedding, const std::vector<TileCopy>& copies,
                           const Camera& camera);

/// The camera for which the sphere or Poincaré's disk fills the share `fill` of the picture's shorter side;
/// in the plane, the tile with the copies around it if there are any.
Camera sphere_camera(const Embedding& embedding, const View& view, const PictureSize& size, double fill);

/// The space of the embedding, in the disk with the tile in its middle.
DrawnSpace drawn_space(const Embedding& embedding);

/// The tile in the middle of the sphere, seen a little from above and from the right (more so if the tile is
/// large), with the sphere's axis upright. The plane is seen from above.
View tile_view(const Embedding& embedding);

/// The point in the direction of the integral of position over the tile; never a mean of corners, which may
/// cancel.
Vector3 tile_centre(const Embedding& embedding);

}  // namespace orbitutte
