// SPDX-License-Identifier: MIT
#include "orbitutte/render/ball_labels.h"

namespace orbitutte {

int order_to_show(const Embedding& embedding, std::size_t cone) {
  return embedding.seams.empty() ? 0 : embedding.cones[cone].mark.order();
}

void draw_label(Canvas& canvas, const BallLabel& label) {
  if (!label.is_visible) {
    canvas.disc(label.at, 0.9 * label.radius, ink::paper);
    canvas.ring(label.at, 0.9 * label.radius,
                {.width = 0.2 * label.radius / canvas.em(), .colour = label.colour});
  }
  if (label.order == 0 || label.radius < 0.5 * readable_radius) return;
  const double size = (label.order < 10 ? 1.25 : 0.95) * label.radius;
  const Place baseline = {label.at[0], label.at[1] + 0.36 * size};
  canvas.text(baseline, std::to_string(label.order),
              {.size = size / canvas.em(),
               .colour = label.is_visible ? ink::paper : label.colour,
               .align = Align::centre,
               .bold = true});
}

}  // namespace orbitutte
