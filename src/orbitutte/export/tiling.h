// SPDX-License-Identifier: MIT
// The whole sphere: |G| copies of an embedding, welded along its seams into one closed mesh.
#pragma once

#include <string>
#include <vector>

#include "orbitutte/orbifold/embedding.h"

namespace orbitutte {

/// One of the |G| copies of the basic tile.
struct TileCopy {
  Matrix3 transform = Matrix3::Identity();  ///< the group element: takes the embedding to this copy
  bool mirrored = false;  ///< det(transform) < 0: its faces run the other way than the embedding's
  int colour = 0;         ///< a small number, another one for every neighbour across a seam
};

/// The |G| copies, the identity first, without any mesh. Throws as tile_sphere does where the seams do not
/// generate the group.
std::vector<TileCopy> tile_copies(const Embedding& embedding);

/// The copies, welded.
struct Tiling {
  Mesh mesh;              ///< closed, on the unit sphere, every triangle counterclockwise from outside
  std::vector<int> tile;  ///< of every triangle: the copy of the tile that holds it, an index into copies
  std::vector<int> source_face;    ///< of every triangle: the face of the input mesh
  std::vector<int> source_vertex;  ///< the input vertex of every vertex
  int tiles = 0;                   ///< |G|
  std::vector<TileCopy> copies;    ///< |G|, the identity first
  Polygons polygons;  ///< the faces that the triangles make up, tile by tile; none where all are triangles
  std::vector<int> input_faces;  ///< that every tile has, in the order of its faces
  /// The input's other faces. All their vertices are on one mirror, so that they are arcs, and their mirror
  /// images have the same vertices: they are left out, and the vertices that are in no other face.
  std::vector<int> left_out;

  /// The faces as those of the input: polygons or triangles.
  FaceView faces() const { return polygons.count() > 0 ? FaceView(polygons) : FaceView(mesh.F); }
};

/// Welds combinatorially: copy g of left[i] is copy g*transform of right[i]; positions are never compared.
/// Faces and vertices come tile by tile; vertices that no face uses are left out. Polygons are divided so
/// that no diagonal coincides with its mirror image. Time and memory O(m |G|). The result is one closed
/// mesh (require_closed_sphere). Throws ArgumentError if the seams do not generate a group of order
/// embedding.group_order, if the copies do not close up into a sphere (without seams, say), if the result has
/// more corners than an int can count, and if positions are not finite or indices out of range; MeshError if
/// the mesh is not closed, naming the edge or face of the input, as tiled_faces does.
Tiling tile_sphere(const Embedding& embedding);

/// Writes the format that the path's ending names (any case):
/// - PLY, binary: double x y z, int source_vertex; vertex_indices, uchar red green blue, int tile,
///   int source_face;
/// - OBJ: a group `tile_g` per tile, a material per colour in an .mtl file beside it, written first;
///   (both in polygons, where the input has them; the two others in triangles)
/// - STL, binary: the colour in the attribute word, bit 15 set, then 5 bits each of red, green and blue;
/// - GLB: a material and a primitive per colour, all on the same vertices, in single precision.
///
/// Neighbouring tiles differ in colour; mirrored tiles are a shade darker. The file appears whole or not at
/// all. Throws ArgumentError for another ending, a tiling too large for the format (GLB: 4 GiB); MeshError if
/// the triangles of polygons, in the formats that have no others, are no closed mesh; FileError.
void write_tiling(const std::string& path, const Tiling& tiling);

}  // namespace orbitutte
