// SPDX-License-Identifier: MIT
#include "orbitutte/io/curve_file.h"

#include <fmt/format.h>

#include <algorithm>

#include "orbitutte/errors.h"
#include "orbitutte/io/file.h"
#include "orbitutte/io/text_scanner.h"

namespace orbitutte {

std::vector<std::vector<int>> parse_curves(std::string_view text) {
  std::string blank_separated(text);
  std::replace(blank_separated.begin(), blank_separated.end(), ',', ' ');
  TextScanner scanner(blank_separated, {.comment = '#'});
  std::vector<std::vector<int>> curves;
  for (std::size_t number = 0; scanner.find_word(); ++number) {
    std::vector<int>& curve = curves.emplace_back();
    while (scanner.find_word_in_line()) curve.push_back(scanner.number<int>({"curve", number}, "vertex"));
    if (curve.size() < 2) scanner.refuse(fmt::format("curve {} has one vertex; it needs two", number));
  }
  return curves;
}

std::vector<std::vector<int>> read_curves(const std::string& path) { return parse_file(path, &parse_curves); }

}  // namespace orbitutte
