// SPDX-License-Identifier: MIT
#include "orbitutte/render/panels.h"

#include <algorithm>
#include <cmath>

#include "orbitutte/render/area_histogram.h"
#include "orbitutte/render/convergence.h"

namespace orbitutte {

namespace {

void draw_histogram_panel(Canvas& canvas, const Box& box, PictureParts& parts) {
  const std::vector<double> areas = log_areas(parts.distortion());
  const HistogramAxes axes = histogram_axes({areas});
  draw_histogram(canvas, box, areas, axes);
  draw_centres(canvas, box, areas, axes);
}

}  // namespace

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
      return draw_histogram_panel(canvas, box, parts);
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
