// SPDX-License-Identifier: MIT
// A map of a cut mesh onto the tile of its target: what is certified, measured, tiled and written.
#pragma once

#include <string>
#include <vector>

#include "orbitutte/names.h"
#include "orbitutte/orbifold/target.h"

namespace orbitutte {

enum class SeamKind { rotation, reflection, rotoreflection };

/// Its names.
template <>
struct NameTable<SeamKind> {
  static constexpr NamedValue<SeamKind> rows[] = {{SeamKind::rotation, "rotation"},
                                                  {SeamKind::reflection, "reflection"},
                                                  {SeamKind::rotoreflection, "rotoreflection"}};
};

/// Two banks of the cut mesh's boundary, and the symmetry that takes the right bank to the left one:
/// position(left[i]) = transform * position(right[i]), for the interior vertices of the seam and its two end
/// points. A mirror is a seam whose banks are the same vertices.
struct Seam {
  /// Cut vertices.
  std::vector<int> left;

  /// Cut vertices, as many as in left.
  std::vector<int> right;

  /// An isometry of the target's space.
  Isometry transform;

  SeamKind kind() const;
  bool is_mirror() const { return left == right; }
};

/// A marked vertex and its copies on the boundary of the cut mesh.
struct ConeCopies {
  /// In the input mesh.
  int vertex = -1;
  Mark mark;

  /// Its cut vertices, ascending.
  std::vector<int> copies;
};

/// What the position of a cut vertex has beyond its doubles.
struct Offset {
  int vertex = -1;
  Vector3 d = Vector3::Zero();
};

/// The cut mesh on its target, and how its boundary is glued.
struct Embedding {
  Target target;

  /// Takes the target's canonical frame to the one in which positions and seams lie: the identity, unless the
  /// map was turned to where doubles resolve a small limb.
  Isometry placement;

  /// n_cut x 3, points of the target's space; vertices that no face uses sit at (0, 0, 1).
  Points positions;

  /// T x 3, on cut vertices: the faces of the input in their order, polygons divided into triangles.
  Triangles triangles;

  /// n_cut: the input vertex; the first n cut vertices are the input vertices.
  std::vector<int> source_vertex;
  std::vector<Seam> seams;
  std::vector<ConeCopies> cones;

  /// The faces of the input in their order, on cut vertices, if some have more than three corners; otherwise
  /// none.
  Polygons polygons;

  /// Where doubles do not resolve the map: the position of a cut vertex is exactly the sum of its row of
  /// `positions` and all of its offsets. Ascending by vertex, the largest of a vertex first.
  std::vector<Offset> offsets;

  /// n: how many vertices the input has, up to the last one that has a cut vertex.
  int input_vertex_count() const;

  /// n: for each input vertex a corner 3 t + k of a triangle that lies there, the last one; -1 where there is
  /// none.
  std::vector<int> corner_at_input_vertex() const;

  const Space& space() const { return target.space; }

  /// The faces of the input, on cut vertices.
  FaceView faces() const { return polygons.count() > 0 ? FaceView(polygons) : FaceView(triangles); }

  /// The positions in the target's canonical frame (n_cut x 3), in which results can be compared.
  Points canonical_positions() const;
};

}  // namespace orbitutte
