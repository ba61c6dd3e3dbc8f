// SPDX-License-Identifier: MIT
#include "orbitutte/io/text_colours.h"

#include <fmt/format.h>

namespace orbitutte {

NextWords take_next_words(TextScanner& in) {
  NextWords words;
  for (std::string_view& word : words) word = in.word();
  in.skip_words();
  return words;
}

double TextColours::channel(const TextScanner& in, const TextItem& vertex, std::string_view word) {
  double value = 0;
  if (parse_number(word, value) == NumberError::none || !problem_.empty()) return value;
  problem_ = word.empty() ? fmt::format("line {}: {} lacks a colour channel", in.line(), shown(vertex))
                          : fmt::format("line {}: {} has the colour channel {}, which is not a number",
                                        in.line(), shown(vertex), in_quotes(word));
  return value;
}

void TextColours::add(const TextScanner& in, const TextItem& vertex, const NextWords& words) {
  for (int k = 0; k < 3; ++k) channels_.push_back(channel(in, vertex, words[k]));
}

VertexColours TextColours::colours(Eigen::Index vertices) const {
  if (!problem_.empty()) return no_colours(problem_);
  if (channels_.empty() || channels_.size() != 3 * static_cast<std::size_t>(vertices)) return {};
  return colours_of_numbers(Eigen::Map<const Points>(channels_.data(), vertices, 3));
}

}  // namespace orbitutte
