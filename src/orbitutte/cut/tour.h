// SPDX-License-Identifier: MIT
// The order in which a cut leads through marked vertices.
#pragma once

#include <vector>

#include "orbitutte/mesh/surface.h"

namespace orbitutte {

/// Orders of the marks (indices), the shortest tour first: open tours through all of them, measured by
/// shortest edge paths. Of up to eight marks all tours, at most `count`; of more the one that exchanges of
/// two legs do not shorten. If `from` is not negative, the tours begin at that vertex, which is no mark.
std::vector<std::vector<int>> short_tours(const Surface& surface, const std::vector<int>& marks, int from,
                                          int count);

}  // namespace orbitutte
