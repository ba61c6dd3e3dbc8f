// SPDX-License-Identifier: MIT
// What the command `map` makes of a map besides its files: pictures, a page, and what is carried from B to A.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "command_files.h"
#include "commands.h"
#include "orbitutte/io/image_file.h"
#include "orbitutte/io/vertex_data.h"
#include "orbitutte/map/composed_map.h"
#include "orbitutte/mesh/texture_layout.h"

namespace orbitutte::cli {

/// What is to be carried, read and compared with B before the map is sought. Throws FileError, MeshError and
/// ArgumentError.
class CarriedInputs {
 public:
  CarriedInputs(const MapArguments& arguments, const Surface& a, const Surface& b);

  std::optional<PixelImage> texture;

  /// Of A, only if it has one that is to be used; of B, if there is a texture.
  std::optional<TextureLayout> layout_of_a, layout_of_b;
  VertexData values, labels;
  std::vector<std::vector<int>> curves;
};

/// Every file that is written for the options that were given; what has no path of its own is in the folder.
std::vector<OutputFile> files_of_products(const MapArguments& arguments, const std::string& folder);

/// The files that the options read.
std::vector<InputFile> inputs_of_products(const MapArguments& arguments);

/// Does the command line ask for anything of this kind?
bool wants_products(const MapArguments& arguments);

/// Throws ArgumentError for options that do not go together: what needs a folder and has none, frames without
/// a morph, ...
void require_sound_products(const MapArguments& arguments);

/// A map, and what it is of.
struct MappedSurfaces {
  const Surface &a, &b;
  const SurfaceMap& map;
  const ComposedMap& composed;
};

/// Throws ArgumentError in builds without pictures, and for a view or a direction up that is none.
void require_pictures(const std::string& view, const std::string& up);

/// The sheet of a map: PNG.
std::string map_picture(const MapArguments& arguments, const MappedSurfaces& mapped);

/// Makes everything that is asked for, then writes it; what has no path of its own into the folder. Throws
/// ArgumentError and FileError.
void write_products(const MapArguments& arguments, const std::string& folder, const CarriedInputs& carried,
                    const MappedSurfaces& mapped);

}  // namespace orbitutte::cli
