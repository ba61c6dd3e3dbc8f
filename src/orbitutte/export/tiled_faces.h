// SPDX-License-Identifier: MIT
// The faces of an embedding that can stand beside their mirror images in one mesh.
#pragma once

#include <array>
#include <vector>

#include "orbitutte/orbifold/embedding.h"

namespace orbitutte {

/// The mirrors on which each cut vertex lies, at most two of them, by any number that tells one mirror from
/// the other; -1 for none.
using MirrorsOfVertices = std::vector<std::array<int, 2>>;

/// What every copy of the tile consists of.
struct TiledFaces {
  /// On cut vertices.
  Triangles triangles;
  /// Of every triangle: the input face.
  std::vector<int> face_of;
  /// On cut vertices; none where all faces are triangles.
  Polygons polygons;
  /// Those that are here, ascending.
  std::vector<int> input_faces;
  /// And those that are not.
  std::vector<int> left_out;
};

/// The faces of the embedding but those all of whose vertices lie on one mirror: such a face is an arc, and
/// its mirror image has the same vertices. A polygon whose triangles have a side between two vertices of one
/// mirror is divided anew, since that side would coincide with its mirror image. Throws MeshError naming
/// an edge of the input that does so, or a face that cannot be divided, and what to do about it.
TiledFaces tiled_faces(const Embedding& embedding, const MirrorsOfVertices& mirrors);

}  // namespace orbitutte
