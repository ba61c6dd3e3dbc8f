// SPDX-License-Identifier: MIT
// The group elements through which neighbouring vertices see each other.
#pragma once

#include <vector>

#include "orbitutte/solve/boundary_conditions.h"

namespace orbitutte {

/// A growing list of distinct group elements; element 0 is the identity. Each is made of some before it: it
/// is a product of two, or of one and the transform of a cut vertex, or of two such, or of their inverses.
class Elements {
 public:
  Elements() = default;
  /// Those of `first`, in its order.
  explicit Elements(const std::vector<Isometry>& first) {
    for (const Isometry& element : first) index(element);
  }

  /// The index of an element, which is appended if it is new.
  int index(const Isometry& element) { return index_among(elements_, element); }

  const Isometry& operator[](int k) const { return elements_[k]; }
  int count() const { return static_cast<int>(elements_.size()); }

 private:
  std::vector<Isometry> elements_ = {Isometry()};
};

/// A vertex that another one sees at elements[element] * its position, along an edge with a weight.
struct Neighbour {
  int vertex = -1;
  int element = 0;
  double weight = 0;
};

}  // namespace orbitutte
