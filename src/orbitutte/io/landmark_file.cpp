// SPDX-License-Identifier: MIT
#include "orbitutte/io/landmark_file.h"

#include <fmt/format.h>

#include <algorithm>

#include "orbitutte/io/file.h"
#include "orbitutte/io/text_scanner.h"

namespace orbitutte {
namespace {

Landmark next_landmark(TextScanner& scanner, std::size_t number) {
  const TextItem item = {"landmark", number};
  Landmark landmark;
  landmark.a = scanner.number<int>(item, "vertex of A");
  landmark.b = scanner.number<int>(item, "vertex of B");
  if (scanner.find_word_in_line())
    scanner.refuse(fmt::format("more than two columns for the landmark {}:{}", landmark.a, landmark.b));
  return landmark;
}

bool begins_with_number(std::string_view line) {
  const std::string_view word = line.substr(0, line.find_first_of(" \t\r\n"));
  double value = 0;
  return parse_number(word, value) != NumberError::malformed;
}

// Does the text begin with the names of the columns?
bool has_header(std::string_view text) {
  const std::size_t first = text.find_first_not_of(" \t\r\n");
  return first != std::string_view::npos && text[first] != '#' && !begins_with_number(text.substr(first));
}

std::vector<Landmark> landmarks_in(std::string text) {
  std::replace(text.begin(), text.end(), ',', ' ');
  const bool skips_line = has_header(text);
  TextScanner scanner(text, {.comment = '#'});
  if (skips_line && scanner.find_word()) scanner.rest_of_line();
  std::vector<Landmark> landmarks;
  while (scanner.find_word()) landmarks.push_back(next_landmark(scanner, landmarks.size()));
  return landmarks;
}

int vertex_of(std::string_view word, std::string_view entry) {
  int vertex = 0;
  if (parse_number(word, vertex) == NumberError::none) return vertex;
  throw ArgumentError(fmt::format("the landmark {} is not two vertices, one of A and one of B, such as 12:7",
                                  in_quotes(entry)));
}

}  // namespace

std::vector<Landmark> read_landmarks(const std::string& path) { return parse_file(path, landmarks_in); }

std::vector<Landmark> parse_landmarks(std::string_view list) {
  std::vector<Landmark> landmarks;
  for (;;) {
    const std::size_t end = list.find(',');
    const std::string_view entry = list.substr(0, end);
    const std::size_t colon = entry.find(':');
    const std::string_view second =
        colon == std::string_view::npos ? std::string_view() : entry.substr(colon + 1);
    landmarks.push_back({vertex_of(entry.substr(0, colon), entry), vertex_of(second, entry)});
    if (end == std::string_view::npos) return landmarks;
    list.remove_prefix(end + 1);
  }
}

bool is_landmark_list(std::string_view text) {
  const std::size_t colon = text.find(':');
  return colon != std::string_view::npos && colon > 0 &&
         text.substr(0, colon).find_first_not_of("+-0123456789") == std::string_view::npos;
}

}  // namespace orbitutte
