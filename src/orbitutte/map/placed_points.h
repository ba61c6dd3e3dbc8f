// SPDX-License-Identifier: MIT
// Points that are moved by elements of a group, and signs of determinants of three of them that no rounding
// spoils. Private to map/.
#pragma once

#include <array>
#include <vector>

#include "orbitutte/geometry/barycentric_coordinates.h"
#include "orbitutte/geometry/double_double.h"
#include "orbitutte/map/element_table.h"

namespace orbitutte {

/// Points with all their digits. Most are doubles as they are.
class Sites {
 public:
  /// n x 3.
  explicit Sites(const Points& doubles) : exact_of_(doubles.rows(), -1) {
    rough_.reserve(exact_of_.size());
    for (Eigen::Index k = 0; k < doubles.rows(); ++k) rough_.emplace_back(doubles.row(k));
  }

  /// Makes room for the digits of so many points.
  void reserve_exact(int count) { digits_.reserve(static_cast<std::size_t>(count)); }

  int count() const { return static_cast<int>(exact_of_.size()); }

  /// Appends a point of doubles, and returns its site.
  int append(const Vector3& doubles);

  /// Gives a point more digits than its row of doubles has.
  void set_exact(int site, const Vector3Of<MostPrecise>& position);

  /// Are the doubles all there is?
  bool is_double(int site) const { return exact_of_[site] < 0; }
  const Vector3& rough(int site) const { return rough_[site]; }

  /// By how much each rough coordinate may be off.
  double error(int site) const;

  /// The same with the digits of two doubles.
  Vector3Of<DoubleDouble> fine(int site) const;
  double fine_error(int site) const;

  Vector3Of<Precise> precise(int site) const;
  Vector3Of<MostPrecise> exact(int site) const;

 private:
  struct Digits {
    Vector3 rest;  // beyond the doubles
    Vector3Of<Precise> precise;
    Vector3Of<MostPrecise> exact;
  };

  std::vector<Vector3> rough_;
  std::vector<int> exact_of_;
  std::vector<Digits> digits_;
};

/// A site moved by an element.
struct PlacedPoint {
  const Sites* sites = nullptr;
  int site = 0;
  int element = ElementTable::identity;

  /// Where that is in doubles, and by how much each coordinate may be off.
  Vector3 rough = Vector3::Zero();
  double error = 0;
};

/// The line through two points; or an edge, from one to the other.
struct LineThrough {
  PlacedPoint from, to;
};

/// The signs.
class ExactSigns {
 public:
  /// Refers to the elements.
  explicit ExactSigns(const ElementTable& elements) : elements_(elements) {}

  /// Numbers below 2^-250 of their terms count as zero, which the exact sums of offsets may not be: from here
  /// on, those below 2^-2000 do.
  void use_all_digits() { all_digits_ = true; }

  PlacedPoint placed(const Sites& sites, int site, int element = ElementTable::identity) const;

  /// The sign (-1, 0, 1) of det[p q r].
  int orientation(const PlacedPoint& p, const PlacedPoint& q, const PlacedPoint& r) const;

  /// The barycentric coordinates of a point in a triangle that holds it.
  Vector3 coordinates(const std::array<PlacedPoint, 3>& corners, const PlacedPoint& point) const;

  /// Where a line crosses the edge from a to b: the share s of b, so that the point is (1 - s) a + s b.
  /// `error`: by how much it may be off.
  struct Share {
    double value = 0, error = 0;
  };
  Share share(const LineThrough& edge, const LineThrough& line) const;

  /// The sign of the difference of two such shares on one edge, first - second.
  int compare_shares(const LineThrough& edge, const LineThrough& first, const LineThrough& second) const;

 private:
  bool are_same(const PlacedPoint& p, const PlacedPoint& q) const;
  double share_with_digits(const LineThrough& edge, const LineThrough& line) const;

  const ElementTable& elements_;
  bool all_digits_ = false;
};

}  // namespace orbitutte
