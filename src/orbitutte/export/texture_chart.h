// SPDX-License-Identifier: MIT
// Charts of the sphere as texture coordinates of the cut mesh.
#pragma once

#include <string>
#include <vector>

#include "orbitutte/names.h"
#include "orbitutte/orbifold/embedding.h"

namespace orbitutte {

/// Maps from the sphere into the unit square, centred at the middle of the tile.
enum class TextureChart {
  /// The projection from the point opposite to the middle of the tile. It is conformal; in the plane it is
  /// the plane itself.
  stereographic,
  /// Longitude and latitude. The poles lie beside the tile, in the direction in which it is narrower.
  equirectangular,
  /// An unfolded octahedron. The half around the middle of the tile is the inner square.
  octahedral
};

/// Its names.
template <>
struct NameTable<TextureChart> {
  static constexpr NamedValue<TextureChart> rows[] = {{TextureChart::stereographic, "stereographic"},
                                                      {TextureChart::equirectangular, "equirectangular"},
                                                      {TextureChart::octahedral, "octahedral"}};
};

/// A point of the unit square for every corner of every face.
struct TextureCoordinates {
  /// One pair for every cut vertex, then further ones for faces that need them.
  Eigen::MatrixX2d uv;
  /// The row of uv of every corner of the embedding's faces().
  std::vector<int> of_corner;
  /// The largest max(A, 1/A), where A is a face's share of the area in the square over its share on the
  /// sphere.
  double max_area_distortion = 1;
  /// The number of faces across the outer edge of the octahedral chart, whose images are wrong there.
  int torn_faces = 0;
};

/// The chart that suits an embedding if none is asked for: stereographic, or equirectangular for the whole
/// sphere.
TextureChart suitable_chart(const Embedding& embedding);

/// Texture coordinates in the unit square. In the equirectangular chart, faces across the date line reach
/// beyond its right edge, where textures repeat. Throws ArgumentError if the embedding lies in the plane and
/// the chart is one of the sphere only, and for the stereographic one of the whole sphere.
TextureCoordinates texture_coordinates(const Embedding& embedding, TextureChart chart);

}  // namespace orbitutte
