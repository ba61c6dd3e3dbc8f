// SPDX-License-Identifier: MIT
// What is done where the minimum, rounded to doubles, is no bijection: thin triangles of the input, and limbs
// that shrink below what doubles resolve.
#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "orbitutte/geometry/precise.h"
#include "orbitutte/solve/ears.h"
#include "orbitutte/solve/placement.h"

namespace orbitutte {

/// A map as it is judged and written.
struct SpreadMap {
  /// Tile, gluing and frame; its positions are those of the input vertices, in doubles.
  Placement placed;

  /// n_cut x 3.
  Points positions;
  std::vector<Offset> offsets;

  /// Input vertices that were moved off the minimum, ascending; and how many of them were to repair faces,
  /// not only since they lie around cones that turn faces over.
  std::vector<int> moved_vertices;
  int repairing_vertices = 0;
};

/// The map as it was placed, its ears rounded outward.
SpreadMap spread_map(const GluingProblem& problem, const Placement& placed);

/// Is a face of the cut mesh not positive?
bool turns_faces_over(const GluingProblem& problem, const SpreadMap& map);

/// The faces that become arcs, of the cut mesh.
std::vector<Ear> ears_of(const GluingProblem& problem, const Placement& placed);

/// The same with turned faces repaired in place. Nothing if that fails, or if one of them lies in a limb,
/// where edges are as short as in with_limbs_resolved: it is left to that.
std::optional<SpreadMap> with_faces_repaired(const GluingProblem& problem, const Placement& placed);

/// With the vertices around cones placed anew where faces beside them are turned over (unroll_tip), and other
/// faces repaired; nothing if there are no such cones, if faces remain, or if one of them lies in a limb, as
/// in with_faces_repaired.
std::optional<SpreadMap> with_tips_unrolled(const GluingProblem& problem, const Placement& placed);

/// The same turned to where doubles resolve the smallest limb, all limbs settled there, and turned faces
/// repaired. Nothing if no edge is shorter than 1e-6, if the tile may not be turned, or if that fails.
std::optional<SpreadMap> with_limbs_resolved(const GluingProblem& problem, const Placement& placed);

/// Where input vertices lie, with more digits than doubles have.
using PrecisePoint = std::function<Vector3Of<Precise>(int)>;

/// The same with the vertices of limbs put where `point` says, near to where they are, and turned faces
/// repaired. Nothing if there are no limbs, if edges are shorter than 1e-60, or if that fails.
std::optional<SpreadMap> with_digits_of(const PrecisePoint& point, const GluingProblem& problem,
                                        const Placement& placed);

/// The same with more digits in the limbs, as many as the shortest edge asks for. If the tile is free, its
/// marks and the ends of its mirrors have them too, which say how it is glued.
std::optional<SpreadMap> with_more_digits(const GluingProblem& problem, const Placement& placed);

/// The same at the minimum over all vertices, to small parts of the shortest edges: limbs do not only have
/// their shapes, but also lie where the whole map puts them, however small they are. with_more_digits if that
/// does not come about, or if there are too many vertices; nothing if no edge is shorter than 1e-11, of
/// little meshes 1e-9.
std::optional<SpreadMap> with_limbs_in_place(const GluingProblem& problem, const Placement& placed);

}  // namespace orbitutte
