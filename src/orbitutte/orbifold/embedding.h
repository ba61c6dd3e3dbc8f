// SPDX-License-Identifier: MIT
// A map of a cut mesh onto the basic tile of an orbifold, S^2/G or R^2/G: what is certified, measured, tiled
// and written.
#pragma once

#include <string>
#include <vector>

#include "orbitutte/geometry/geometry.h"

namespace orbitutte {

enum class SeamKind { rotation, reflection, rotoreflection };

/// "rotation", "reflection" or "rotoreflection".
std::string name(SeamKind kind);

/// Two banks of the cut mesh's boundary and the symmetry that takes the right one to the left one:
/// position(left[i]) = transform * position(right[i]), for the interior vertices of the seam and its two end
/// points. A mirror is a seam whose banks are the same vertices.
struct Seam {
  std::vector<int> left;                    ///< cut vertices
  std::vector<int> right;                   ///< cut vertices, as many as in left
  Matrix3 transform = Matrix3::Identity();  ///< an element of O(3), or an isometry of the plane

  SeamKind kind() const;
};

enum class ConeKind { rotation, corner, fixed };

/// "rotation", "corner" or "fixed".
std::string name(ConeKind kind);

/// A marked vertex: its angles on the sphere add up to 2 pi/order (rotation) or pi/order (corner).
struct ConeCopies {
  int vertex = -1;  ///< in the input mesh
  int order = 1;
  ConeKind kind = ConeKind::rotation;
  std::vector<int> copies;  ///< its cut vertices
};

/// The cut mesh on the sphere, and how its boundary is glued.
struct Embedding {
  std::string signature;  ///< Conway's symbol
  int group_order = 1;    ///< |G|; 0 in the plane, where it is infinite
  Points
      positions;  ///< n_cut x 3, on the unit sphere (or z = 1); vertices that no face uses sit at (0, 0, 1)
  Faces faces;    ///< m x 3, the faces of the input in their order, on cut vertices; polygons in triangles
  std::vector<int>
      source_vertex;  ///< n_cut: the input vertex; the first n cut vertices are the input vertices
  std::vector<Seam> seams;
  std::vector<ConeCopies> cones;
  Polygons polygons;  ///< the faces of the input in their order, on cut vertices, where some have more than
                      ///< three corners; none where all are triangles
  Geometry geometry = Geometry::spherical;

  /// The faces of the input, on cut vertices.
  FaceView input_faces() const { return polygons.count() > 0 ? FaceView(polygons) : FaceView(faces); }
};

}  // namespace orbitutte
