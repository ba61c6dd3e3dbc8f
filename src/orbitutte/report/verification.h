// SPDX-License-Identifier: MIT
// Judges an embedding and its report again, from nothing but these and the mesh: `orbitutte verify`.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "orbitutte/report/report.h"
#include "orbitutte/verify/theorem2.h"
#include "orbitutte/weights/weights.h"

namespace orbitutte {

/// What to check besides the certificate.
struct VerificationOptions {
  /// The file of the weights that the embedding was computed with, if they came from a file.
  std::string weights_file;
  /// Or the weights themselves.
  std::optional<EdgeWeights> weights;
  /// Whether to check theorem 2's conditions, too, which can take long.
  bool theorem2 = false;
};

/// The outcome, check by check.
struct Verdict {
  /// The checks of the certificate, then whether the report says the same, then the energy.
  std::vector<Check> checks;
  /// All of them passed.
  bool sound = false;
  /// All checks passed, and the report says that the optimiser converged.
  bool bijective = false;
  /// What the report says.
  bool converged = false;
  /// Only if it was asked for.
  std::optional<Theorem2> theorem2;
};

/// surface: the input. Throws ArgumentError if there is a file of weights, but the weights came from none,
/// and as read_weights and weight_kind do. Whatever is wrong with the embedding or its report is a failed
/// check.
Verdict verify(const Surface& surface, const Embedding& embedding, const Report& report,
               const VerificationOptions& options = {});

/// `bijective`, `checks` and, if it was asked for, `theorem2`, as JSON (docs/file-formats.md).
std::string verdict_json(const Verdict& verdict);

/// The weights of an embedding of the surface, computed again from the surface, from what the report says of
/// them and, if their kind depends on cones, from the embedding's cones. Throws ArgumentError for weights of
/// a file.
EdgeWeights weights_of(const Surface& surface, const Embedding& embedding, const Report& report);

}  // namespace orbitutte
