// SPDX-License-Identifier: MIT
// The proof that an overlay is the common refinement of two surfaces. It shares no code with the tracing: it
// takes the overlay's combinatorics and parents for claims, and computes all signs and areas anew.
#pragma once

#include <vector>

#include "orbitutte/map/overlay.h"
#include "orbitutte/verify/certificate.h"

namespace orbitutte {

/// The verdict on an overlay, and the numbers that it rests on.
struct OverlayCertificate {
  /// All checks passed.
  bool holds = false;

  /// V - E + F.
  int euler_characteristic = 0;

  /// Faces that are not positive, ascending.
  std::vector<int> nonpositive_faces;

  /// By how much the shares of the faces in a triangle of A, or of B, fail to add up to one, at the most.
  double max_share_error = 0;

  /// "indices", "group", "placements", "surface", "euler_characteristic", "vertices", "landmarks", "parents",
  /// "positive_faces", "neighbours", "positions", "shares_of_a", "shares_of_b", "target_area"; of those that
  /// rely on others that failed, none. With divided ears (Overlay::of_parts) all of these are about the
  /// parts, and "ears" is that the overlay names the same vertices and faces.
  std::vector<Check> checks;
};

/// Checks that
/// - the faces are one closed surface, or one with one boundary if the surfaces are disks, of the same Euler
///   characteristic;
/// - every vertex of A and B that a face uses is one vertex of the overlay, and marks lie on marks;
/// - every corner of a face belongs to both parents: it is a corner of one and in the other, or on an edge of
///   both;
/// - every face is a convex polygon, counterclockwise on the target, exact in sign: since the maps from both
///   surfaces to the target are projective and keep orientations on each triangle, it is one on A and on B;
/// - across an edge of the overlay the parent changes if and only if the edge lies on one of the parent's,
///   and the frames agree;
/// - on A and on B, the areas of the faces in a triangle add up to its own: with the above, they cover it
///   exactly once. On the target they add up to the target's.
///
/// The embeddings must be certified. Never throws on account of the overlay: whatever does not hold is a
/// failed check.
OverlayCertificate certify(const Overlay& overlay, const Embedding& a, const Embedding& b);

}  // namespace orbitutte
