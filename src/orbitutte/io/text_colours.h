// SPDX-License-Identifier: MIT
// Colours of vertices in the lines of a text: three numbers of 0 .. 1, or three whole ones of 0 .. 255.
#pragma once

#include <array>
#include <vector>

#include "orbitutte/io/text_scanner.h"
#include "orbitutte/types.h"

namespace orbitutte {

/// The next words of a line, of which further ones are passed over; those that the line lacks are empty.
using NextWords = std::array<std::string_view, 4>;
NextWords take_next_words(TextScanner& in);

/// Gathers the colours of vertices, which come in their order.
class TextColours {
 public:
  /// The first three words as red, green and blue of the next vertex. Throws MeshError naming the line where
  /// one is missing, no number, or not within 0 .. 255.
  void add(const TextScanner& in, const TextItem& vertex, const NextWords& words);

  /// n x 3, 0 .. 1; none where not every one of the n vertices has a colour. Where a channel is above 1, all
  /// are whole numbers and 255 is full. Throws MeshError naming the first vertex of which that does not hold.
  Points colours(Eigen::Index vertices) const;

 private:
  std::vector<double> channels_;
};

}  // namespace orbitutte
