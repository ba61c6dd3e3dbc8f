// SPDX-License-Identifier: MIT
// The pictures that stand in for the interactive view of a page.
#pragma once

#include <vector>

#include "orbitutte/page/page.h"
#include "orbitutte/report/report.h"

namespace orbitutte::cli {

/// Empty in builds without pictures.
std::vector<PagePicture> page_pictures(const Surface& surface, const Embedding& embedding,
                                       const Report& report);

}  // namespace orbitutte::cli
