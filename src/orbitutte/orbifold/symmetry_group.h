// SPDX-License-Identifier: MIT
// Groups of isometries: all elements if the group is finite, otherwise the elements near the tile.
#pragma once

#include <map>
#include <vector>

#include "orbitutte/orbifold/embedding.h"

namespace orbitutte {

/// Elements of a discrete group of isometries. Element 0 is the identity. The sequence depends only on the
/// generators.
class SymmetryGroup {
 public:
  /// All products of the generators. Throws ArgumentError if one is not an isometry of the space (to 1e-9),
  /// or if there are more than `max_order` products.
  SymmetryGroup(Space space, const std::vector<Isometry>& generators, int max_order);

  /// The `count` elements whose images of `centre` lie nearest to it, in that order; all elements if there
  /// are no more.
  static SymmetryGroup nearest_elements(Space space, const std::vector<Isometry>& generators,
                                        const Vector3& centre, int count);

  int order() const { return static_cast<int>(elements_.size()); }
  const std::vector<Isometry>& elements() const { return elements_; }

  /// The index of the element nearest to an isometry, or -1 if none is within 1e-6 of its Frobenius norm.
  /// O(log order).
  int find(const Isometry& element) const;

  /// For every element g, the index of g * element; -1 if that is not among the elements. For a whole group
  /// and one of its elements this is a permutation of 0 .. order - 1.
  std::vector<int> right_products(const Isometry& element) const;

  /// The elements isometry * g * isometry^-1, in the same order.
  SymmetryGroup conjugated(const Isometry& isometry) const;

 private:
  SymmetryGroup() = default;
  void insert(const Isometry& element);

  std::vector<Isometry> elements_;

  /// The elements by a linear function of their entries.
  std::multimap<double, int> index_;
};

/// The group of a target in its canonical frame, whatever cut an embedding has. Throws ArgumentError if the
/// group is infinite or does not have the order that the target states.
SymmetryGroup group_of(const Target& target);

/// The same; of an infinite group, the `count` elements nearest to the middle of the tile, the nearest
/// first.
SymmetryGroup group_of(const Target& target, int count);

/// Do all angles belong to orders, so that copies of the tile fill the space?
bool tiles_its_space(const Target& target);

/// The group of an embedding's target in its canonical frame. If the tile is free, it is the group that the
/// seams generate, and the identity alone unless copies of the tile fill the space.
SymmetryGroup canonical_group_of(const Embedding& embedding, int count);

/// The same in the frame in which the embedding lies.
SymmetryGroup group_of(const Embedding& embedding);
SymmetryGroup group_of(const Embedding& embedding, int count);

}  // namespace orbitutte
