// SPDX-License-Identifier: MIT
// The layout of nearly all large PLY files, read and written without the detour through PlyFile. It is
// binary: first vertices with x, y, z of one floating-point type among other numbers, then only triangles
// `uchar int int int`.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "orbitutte/io/ply_header.h"
#include "orbitutte/mesh/polygon_mesh.h"

namespace orbitutte {

/// The mesh in a file of this layout; nothing if the file has another one.
std::optional<PolygonMesh> read_ply_triangles(std::string_view bytes, const PlyHeader& header);

/// The values of a vertex property of type int in a file of this layout; nothing if the file has another
/// layout or no such property.
std::optional<std::vector<int>> read_ply_integers(std::string_view bytes, const PlyHeader& header,
                                                  std::string_view property);

/// A vertex property of type int.
struct PlyIntegers {
  std::string name;
  /// One for each vertex.
  const std::vector<int>& values;
};

/// The bytes of a little-endian file of this layout, with x, y, z as doubles, followed by the further
/// properties. serialize_ply makes the same bytes of the same numbers. Throws ArgumentError if a property
/// does not have one value for each vertex.
std::string write_ply_triangles(const Points& V, const Triangles& F,
                                const std::vector<PlyIntegers>& further_properties = {},
                                const std::vector<std::string>& comments = {});

/// How a list of corners says its length: as uchar, or as int if a face has more than 255 corners.
PlyType corner_count_type(const FaceView& faces);

/// The same for faces of any kind, and further elements behind them.
std::string write_ply_faces(const Points& V, const FaceView& faces,
                            const std::vector<PlyIntegers>& further_properties = {},
                            const std::vector<std::string>& comments = {},
                            const std::vector<PlyElement>& further_elements = {});

}  // namespace orbitutte
