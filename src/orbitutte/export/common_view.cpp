// SPDX-License-Identifier: MIT
#include "orbitutte/export/common_view.h"

#include <cmath>

#include "orbitutte/geometry/fitted_rotation.h"

namespace orbitutte {

Matrix3 best_turn(const Points& a, const Points& b) {
  const Points from = a.rowwise() - a.colwise().mean(), to = b.rowwise() - b.colwise().mean();
  return fitted_rotation(from, to).matrix;
}

Matrix3 turn_of_views(const Points& a, const Points& b) {
  const Matrix3 turn = best_turn(a, b);
  const double cosine = (turn.trace() - 1) / 2;
  return cosine > std::cos(0.5) ? Matrix3(Matrix3::Identity()) : turn;
}

}  // namespace orbitutte
