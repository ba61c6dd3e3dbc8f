// SPDX-License-Identifier: MIT
// Colours of vertices in the lines of a text: three numbers of 0 .. 1, or of 0 .. 255.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "orbitutte/io/text_scanner.h"
#include "orbitutte/io/vertex_colours.h"

namespace orbitutte {

/// The next words of a line; further words are skipped. Words that the line lacks are empty.
using NextWords = std::array<std::string_view, 4>;
NextWords take_next_words(TextScanner& in);

/// Gathers the colours of vertices, which arrive in the order of the vertices.
class TextColours {
 public:
  /// The first three words as red, green and blue of the next vertex.
  void add(const TextScanner& in, const TextItem& vertex, const NextWords& words);

  /// As colours_of_numbers gives them. There are none if not every one of the n vertices has a colour. If a
  /// word was missing or not a number, there are none either, and a warning names the line.
  VertexColours colours(Eigen::Index vertices) const;

 private:
  double channel(const TextScanner& in, const TextItem& vertex, std::string_view word);

  std::vector<double> channels_;
  /// The first word that is no number.
  std::string problem_;
};

}  // namespace orbitutte
