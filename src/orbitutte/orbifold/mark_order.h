// SPDX-License-Identifier: MIT
// The marks of a cone surface in the order in which its boundary meets them.
#pragma once

#include <algorithm>
#include <vector>

#include "orbitutte/orbifold/target.h"

namespace orbitutte {

/// The marks of a sphere, or of a disk, which begins at a corner (Moduli). The last mark is followed by the
/// first.
class MarkOrder {
 public:
  explicit MarkOrder(std::vector<Mark> marks) : marks_(std::move(marks)) {}

  const std::vector<Mark>& marks() const { return marks_; }
  int count() const { return static_cast<int>(marks_.size()); }
  bool is_corner(int i) const { return marks_[i].kind == ConeKind::corner; }
  bool is_disk() const { return !marks_.empty() && is_corner(0); }

  std::vector<int> corners() const {
    std::vector<int> result;
    for (int i = 0; i < count(); ++i)
      if (is_corner(i)) result.push_back(i);
    return result;
  }

  /// The next corner after a mark.
  int corner_after(int i) const {
    do i = (i + 1) % count();
    while (!is_corner(i));
    return i;
  }

  /// The last corner before a mark.
  int corner_before(int i) const {
    do i = (i + count() - 1) % count();
    while (!is_corner(i));
    return i;
  }

  /// The product of the rotations about the cones that are met after the mark i and before the next corner.
  template <typename Element>
  Element product_up_to_corner(int i, const std::vector<Element>& rotations, Element identity) const {
    for (i = (i + 1) % count(); !is_corner(i); i = (i + 1) % count()) identity = identity * rotations[i];
    return identity;
  }

 private:
  std::vector<Mark> marks_;
};

}  // namespace orbitutte
