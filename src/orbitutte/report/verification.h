// SPDX-License-Identifier: MIT
// The judgement on an embedding and its report again, from the mesh and both alone: `orbitutte verify`.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "orbitutte/report/report.h"
#include "orbitutte/verify/theorem2.h"
#include "orbitutte/weights/weights.h"

namespace orbitutte {

/// What to look at besides the certificate.
struct VerificationOptions {
  /// The weights that the embedding was computed with, where they came from a file.
  std::string weights_file;
  /// Or these themselves.
  std::optional<EdgeWeights> weights;
  /// Also theorem 2's conditions, which can take long.
  bool theorem2 = false;
};

/// What holds, check by check.
struct Verdict {
  /// Of the certificate, then whether the report says the same, then the energy.
  std::vector<Check> checks;
  /// All of them passed.
  bool sound = false;
  /// And the report says that the optimiser converged.
  bool bijective = false;
  /// That the report says so.
  bool converged = false;
  /// Where it was asked for.
  std::optional<Theorem2> theorem2;
};

/// surface: the input. Throws as read_weights and weight_kind do; what does not hold of the embedding or its
/// report is a failed check.
Verdict verify(const Surface& surface, const Embedding& embedding, const Report& report,
               const VerificationOptions& options = {});

/// `bijective`, `checks` and, where it was asked for, `theorem2`, as JSON (docs/file-formats.md).
std::string verdict_json(const Verdict& verdict);

/// The weights of an embedding of the surface, computed again from the surface, from what the report says of
/// them and, where their kind takes these into account, from the embedding's cones. Throws ArgumentError for
/// weights of a file.
EdgeWeights weights_of(const Surface& surface, const Embedding& embedding, const Report& report);

}  // namespace orbitutte
