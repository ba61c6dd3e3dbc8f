// SPDX-License-Identifier: MIT
// From a minimum of the energy to the result: certified, mended if it is no bijection in doubles, measured.
#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "orbitutte/embed_types.h"
#include "orbitutte/preparation.h"
#include "orbitutte/solve/remedies.h"

namespace orbitutte {

/// The gluing problem of a surface that was cut. Its tile is the target's, or any that the target has if that
/// is free. The arguments must outlive it.
GluingProblem gluing_problem(const EmbedRequest& request, const EdgeWeights& weights, const CutMesh& cut,
                             const EmbeddingCache& cache);

/// Weights that are tried, in this order, where the standard ones give no bijection.
std::vector<WeightKind> other_weights(const Surface& surface);

/// What may make a placed map a bijection; nothing if it does not apply.
using Remedy = std::function<std::optional<SpreadMap>(const GluingProblem&, const Placement&)>;

/// A map that was placed, and what is tried, in this order, if it is no bijection in doubles.
struct PlacedMap {
  const Placement& placed;
  std::vector<Remedy> remedies = {with_faces_repaired, with_tips_unrolled, with_limbs_resolved,
                                  with_more_digits};

  /// Taken before all of them, also where the map is a bijection in doubles, if it makes it one; none.
  Remedy refinement = {};
};

/// Puts the map into the result, with its certificate, distortion and warnings. `result` already has the
/// minimum and the weights. SpreadMap::repairing_vertices of the map that was taken.
int finish(const EmbedRequest& request, const GluingProblem& problem, const PlacedMap& map, Stages& stage,
           EmbedResult& result);

}  // namespace orbitutte
