// SPDX-License-Identifier: MIT
// The page that sums up a batch.
#pragma once

#include <string>
#include <vector>

#include "orbitutte/report/batch_record.h"

namespace orbitutte {

/// One HTML page: how many jobs ended how, and a row for each job, with links to its files, which stand
/// beside the page.
std::string batch_page(const std::vector<JobRecord>& records, std::size_t missing);

}  // namespace orbitutte
