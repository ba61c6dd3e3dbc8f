// SPDX-License-Identifier: MIT
#include "orbitutte/verify/seam_residuals.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "orbitutte/verify/angle_sums.h"
#include "orbitutte/verify/exact_group.h"

namespace orbitutte {
namespace {

constexpr double largest_residual = 1e-12;

// What a residual may be: a share of the shortest edge nearby, and what doubles cannot resolve.
struct Tolerance {
  double share, rounding;
};

constexpr Tolerance across_seam = {1e-3, 1e-15}, on_mirror = {1e-2, 4e-15};

// The residuals of one seam's pairs.
class PairResiduals {
 public:
  // Throws ArgumentError if a position of the seam has offsets and the transform is no element of the group.
  PairResiduals(const Embedding& embedding, const ExactPositions& positions, const Seam& seam,
                std::optional<PreciseGroup<MostPrecise>>& group)
      : embedding_(embedding), positions_(positions), seam_(seam) {
    if (!is_exact_anywhere()) return;
    if (!group) group = exact_group(embedding, positions);
    element_ = group->element(seam.transform);
  }

  bool is_exact(std::size_t k) const {
    return positions_.has_offsets(seam_.left[k]) || positions_.has_offsets(seam_.right[k]);
  }

  double residual(std::size_t k) const {
    const int l = seam_.left[k], r = seam_.right[k];
    if (is_exact(k)) {
      const Vector3Of<MostPrecise> off = positions_.exact(l) - *element_ * positions_.exact(r);
      return off.cast<double>().cwiseAbs().maxCoeff();
    }
    const Vector3 left = embedding_.positions.row(l), right = embedding_.positions.row(r);
    return (left - seam_.transform * right).cwiseAbs().maxCoeff();
  }

  double bound(std::size_t k, double shortest_edge) const {
    const Tolerance& tolerance = seam_.is_mirror() ? on_mirror : across_seam;
    if (is_exact(k)) return std::min(tolerance.share * shortest_edge, largest_residual);
    const double size = rounded_size(k);
    return std::min(std::max(tolerance.share * shortest_edge, tolerance.rounding * size),
                    largest_residual * std::max(size, 1.0));
  }

 private:
  // The size of the numbers that are rounded. In the hyperbolic plane, whose coordinates grow with the
  // exponential of the distance from (0, 0, 1), the products with the transform may be larger than their
  // sums.
  double rounded_size(std::size_t k) const {
    const double left = embedding_.positions.row(seam_.left[k]).cwiseAbs().maxCoeff();
    const double right = embedding_.positions.row(seam_.right[k]).cwiseAbs().maxCoeff();
    return std::max(left, seam_.transform.matrix().cwiseAbs().maxCoeff() * right);
  }

  bool is_exact_anywhere() const {
    for (std::size_t k = 0; k < seam_.left.size(); ++k)
      if (is_exact(k)) return true;
    return false;
  }

  const Embedding& embedding_;
  const ExactPositions& positions_;
  const Seam& seam_;
  std::optional<Matrix3Of<MostPrecise>> element_;
};

std::vector<double> shortest_edges_at_seams(const Embedding& triangles, const ExactPositions& positions) {
  std::vector<char> on_seam(triangles.source_vertex.size(), 0);
  for (const Seam& seam : triangles.seams)
    for (const std::vector<int>* bank : {&seam.left, &seam.right})
      for (const int v : *bank) on_seam[v] = 1;
  return shortest_edges(triangles, positions, on_seam);
}

}  // namespace

SeamResiduals judge_seams(const Embedding& triangles, const ExactPositions& positions) {
  const std::vector<double> shortest = shortest_edges_at_seams(triangles, positions);
  SeamResiduals result;
  std::optional<PreciseGroup<MostPrecise>> group;  // as soon as a seam needs it
  double worst = -1;
  for (std::size_t s = 0; s < triangles.seams.size(); ++s) {
    const Seam& seam = triangles.seams[s];
    try {
      const PairResiduals pairs(triangles, positions, seam, group);
      for (std::size_t k = 0; k < seam.left.size(); ++k) {
        const int l = seam.left[k], r = seam.right[k];
        const double value = pairs.residual(k), bound = pairs.bound(k, std::min(shortest[l], shortest[r]));
        result.largest = std::max(result.largest, value);
        const bool fits = value <= bound;
        const double ratio = value > 0 ? value / bound : 0;
        const bool is_first_failure = !fits && result.failure.empty();
        if (!is_first_failure && !(ratio > worst)) continue;
        worst = ratio;
        result.value = value;
        result.bound = bound;
        if (!fits)
          result.failure = fmt::format(
              "the vertices {} and {} of seam {} miss each other by {:.3g}, more than "
              "{:.3g}",
              l, r, s, value, bound);
      }
    } catch (const ArgumentError& error) {
      result.value = std::numeric_limits<double>::infinity();
      result.failure = fmt::format(
          "positions of seam {} have offsets, but its transform is not known exactly: {}", s, error.what());
      return result;
    }
  }
  return result;
}

}  // namespace orbitutte
