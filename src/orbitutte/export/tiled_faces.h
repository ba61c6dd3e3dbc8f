// SPDX-License-Identifier: MIT
// The faces of an embedding that can stand beside their mirror images in one mesh.
#pragma once

#include <array>
#include <vector>

#include "orbitutte/orbifold/embedding.h"

namespace orbitutte {

/// The mirrors on which each cut vertex lies, at most two. Each mirror has some number that tells it from
/// the others; -1 stands for none.
using MirrorsOfVertices = std::vector<std::array<int, 2>>;

/// What every copy of the tile consists of.
struct TiledFaces {
  /// On cut vertices.
  Triangles triangles;
  /// Of every triangle: the input face.
  std::vector<int> face_of;
  /// On cut vertices; empty if all faces are triangles.
  Polygons polygons;
  /// The input faces that are here, ascending.
  std::vector<int> input_faces;
  /// The input faces that are not.
  std::vector<int> left_out;
};

/// The faces of the embedding without those whose vertices all lie on one mirror: such a face is an arc, and
/// its mirror image has the same vertices. If a triangle of a polygon has a side between two vertices of one
/// mirror, the polygon is divided anew, since that side would coincide with its mirror image. Throws
/// MeshError if an edge of the input coincides with its mirror image or if a face cannot be divided; names
/// it, and says what to do.
TiledFaces tiled_faces(const Embedding& embedding, const MirrorsOfVertices& mirrors);

}  // namespace orbitutte
