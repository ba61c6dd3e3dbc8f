// SPDX-License-Identifier: MIT
// Charts of the sphere as texture coordinates of the cut mesh.
#pragma once

#include <string>
#include <vector>

#include "orbitutte/orbifold/embedding.h"

namespace orbitutte {

/// Maps of the sphere, seen from the middle of the tile, into the unit square.
enum class TextureChart {
  stereographic,    ///< from the point opposite to the middle of the tile: conformal
  equirectangular,  ///< longitude and latitude, the poles to the sides of the tile where it is narrower
  octahedral        ///< an octahedron unfolded: the half around the middle of the tile is the inner square
};

/// "stereographic", "equirectangular" or "octahedral".
std::string name(TextureChart chart);

/// The chart that a name tells. Throws ArgumentError naming all.
TextureChart parse_texture_chart(const std::string& text);

/// A point of the unit square for every corner of every face.
struct TextureCoordinates {
  Eigen::MatrixX2d uv;         ///< one pair for every cut vertex, then further ones where a face needs them
  std::vector<int> of_corner;  ///< a row of uv for every corner of the embedding's input_faces()
  double max_area_distortion = 1;  ///< of max(A, 1/A), A a face's share of the area in the square over its
                                   ///< share on the sphere
  int torn_faces = 0;  ///< faces across the outer edge of the octahedral chart, whose images are wrong there
};

/// Texture coordinates in the unit square; in the equirectangular chart faces across the date line reach over
/// its right edge, where textures repeat.
TextureCoordinates texture_coordinates(const Embedding& embedding, TextureChart chart);

}  // namespace orbitutte
