// SPDX-License-Identifier: MIT
// The colours of a scale, looked up rather than computed.
#pragma once

#include <vector>

#include "orbitutte/export/palette.h"

namespace orbitutte {

class ColourTable {
 public:
  explicit ColourTable(const ColourScale& scale);

  /// The colour of a value on the scale's axis, to within what pictures can tell; grey if it is not a number.
  const Colour& at(double value) const;
  const Colour& of_face(const FaceDistortion& face) const { return at(value_of(scale_.measure, face)); }

 private:
  ColourScale scale_;
  std::vector<Colour> colours_;
  Colour unmeasured_ = linear(ink::unmeasured);
};

}  // namespace orbitutte
