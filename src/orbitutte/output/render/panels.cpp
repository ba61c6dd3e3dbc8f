// SPDX-License-Identifier: MIT
#include "orbitutte/output/render/panels.h"

#include <algorithm>
#include <cmath>

#include "orbitutte/output/render/plots.h"

namespace orbitutte {

void draw_panel(Panel panel, Canvas& canvas, const Box& box, PictureParts& parts) {
  switch (panel) {
    case Panel::source:
      return draw_source_panel(canvas, box, parts);
    case Panel::sphere:
      return draw_sphere_panel(canvas, box, parts);
    case Panel::area:
      return draw_area_panel(canvas, box, parts);
    case Panel::angle:
      return draw_angle_panel(canvas, box, parts);
    case Panel::checkerboard:
      return draw_checkerboard_panel(canvas, box, parts);
    case Panel::histogram:
      return draw_histogram(canvas, box, parts.distortion());
    case Panel::convergence:
      return draw_convergence(canvas, box, parts.subject().report.history);
    case Panel::sheet:
      return draw_sheet(canvas, box, parts);
  }
}

PictureSize size_of(const Box& box) {
  return {std::max(1, static_cast<int>(std::round(box.width))),
          std::max(1, static_cast<int>(std::round(box.height)))};
}

}  // namespace orbitutte
