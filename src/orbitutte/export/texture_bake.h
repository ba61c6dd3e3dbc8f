// SPDX-License-Identifier: MIT
// The texture of one surface, carried to another.
#pragma once

#include <string>

#include "orbitutte/io/image_file.h"
#include "orbitutte/map/overlay.h"
#include "orbitutte/mesh/texture_layout.h"

namespace orbitutte {

/// A surface, its embedding and its texture coordinates.
struct TexturedSurface {
  const Surface& surface;
  const Embedding& embedding;
  const TextureLayout& layout;
};

/// In pixels, 1 .. 16,384 each.
struct TextureSize {
  int width = 0, height = 0;
};

/// Throws ArgumentError if a side is out of range.
void require_texture_size(const TextureSize& size);

/// B's picture in A's texture coordinates: the colour of a point of A is the colour of B where it lies there.
/// On every piece of the overlay both texture coordinates are linear, so that the map is exact at the
/// vertices of the overlay and continuous in between. Every pixel is the mean, in linear light, of nine
/// samples, each from the four nearest pixels of B's picture; B's picture repeats if its coordinates leave
/// the unit square. Pixels that no face of A meets have the colour of the nearest ones, so that nothing
/// foreign shows at the borders of charts, whatever filter a renderer uses.
///
/// Throws ArgumentError if faces of A overlap in its texture on more than a hundredth of what they cover (two
/// parts of A would get the same pixels), cover nothing, or if a size is out of range; MeshError if a layout
/// is not of its surface.
PixelImage bake_texture(const Overlay& overlay, const TexturedSurface& a, const TexturedSurface& b,
                        const PixelImage& picture_of_b, const TextureSize& size);

/// A chart of an embedded surface for textures: suitable_chart's.
TextureLayout new_texture_layout(const Embedding& embedding);

/// The OBJ of a textured surface, whose material is in the file `material` beside it.
std::string textured_obj(const Surface& surface, const TextureLayout& layout, const std::string& material);

/// That file, with the picture in the file `picture` beside it.
std::string textured_material(const std::string& picture);

}  // namespace orbitutte
