// SPDX-License-Identifier: MIT
// The orders of marked vertices, written on their balls.
#pragma once

#include "orbitutte/output/render/canvas.h"

namespace orbitutte {

struct BallLabel {
  Place at;           ///< the ball's middle
  double radius = 0;  ///< in pixels
  int order = 1;
  Rgb colour;
  bool is_visible = true;  ///< where the ball is behind the figure, an open circle stands for it
};

void draw_label(Canvas& canvas, const BallLabel& label);

}  // namespace orbitutte
