// SPDX-License-Identifier: MIT
// The source mesh with its embedding as texture coordinates and its distortion as colours, for other
// programs.
#pragma once

#include <string>
#include <vector>

#include "orbitutte/export/texture_chart.h"
#include "orbitutte/mesh/surface.h"
#include "orbitutte/verify/distortion.h"

namespace orbitutte {

/// A surface, and everything about its embedding that is written.
struct ExportedModel {
  /// The input.
  Surface surface;
  /// The embedding of the input.
  Embedding embedding;
  /// Texture coordinates of the embedding.
  TextureCoordinates texture;
  /// m: the distortion of the input's faces. A polygon's is the mean over its triangles, weighted by area, so
  /// that A is the polygon's own.
  std::vector<FaceDistortion> of_face;
};

/// Throws MeshError if the embedding is not one of the surface.
ExportedModel exported_model(Surface surface, const Embedding& embedding, TextureChart chart);

/// The endings that write_model knows.
std::vector<std::string> model_endings();

/// Writes the format that the path's ending names (any case):
/// - OBJ: the input's vertices and faces, untouched; only `vt` has seams;
/// - GLB: the faces as triangles, a vertex for every pair of position and texture coordinates, smooth
///   normals, log area distortion as vertex colours, single precision;
/// - PLY, binary: the input's vertices and faces with `quality`, the base-2 logarithm of the area distortion
///   A; at a vertex it is the mean over the faces around it;
/// - VTP (XML, base64): the cut mesh in space, with its sphere positions, texture coordinates and source
///   vertices as point arrays, and area and angle distortion as cell arrays.
///
/// Compressed if `.gz` follows. The file appears whole or not at all. Throws ArgumentError for another ending
/// or if the model is too large for the format, and FileError.
void write_model(const std::string& path, const ExportedModel& model);

}  // namespace orbitutte
