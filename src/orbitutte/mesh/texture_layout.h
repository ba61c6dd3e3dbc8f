// SPDX-License-Identifier: MIT
// Where the corners of a surface's faces lie in its texture.
#pragma once

#include <vector>

#include "orbitutte/mesh/surface.h"

namespace orbitutte {

/// Texture coordinates of a surface.
struct TextureLayout {
  /// k x 2, u to the right and v up; (0, 0) is the lower left corner of the picture, (1, 1) the upper right.
  Eigen::MatrixX2d uv;

  /// A row of uv for every corner of every face, one face after the other.
  std::vector<int> of_corner;
};

/// The rows of uv at the corners of the surface's triangles (T x 3). Throws MeshError if the layout has
/// another number of corners than the surface's faces.
Triangles texture_triangles(const Surface& surface, const TextureLayout& layout);

}  // namespace orbitutte
