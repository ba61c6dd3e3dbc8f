// SPDX-License-Identifier: MIT
// The proof that an embedding is a bijection onto the orbifold. It shares no code with the solver but the
// target: its tile and its group.
#pragma once

#include <string>
#include <vector>

#include "orbitutte/mesh/surface.h"
#include "orbitutte/orbifold/embedding.h"

namespace orbitutte {

struct IntrinsicTriangulation;

/// One condition of the certificate: `value` is compared with `bound` as `name` says.
struct Check {
  std::string name;
  bool passed = false;
  double value = 0;
  double bound = 0;
  /// What failed, with the vertex, face or seam; empty where it passed.
  std::string detail;
};

/// The verdict on an embedding, and the numbers that it rests on.
struct Certificate {
  /// All checks passed.
  bool bijective = false;
  /// Faces with det[a b c] <= 0, exact in sign; polygons that are not convex or not counterclockwise.
  std::vector<int> nonpositive_faces;
  double signed_area = 0;
  /// 4 pi/|G|; of a polygon, what the angles at its corners make it.
  double expected_area = 0;
  /// Radians.
  double max_edge_length = 0;
  /// The largest entry of position(left) - transform * position(right).
  double max_seam_residual = 0;
  std::vector<Check> checks;
};

/// Checks that
/// - every triangle of the cut mesh is positively oriented (exact sign on the stored numbers);
/// - every edge is shorter than pi, and positions lie on the space;
/// - the seams glue the whole boundary of the cut mesh consistently, and match at the scale of the edges
///   beside them; or the boundary goes once around the sides of a convex polygon;
/// - the angles around all vertices, cones and corners are right;
/// - the seams generate a group of order |G|, and the signed area is 4 pi/|G|.
/// Then the tiled surface covers the sphere once, or the map is one onto the polygon. On a projective plane
/// the cut mesh may have turned faces over; the |G| copies cover the sphere once there too, two by two
/// antipodal or related by a rotary reflection, so that the map from the surface to S^2/G is one to one.
///
/// `surface` is the input, whose faces the cut mesh must have. Polygons have to be convex (concave_corners),
/// and are divided into triangles around their middles, which have to be positive. Never throws on account of
/// the embedding: whatever does not hold is a failed check.
Certificate certify(const Surface& surface, const Embedding& embedding);

/// The same for a mesh of so many vertices with these faces, whichever they are.
Certificate certify(int vertex_count, const FaceView& faces, const Embedding& embedding);

/// The same of another triangulation of the surface, whose faces take the place of its own: their
/// images are laid out anew from the embedding and the triangulation's flips. Where it is bijective, the map
/// that is spherical on each of those faces is a bijection, whatever the mesh's own triangles do.
Certificate certify_intrinsic(const Surface& surface, const Embedding& embedding,
                              const IntrinsicTriangulation& triangulation);

}  // namespace orbitutte
