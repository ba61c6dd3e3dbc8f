// SPDX-License-Identifier: MIT
// The group elements through which neighbouring vertices see each other.
#pragma once

#include <deque>
#include <vector>

#include "orbitutte/geometry/isometry.h"

namespace orbitutte {

/// A growing list of distinct group elements; element 0 is the identity. References stay valid.
class Elements {
 public:
  Elements() : elements_{Isometry()} {}

  /// The index of an element (to 1e-9), which is appended if it is new.
  int index(const Isometry& element) {
    for (std::size_t k = 0; k < elements_.size(); ++k)
      if (elements_[k].difference(element) < 1e-9) return static_cast<int>(k);
    elements_.push_back(element);
    return static_cast<int>(elements_.size()) - 1;
  }

  const Isometry& operator[](int k) const { return elements_[k]; }

 private:
  std::deque<Isometry> elements_;
};

/// A vertex that another one sees at elements[element] * its position, along an edge with a weight.
struct Neighbour {
  int vertex = -1;
  int element = 0;
  double weight = 0;
};

}  // namespace orbitutte
