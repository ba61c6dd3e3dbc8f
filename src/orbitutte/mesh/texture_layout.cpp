// SPDX-License-Identifier: MIT
#include "orbitutte/mesh/texture_layout.h"

#include <fmt/format.h>

#include "orbitutte/errors.h"

namespace orbitutte {

Triangles texture_triangles(const Surface& surface, const TextureLayout& layout) {
  const FaceView faces = surface.faces();
  const auto corners = static_cast<std::size_t>(faces.start(faces.count()));
  if (layout.of_corner.size() != corners)
    throw MeshError(fmt::format("there are texture coordinates for {} corners, but the faces have {}",
                                layout.of_corner.size(), corners));
  Triangles rows(surface.triangle_count(), 3);
  for (int t = 0; t < surface.triangle_count(); ++t)
    for (int k = 0; k < 3; ++k)
      rows(t, k) = layout.of_corner[surface.has_polygons() ? surface.division(t, k) : 3 * t + k];
  return rows;
}

}  // namespace orbitutte
