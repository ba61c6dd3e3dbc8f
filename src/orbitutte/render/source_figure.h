// SPDX-License-Identifier: MIT
// The source mesh, lit: what all panels that show it have in common.
#pragma once

#include <functional>
#include <vector>

#include "orbitutte/render/camera.h"
#include "orbitutte/render/lighting.h"
#include "orbitutte/render/ornaments.h"

namespace orbitutte {

/// What colours a surface: from a hit's face and place in it to its colour, before it is lit.
using SurfaceColour = std::function<Colour(const Hit&)>;

class SourceFigure {
 public:
  /// V (n x 3, finite) is scaled into the unit ball about the origin. There must be a face.
  SourceFigure(const Points& V, const Triangles& F);

  /// n x 3, in the unit ball.
  const Points& positions() const { return V_; }
  const Triangles& faces() const { return F_; }
  const CornerNormals& normals() const { return normals_; }

  /// The ornaments throw shadows on the surface, too.
  Image draw(const Camera& camera, const SurfaceColour& colour, const Ornaments& ornaments) const;

  /// Is a point visible? Nothing of the surface may lie between the viewer and the point, moved by
  /// `clearance` towards the viewer (a direction).
  bool is_visible(const Vector3& point, const Vector3& viewer, double clearance) const;

 private:
  Ray normal_at(const Ray& ray, const Hit& hit) const;

  Points V_;
  Triangles F_;
  CornerNormals normals_;
  RayScene scene_;
};

/// How a ball or a tube is lit.
Rgba shade_ornament(const Camera& camera, const Ornaments& ornaments, const Hit& hit);

}  // namespace orbitutte
