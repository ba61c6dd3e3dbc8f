// SPDX-License-Identifier: MIT
// Tables in comma-separated values (RFC 4180).
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace orbitutte {

struct CsvRow {
  /// Where the row begins, counted from 1 as editors do.
  int line = 1;
  /// Without quotes and without blanks around.
  std::vector<std::string> cells;
};

/// All rows, the names of the columns first if the table has them. A cell in double quotes may contain
/// separators, line breaks, and quotes written twice. The separator is the first comma, semicolon or tab of
/// the first line that is not in quotes. Rows without any text are left out, and a byte order mark is
/// skipped. Throws ArgumentError naming the line if a quote is not closed or is followed by further text.
std::vector<CsvRow> read_csv(std::string_view text);

/// The cell as read_csv reads it: in quotes if it has to be.
std::string csv_cell(const std::string& text);

}  // namespace orbitutte
