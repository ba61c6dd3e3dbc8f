// SPDX-License-Identifier: MIT
#include "orbitutte/io/csv.h"

#include <fmt/format.h>

#include <algorithm>

#include "orbitutte/errors.h"

namespace orbitutte {
namespace {

constexpr std::string_view utf8_mark = "\xEF\xBB\xBF";
constexpr std::string_view csv_blanks = " \t\r";

std::string without_blanks(std::string_view text) {
  const std::size_t first = text.find_first_not_of(csv_blanks);
  if (first == std::string_view::npos) return {};
  return std::string(text.substr(first, text.find_last_not_of(csv_blanks) - first + 1));
}

char separator_of(std::string_view text) {
  bool is_quoted = false;
  for (const char c : text) {
    if (c == '"') is_quoted = !is_quoted;
    if (is_quoted) continue;
    if (c == ',' || c == ';' || c == '\t') return c;
    if (c == '\n') break;
  }
  return ',';
}

class CsvReader {
 public:
  explicit CsvReader(std::string_view text) : text_(text), separator_(separator_of(text)) {}

  std::vector<CsvRow> rows() {
    std::vector<CsvRow> result;
    while (!text_.empty()) {
      CsvRow row = next_row();
      const auto is_empty = [](const std::string& cell) { return cell.empty(); };
      if (!std::all_of(row.cells.begin(), row.cells.end(), is_empty)) result.push_back(std::move(row));
    }
    return result;
  }

 private:
  CsvRow next_row() {
    CsvRow row = {line_, {}};
    for (;;) {
      row.cells.push_back(next_cell());
      const bool goes_on = !text_.empty() && text_.front() == separator_;
      if (!text_.empty()) step();
      if (!goes_on) return row;
    }
  }

  // Leaves the separator or line break behind the cell.
  std::string next_cell() {
    while (!text_.empty() && text_.front() != separator_ && csv_blanks.find(text_.front()) != csv_blanks.npos)
      step();
    return !text_.empty() && text_.front() == '"' ? quoted_cell() : without_blanks(rest_of_cell());
  }

  std::string_view rest_of_cell() {
    const char ends[] = {separator_, '\n'};
    const std::string_view cell = text_.substr(0, text_.find_first_of({ends, 2}));
    text_.remove_prefix(cell.size());
    return cell;
  }

  std::string quoted_cell() {
    const int begin = line_;
    std::string cell;
    step();
    for (; !text_.empty(); step()) {
      if (text_.front() == '"') {
        if (!text_.substr(1).starts_with('"')) break;
        step();
      }
      cell += text_.front();
    }
    if (text_.empty())
      throw ArgumentError(fmt::format("line {}: a quote is not closed; add a '\"' behind the cell", begin));
    step();
    if (const std::string more = without_blanks(rest_of_cell()); !more.empty())
      throw ArgumentError(
          fmt::format("line {}: '{}' follows a closing quote; put the whole cell into quotes", line_, more));
    return cell;
  }

  void step() {
    if (text_.front() == '\n') ++line_;
    text_.remove_prefix(1);
  }

  std::string_view text_;
  char separator_;
  int line_ = 1;
};

}  // namespace

std::vector<CsvRow> read_csv(std::string_view text) {
  if (text.starts_with(utf8_mark)) text.remove_prefix(utf8_mark.size());
  return CsvReader(text).rows();
}

std::string csv_cell(const std::string& text) {
  if (text.find_first_of(",;\"\t\r\n") == std::string::npos && without_blanks(text) == text) return text;
  std::string cell = "\"";
  for (const char c : text) cell += c == '"' ? std::string("\"\"") : std::string(1, c);
  return cell + '"';
}

}  // namespace orbitutte
