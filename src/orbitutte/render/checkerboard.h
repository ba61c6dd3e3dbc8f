// SPDX-License-Identifier: MIT
// A checkerboard through the map (figure 14): angles that the map keeps leave its squares right-angled.
#pragma once

#include <vector>

#include "orbitutte/orbifold/embedding.h"
#include "orbitutte/render/source_figure.h"

namespace orbitutte {

class Checkerboard {
 public:
  /// The tile in the conformal picture around its centre (Space::conformal), and a board of squares whose
  /// median side, over the source's area, is `side` on the source.
  Checkerboard(const Embedding& embedding, const Points& source, const Vector3& centre, double side);

  /// Dark, light, or their mean if squares are smaller than pixels.
  Colour colour(const Hit& hit, double pixel) const;

  /// n_cut x 2: the stereographic coordinates, in squares.
  const Eigen::Matrix<double, Eigen::Dynamic, 2, Eigen::RowMajor>& coordinates() const {
    return coordinates_;
  }

 private:
  Eigen::Matrix<double, Eigen::Dynamic, 2, Eigen::RowMajor> coordinates_;
  Triangles faces_;
  double side_;
  /// m: of a square, by the face that it lies in.
  std::vector<float> side_on_source_;
};

/// For every face, the side that a square of side 1 in the plane has on the source; infinite if the image
/// has no area. plane: n_cut x 2; source: n x 3, by source vertex.
std::vector<float> sides_on_source(const Embedding& embedding, const Points& source,
                                   const Eigen::Matrix<double, Eigen::Dynamic, 2, Eigen::RowMajor>& plane);

}  // namespace orbitutte
