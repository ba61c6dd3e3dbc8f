// SPDX-License-Identifier: MIT
// Positions as exact sums of doubles and offsets: differences and orientations that no rounding spoils.
#pragma once

#include <array>
#include <boost/container/small_vector.hpp>
#include <cmath>
#include <utility>
#include <vector>

#include "orbitutte/geometry/precise.h"
#include "orbitutte/orbifold/embedding.h"

namespace orbitutte {

/// The exact sum of doubles, as doubles of ascending size that do not overlap.
class ExactSum {
 public:
  void add(double x) {
    std::size_t used = 0;
    for (double y : parts_) {
      if (std::abs(x) < std::abs(y)) std::swap(x, y);
      const double sum = x + y, rest = y - (sum - x);
      if (rest != 0) parts_[used++] = rest;
      x = sum;
    }
    parts_.resize(used);
    parts_.push_back(x);
  }

  /// Off by less than a unit in the last place.
  double rounded() const {
    double sum = 0;
    for (const double part : parts_) sum += part;
    return sum;
  }

 private:
  boost::container::small_vector<double, 16> parts_;
};

/// The positions of an embedding, each exactly the sum of its row and all of its offsets. Where there are no
/// offsets everything is computed from the doubles alone, at no further cost. Refers to the embedding, whose
/// offsets must name its vertices and be finite.
class ExactPositions {
 public:
  explicit ExactPositions(const Embedding& embedding);

  /// The number of vertices.
  int count() const { return static_cast<int>(X_.rows()); }

  /// Does any vertex have an offset other than 0?
  bool has_offsets() const { return !start_.empty(); }
  bool has_offsets(int v) const { return has_offsets() && start_[v + 1] > start_[v]; }

  /// The double nearest to each coordinate of the position.
  Vector3 rounded(int v) const;

  /// position(to) - position(from), each coordinate correctly rounded: right to 1e-16 of itself, however
  /// small.
  Vector3 difference(int from, int to) const {
    if (has_offsets(from) || has_offsets(to)) return exact_difference(from, to);
    return X_.row(to) - X_.row(from);
  }

  /// b - a, c - b, a - c.
  std::array<Vector3, 3> edges(int a, int b, int c) const {
    return {difference(a, b), difference(b, c), difference(c, a)};
  }

  /// sqrt(<d, d>) of the difference d; nothing underflows on the way.
  double chord(int a, int b) const;

  /// The distance of the two in the space.
  double distance(int a, int b) const;

  /// The signed area of the triangle a, b, c: see Space::area.
  double area(int a, int b, int c) const;

  /// The sign (-1, 0, 1) of det[a b c] of the exact positions, as orientation_sign.
  int orientation(int a, int b, int c) const;

  /// The size of what the coordinates of a position leave open, 2^-52 of the last number in their sum.
  double rounding(int v) const;

  /// The sum with all its digits.
  Vector3Of<MostPrecise> exact(int v) const;

  /// How many offsets the vertex has.
  int offset_count(int v) const { return has_offsets() ? start_[v + 1] - start_[v] : 0; }

 private:
  Vector3 exact_difference(int from, int to) const;

  /// Adds sign times coordinate i of the position.
  void add_coordinate(int v, int i, double sign, ExactSum& sum) const;

  Space space_;
  const Points& X_;

  /// n_cut + 1: the offsets of vertex v, none of them 0, are offset_[start_[v]] .. offset_[start_[v + 1] -
  /// 1]. Both are empty if there are none.
  std::vector<int> start_;
  std::vector<Vector3> offset_;
};

/// Makes a position the row of a vertex and so many offsets: as near as that many further doubles bring it.
void store(Embedding& embedding, int v, const Vector3Of<MostPrecise>& position, int offsets);

}  // namespace orbitutte
