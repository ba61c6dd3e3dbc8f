// SPDX-License-Identifier: MIT
#include "orbitutte/io/text_colours.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace orbitutte {

namespace {

constexpr double full_byte = 255;

double read_channel(const TextScanner& in, const TextItem& vertex, std::string_view word) {
  constexpr std::string_view channel = "colour channel";
  double value = 0;
  const NumberError error = parse_number(word, value);
  if (error != NumberError::none) in.refuse_number(error, false, word, vertex, channel);
  if (value >= 0 && value <= full_byte) return value;
  in.refuse(fmt::format("{} has the {} {}, which is neither within 0 .. 1 nor within 0 .. 255", shown(vertex),
                        channel, in_quotes(word)));
}

void require_whole_numbers(const std::vector<double>& channels) {
  const auto fraction =
      std::find_if(channels.begin(), channels.end(), [](double c) { return c != std::trunc(c); });
  if (fraction == channels.end()) return;
  throw MeshError(
      fmt::format("vertex {} has the colour channel {}, but others are above 1, so that all have to be whole "
                  "numbers of 0 .. 255; export the file again",
                  (fraction - channels.begin()) / 3, *fraction));
}

}  // namespace

NextWords take_next_words(TextScanner& in) {
  NextWords words;
  for (std::string_view& word : words) word = in.word();
  in.skip_words();
  return words;
}

void TextColours::add(const TextScanner& in, const TextItem& vertex, const NextWords& words) {
  for (int k = 0; k < 3; ++k) channels_.push_back(read_channel(in, vertex, words[k]));
}

Points TextColours::colours(Eigen::Index vertices) const {
  if (channels_.empty() || channels_.size() != 3 * static_cast<std::size_t>(vertices)) return Points(0, 3);
  const Eigen::Map<const Points> channels(channels_.data(), vertices, 3);
  if (channels.maxCoeff() <= 1) return channels;
  require_whole_numbers(channels_);
  return channels / full_byte;
}

}  // namespace orbitutte
