// SPDX-License-Identifier: MIT
// The orders of marked vertices, written on their balls.
#pragma once

#include "orbitutte/orbifold/embedding.h"
#include "orbitutte/render/canvas.h"

namespace orbitutte {

struct BallLabel {
  /// The ball's middle.
  Place at;
  /// In pixels.
  double radius = 0;
  /// 0: no number.
  int order = 1;
  Rgb colour;
  /// If the ball is behind the figure, an open circle stands for it.
  bool is_visible = true;
};

/// Balls of this radius, in pixels, are large enough for their numbers to be read.
constexpr double readable_radius = 7;

/// The order of a marked vertex; 0 for the corners of a polygon, and for angles that belong to no order.
int order_to_show(const Embedding& embedding, std::size_t cone);

/// A ball that is too small for its number to be read gets none.
void draw_label(Canvas& canvas, const BallLabel& label);

}  // namespace orbitutte
