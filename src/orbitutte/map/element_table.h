// SPDX-License-Identifier: MIT
// The isometries between two embeddings of one target, by number, each with all its digits. Private to map/.
#pragma once

#include <cstdint>
#include <unordered_map>
#include <vector>

#include "orbitutte/geometry/double_double.h"
#include "orbitutte/orbifold/embedding.h"
#include "orbitutte/orbifold/precise_group.h"

namespace orbitutte {

/// Isometries that are products of each other. Equal ones have one number; the identity's is 0.
class ElementTable {
 public:
  static constexpr int identity = 0;

  explicit ElementTable(Space space);

  /// The number of an isometry.
  int add(const Matrix3Of<MostPrecise>& matrix);
  int product(int first, int second);
  int inverse(int element);

  int count() const { return static_cast<int>(elements_.size()); }
  const Isometry& rough(int element) const { return elements_[element].rough; }

  /// With the digits of two doubles: each entry is right to 2^-105 of itself.
  const Matrix3Of<DoubleDouble>& fine(int element) const { return elements_[element].fine; }
  const Matrix3Of<Precise>& precise(int element) const { return elements_[element].precise; }
  const Matrix3Of<MostPrecise>& exact(int element) const { return elements_[element].exact; }
  const Space& space() const { return space_; }

 private:
  struct Element {
    Isometry rough;
    Matrix3Of<DoubleDouble> fine;
    Matrix3Of<Precise> precise;
    Matrix3Of<MostPrecise> exact;
  };

  Space space_;
  std::vector<Element> elements_;
  std::unordered_map<std::uint64_t, int> products_;
  std::unordered_map<int, int> inverses_;
};

/// The group of the target of two embeddings: finds its elements by what they are in doubles.
class SharedGroup {
 public:
  /// If the tile is free, the group is the one that the gluings of `a` generate; or those of `b`, if only its
  /// marks have offsets, which say with more digits how the tile is glued. Throws ArgumentError if that
  /// embedding has no boundary of its target.
  SharedGroup(const Embedding& a, const Embedding& b);

  /// The element near an isometry of the canonical frame. Throws ArgumentError if there is none.
  Matrix3Of<MostPrecise> element(const Isometry& isometry) const;

  /// Elements of the canonical frame, the identity first and the nearest next: all of a finite group.
  std::vector<Isometry> elements_near(const Embedding& embedding) const;

 private:
  struct Word {
    Isometry rough;
    int parent = -1, generator = -1;
  };

  void take_generators(const Embedding& embedding);
  void list_words();
  Matrix3Of<MostPrecise> product_of(int word) const;

  Space space_;
  bool is_free_ = false;

  /// Of a fixed tile.
  PreciseGroup<MostPrecise> group_;

  /// Of a free one: the gluings and their inverses, and products of these.
  std::vector<PreciseElement<MostPrecise>> generators_;
  std::vector<Word> words_;
};

/// The isometry that a matrix of doubles stands for, up to their rounding.
Matrix3Of<MostPrecise> exact_isometry(Space space, const Isometry& isometry);

}  // namespace orbitutte
