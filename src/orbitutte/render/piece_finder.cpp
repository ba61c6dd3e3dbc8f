// SPDX-License-Identifier: MIT
#include "orbitutte/render/piece_finder.h"

#include <Eigen/Geometry>
#include <limits>
#include <numeric>

namespace orbitutte {
namespace {

double determinant(const Vector3& a, const Vector3& b, const Vector3& c) { return a.dot(b.cross(c)); }

}  // namespace

PieceFinder::PieceFinder(const Overlay& overlay, const OverlayPieces& pieces, const Embedding& a)
    : start_(static_cast<std::size_t>(a.triangles.rows()) + 1, 0),
      pieces_(static_cast<std::size_t>(pieces.count())),
      corners_(static_cast<std::size_t>(pieces.count())) {
  for (const int t : pieces.on_a) ++start_[t + 1];
  std::partial_sum(start_.begin(), start_.end(), start_.begin());
  std::vector<int> next(start_.begin(), start_.end() - 1);
  for (int p = 0; p < pieces.count(); ++p) {
    pieces_[next[pieces.on_a[p]]++] = p;
    for (int k = 0; k < 3; ++k)
      corners_[p][k] = coordinates_in(a, overlay.on_a, pieces.triangles(p, k), pieces.on_a[p]);
  }
}

PiecePoint PieceFinder::find(int triangle, const Vector3& coordinates) const {
  PiecePoint best;
  double deepest = -std::numeric_limits<double>::infinity();
  for (int at = start_[triangle]; at < start_[triangle + 1]; ++at) {
    const auto& [a, b, c] = corners_[pieces_[at]];
    const double all = determinant(a, b, c);
    if (all == 0) continue;
    const Vector3 weights = Vector3(determinant(coordinates, b, c), determinant(a, coordinates, c),
                                    determinant(a, b, coordinates)) /
                            all;
    if (weights.minCoeff() <= deepest) continue;
    deepest = weights.minCoeff();
    best = {pieces_[at], weights};
  }
  if (best.piece >= 0) {
    best.weights = best.weights.cwiseMax(0);
    best.weights /= best.weights.sum();
  }
  return best;
}

}  // namespace orbitutte
