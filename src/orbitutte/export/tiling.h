// SPDX-License-Identifier: MIT
// The whole sphere: |G| copies of an embedding, welded along its seams into one closed mesh.
#pragma once

#include <string>
#include <vector>

#include "orbitutte/orbifold/embedding.h"

namespace orbitutte {

/// One of the |G| copies of the basic tile.
struct TileCopy {
  /// The group element that takes the embedding to this copy.
  Isometry transform;
  /// det(transform) < 0: the faces run in the opposite direction to the embedding's.
  bool mirrored = false;
  /// A small number that differs from that of every neighbour across a seam.
  int colour = 0;
};

/// So many copies of the tile are welded in the plane, unless another number is asked for.
constexpr int default_plane_copies = 25;

/// The copies without a mesh, the identity first: all |G|; of infinitely many, the `copies` nearest to the
/// tile. Throws as weld_copies does if the seams do not generate the group.
std::vector<TileCopy> tile_copies(const Embedding& embedding, int copies = default_plane_copies);

/// The welded copies.
struct Tiling {
  /// Every triangle counterclockwise as seen from outside: closed, on the unit sphere; or a patch of the
  /// plane z = 1.
  Mesh mesh;
  /// Of every triangle: the copy of the tile that holds it, as an index into copies.
  std::vector<int> copy;
  /// Of every triangle: the face of the input mesh.
  std::vector<int> source_face;
  /// The input vertex of every vertex.
  std::vector<int> source_vertex;
  /// All |G| copies, or those in the patch; the identity first.
  std::vector<TileCopy> copies;
  /// The faces that the triangles make up, copy by copy; empty if all are triangles.
  Polygons polygons;
  /// The input faces that every copy has, in the order of its faces.
  std::vector<int> input_faces;
  /// The input's other faces. All their vertices are on one mirror, so that they are arcs, and their mirror
  /// images have the same vertices: they are left out, and so are the vertices that are in no other face.
  std::vector<int> left_out;

  int copy_count() const { return static_cast<int>(copies.size()); }

  /// The faces as in the input: polygons or triangles.
  FaceView faces() const { return polygons.count() > 0 ? FaceView(polygons) : FaceView(mesh.F); }
};

/// Welds by the combinatorics alone: copy g of left[i] is copy g*transform of right[i]. Positions are never
/// compared. Vertices that no face uses are left out; faces and vertices come copy by copy. Polygons are
/// divided so that no diagonal coincides with its mirror image. Time and memory O(m |G|). On the sphere the
/// result is one closed mesh (require_closed_sphere). In the plane the `copies` nearest to the tile are
/// welded, and the border of the mesh is open. Throws ArgumentError if the seams do not generate a group of
/// order embedding.group_order, if the copies do not close up into a sphere (for instance without seams), if
/// the result has more corners than an int can count, if positions are not finite, or if indices are out of
/// range; MeshError if the mesh is not closed, naming the edge or face of the input, as tiled_faces does.
Tiling weld_copies(const Embedding& embedding, int copies = default_plane_copies);

/// The endings that write_tiling knows.
std::vector<std::string> tiling_endings();

/// Writes the format that the path's ending names (any case):
/// - PLY, binary: double x y z, int source_vertex; vertex_indices, uchar red green blue, int tile, int
///   source_face;
/// - OBJ: a group `tile_g` per copy g, a material per colour in an .mtl file beside it, which is written
///   first;
/// - STL, binary: the colour in the attribute word: bit 15 set, then 5 bits each of red, green and blue;
///   without the triangles whose corners fall together in single precision;
/// - GLB: a material and a primitive per colour, all on the same vertices, in single precision.
///
/// PLY and OBJ have polygons if the input has them; STL and GLB have triangles. Neighbouring copies differ
/// in colour; mirrored copies are a shade darker. The file appears whole or not at all. Throws ArgumentError
/// for another ending or a tiling too large for the format (GLB: 4 GiB); MeshError if the format has
/// triangles only and the triangles of polygons are not a closed mesh, or if readers of STL, which know
/// vertices by their positions in single precision, find no surface; and FileError.
void write_tiling(const std::string& path, const Tiling& tiling);

}  // namespace orbitutte
