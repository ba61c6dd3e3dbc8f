// SPDX-License-Identifier: MIT
// By what choices of cones are compared, and from which vertices they are made.
#pragma once

#include <vector>

#include "orbitutte/names.h"
#include "orbitutte/orbifold/target.h"

namespace orbitutte {

/// What makes a choice better than another.
enum class Objective {
  /// The standard deviation of the logarithm of the scale.
  sigma,
  /// The mean of the symmetric Dirichlet energy: extreme shrinking counts most.
  symmetric_dirichlet,
  /// The ratio of the largest scale to the smallest.
  range
};

/// Its names.
template <>
struct NameTable<Objective> {
  static constexpr NamedValue<Objective> rows[] = {{Objective::sigma, "sigma"},
                                                   {Objective::symmetric_dirichlet, "symmetric-dirichlet"},
                                                   {Objective::range, "range"}};
};

/// What the choices are compared by. u is the logarithm of the scale of lengths, both areas being one.
struct ScaleSummary {
  /// The standard deviation of u over the surface.
  double sigma = 0;

  /// (1 + the mean of exp(-2 u))/2, the mean of the symmetric Dirichlet energy of a conformal map.
  double symmetric_dirichlet = 0;

  /// The greatest u less the least, in bits: log2 of how far scales differ.
  double range = 0;

  /// The shares of the surface with 1/4 <= exp(2 u) <= 4 and with exp(2 u) < 1/64.
  double within_4 = 0, below_64 = 0;

  /// log of the shortest length of a triangle's image.
  double log_least_length = 0;
};

/// Vertices of a surface that may be marked, by where they lie.
struct Candidates {
  std::vector<int> inside, on_boundary;

  const std::vector<int>& of(const Target& target, int mark) const {
    return mark < target.inner_marks ? inside : on_boundary;
  }
};

}  // namespace orbitutte
