// SPDX-License-Identifier: MIT
// The bytes of a tiling in each file format; see write_tiling.
#pragma once

#include <string>
#include <vector>

#include "orbitutte/export/palette.h"
#include "orbitutte/export/tiling.h"

namespace orbitutte {

/// A colour that occurs in a tiling.
struct TileMaterial {
  /// "colour_2", or "colour_2_mirrored".
  std::string name;
  Rgb colour;
};

/// The colours in use, in the order in which the copies first show them, and the colour of each copy.
struct TileMaterials {
  std::vector<TileMaterial> materials;
  /// |G|.
  std::vector<int> of_copy;
};

TileMaterials tile_materials(const Tiling& tiling);

std::string ply_bytes(const Tiling& tiling);
std::string stl_bytes(const Tiling& tiling);
std::string glb_bytes(const Tiling& tiling);
std::string mtl_text(const Tiling& tiling);

/// `library` is the name of the .mtl file beside the OBJ file.
std::string obj_text(const Tiling& tiling, const std::string& library);

}  // namespace orbitutte
