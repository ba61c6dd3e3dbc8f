// SPDX-License-Identifier: MIT
#include "orbitutte/io/value_file.h"

#include <fmt/format.h>

#include <algorithm>

#include "orbitutte/errors.h"
#include "orbitutte/io/file.h"
#include "orbitutte/io/text_scanner.h"

namespace orbitutte {
namespace {

// Does the text begin with a line of names?
bool begins_with_names(std::string_view text) {
  const std::size_t first = text.find_first_not_of(" \t\r\n");
  if (first == std::string_view::npos || text[first] == '#') return false;
  const std::string_view word = text.substr(first, text.find_first_of(" \t\r\n", first) - first);
  double value = 0;
  return parse_number(word, value) == NumberError::malformed;
}

// Calls row(scanner, number) at the first word of every line that has one; it takes all words.
template <typename Row>
void for_rows(std::string_view text, const Row& row) {
  std::string blank_separated(text);
  std::replace(blank_separated.begin(), blank_separated.end(), ',', ' ');
  TextScanner scanner(blank_separated, {.comment = '#'});
  if (begins_with_names(blank_separated) && scanner.find_word()) scanner.rest_of_line();
  for (std::size_t number = 0; scanner.find_word(); ++number) row(scanner, number);
}

template <typename Parse>
auto parsed_file(const std::string& path, const Parse& parse) {
  const std::string text = read_file(path);
  try {
    return parse(text);
  } catch (const MeshError& error) {
    throw MeshError(fmt::format("{}: {}", path, error.what()));
  }
}

}  // namespace

Eigen::MatrixXd parse_values(std::string_view text) {
  std::vector<double> numbers;
  std::size_t rows = 0, columns = 0;
  for_rows(text, [&](TextScanner& scanner, std::size_t number) {
    const TextItem item = {"vertex", number};
    const std::size_t before = numbers.size();
    while (scanner.find_word_in_line()) numbers.push_back(scanner.number<double>(item, "value"));
    const std::size_t found = numbers.size() - before;
    if (number == 0) columns = found;
    if (found != columns)
      scanner.refuse(fmt::format("{} values for vertex {}, where the first has {}", found, number, columns));
    ++rows;
  });
  return Eigen::Map<const Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>>(
      numbers.data(), static_cast<Eigen::Index>(rows), static_cast<Eigen::Index>(columns));
}

std::vector<int> parse_labels(std::string_view text) {
  std::vector<int> labels;
  for_rows(text, [&](TextScanner& scanner, std::size_t number) {
    labels.push_back(scanner.number<int>({"vertex", number}, "label"));
    if (scanner.find_word_in_line()) scanner.refuse(fmt::format("more than one label for vertex {}", number));
  });
  return labels;
}

std::vector<std::vector<int>> parse_curves(std::string_view text) {
  std::vector<std::vector<int>> curves;
  for_rows(text, [&](TextScanner& scanner, std::size_t number) {
    std::vector<int>& curve = curves.emplace_back();
    while (scanner.find_word_in_line()) curve.push_back(scanner.number<int>({"curve", number}, "vertex"));
    if (curve.size() < 2) scanner.refuse(fmt::format("curve {} has one vertex; it needs two", number));
  });
  return curves;
}

Eigen::MatrixXd read_values(const std::string& path) { return parsed_file(path, &parse_values); }

std::vector<int> read_labels(const std::string& path) { return parsed_file(path, &parse_labels); }

std::vector<std::vector<int>> read_curves(const std::string& path) {
  return parsed_file(path, &parse_curves);
}

}  // namespace orbitutte
