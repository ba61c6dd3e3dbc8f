// SPDX-License-Identifier: MIT
// The light that reaches what a picture shows, found at a few of its points and interpolated between them:
// it changes slowly, and most rays of a picture would be cast for it.
#pragma once

#include <array>
#include <functional>
#include <optional>
#include <vector>

#include "orbitutte/render/camera.h"
#include "orbitutte/render/lighting.h"

namespace orbitutte {

/// Where rays meet a surface: from just above it, along its unit normal, as far as shade reaches.
using Normals = std::array<std::optional<Ray>, packet_size>;

/// How a surface is lit.
struct LitSurface {
  /// Where it is seen, if nothing hides it.
  std::function<Normals(const Packet&)> seen;
  /// What reaches a point of it, by rays that are turned by a share 0 .. 1 of a full turn.
  std::function<Exposure(const Ray& normal, float turn)> exposure;
};

class ExposureGrid {
 public:
  /// distance: of the camera's rays' origins in front of its centre.
  ExposureGrid(const Camera& camera, double distance, LitSurface surface);

  /// At a point of the surface that is seen in a pixel. If it resembles nothing around it, rays are cast.
  Exposure at(int column, int row, const Ray& normal) const;

 private:
  struct Node {
    Vector3f origin = Vector3f::Zero();
    /// Zero where there is no surface.
    Vector3f normal = Vector3f::Zero();
    Exposure exposure;
  };

  void find_row(const Camera& camera, double distance, int row);
  Exposure smoothed(int column, int row) const;
  float likeness(const Node& node, const Vector3f& origin, const Vector3f& normal) const;

  const Node& node(int column, int row) const {
    return nodes_[static_cast<std::size_t>(row) * columns_ + column];
  }

  LitSurface surface_;
  float pixel_;
  int columns_, rows_;
  std::vector<Node> nodes_;
};

}  // namespace orbitutte
