// SPDX-License-Identifier: MIT
// What the program chose, as JSON (docs/file-formats.md).
#pragma once

#include <string>
#include <vector>

#include "orbitutte/choose.h"
#include "orbitutte/report/report.h"

namespace orbitutte {

/// The table: `objective`, and `choices`, the best first, each with `orbifold`, `cones`, `predicted` (sigma,
/// within_4, below_64, symmetric_dirichlet and range) and, if it was embedded, `solved` (the report's
/// distortion) and `bijective`, or `refusal`.
std::string choices_json(const std::vector<Choice>& choices, Objective objective);

/// The report with the key `choice`: the table, and which row was `taken`. Without it if nothing was left to
/// the program.
std::string report_json(const BestEmbedding& embedded, const RunRecord& run);

}  // namespace orbitutte
