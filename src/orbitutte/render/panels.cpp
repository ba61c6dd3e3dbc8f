// SPDX-License-Identifier: MIT
#include "orbitutte/render/panels.h"

#include <algorithm>
#include <cmath>

#include "orbitutte/render/chart_drawing.h"
#include "orbitutte/report/charts.h"

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
      return draw_chart(canvas, box, area_histogram(values_of(Measure::area, parts.distortion())));
    case Panel::convergence:
      return draw_chart(canvas, box, convergence_chart(parts.subject().report.history));
    case Panel::sheet:
      return draw_sheet(canvas, box, parts);
  }
}

PictureSize size_of(const Box& box) {
  return {std::max(1, static_cast<int>(std::round(box.width))),
          std::max(1, static_cast<int>(std::round(box.height)))};
}

}  // namespace orbitutte
