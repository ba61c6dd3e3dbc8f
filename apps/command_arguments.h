// SPDX-License-Identifier: MIT
// Arguments that several commands share.
#pragma once

#include <string>
#include <vector>

#include "orbitutte/mesh/weights.h"

namespace orbitutte::cli {

/// Vertices separated by commas. Throws ArgumentError.
std::vector<int> parse_cones(const std::string& text);

/// The kind of weights that a name tells. Throws ArgumentError naming all.
WeightKind parse_weights(const std::string& text);

}  // namespace orbitutte::cli
