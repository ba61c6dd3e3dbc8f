// SPDX-License-Identifier: MIT
#include "orbitutte/report/comparison.h"

#include <fmt/format.h>

#include "orbitutte/io/file.h"
#include "orbitutte/render/chart_drawing.h"
#include "orbitutte/render/colour_table.h"
#include "orbitutte/render/default_view.h"
#include "orbitutte/render/render.h"
#include "orbitutte/report/charts.h"

namespace orbitutte {
namespace {

// In pixels: a column for each map, and its rows from the top.
constexpr double picture_em = 24, column = 900, title_row = 4.4 * picture_em, figure_row = 640,
                 scale_row = 4.5 * picture_em, histogram_row = 500;

// What the maps have in common.
struct Common {
  std::vector<std::vector<double>> areas;  // log2 A, by map
  HistogramAxes axes;
  ColourScale area_scale, angle_scale;
};

ColourScale common_scale(Measure measure, const std::vector<std::vector<double>>& values) {
  ColourScale scale = common_colour_scale(measure, values);
  scale.axis.title += "    (the same colours for all maps)";
  return scale;
}

Common common_of(const std::vector<ComparedMap>& maps) {
  std::vector<std::vector<double>> areas, angles;
  for (const ComparedMap& map : maps) {
    areas.push_back(values_of(Measure::area, map.faces));
    angles.push_back(values_of(Measure::angle, map.faces));
  }
  const HistogramAxes axes = histogram_axes(areas);
  const ColourScale area_scale = common_scale(Measure::area, areas);
  return {std::move(areas), axes, area_scale, common_scale(Measure::angle, angles)};
}

PictureFormat format_of(const std::string& path) {
  const std::string ending = ending_of(path);
  if (ending == ".png") return PictureFormat::png;
  if (ending == ".svg") return PictureFormat::svg;
  throw ArgumentError(fmt::format("{}: a comparison is written as .png or .svg", path));
}

// A row's box in the k-th column.
Box cell(std::size_t k, double top, double height) {
  return {static_cast<double>(k) * column, top, column, height};
}

void draw_title(Canvas& canvas, const Box& box, const ComparedMap& map) {
  const double middle = box.x + 0.5 * box.width;
  canvas.text({middle, box.y + 2.2 * picture_em}, map.title,
              {.size = 1.3, .align = Align::centre, .bold = true});
  canvas.text({middle, box.y + 3.9 * picture_em},
              fmt::format("max(A, 1/A):   mean {:.4g},   median {:.4g},   max {:.4g}", map.area.mean,
                          map.area.median, map.area.max),
              {.size = 0.9, .colour = ink::quiet, .align = Align::centre});
}

View view_of(const Comparison& comparison, const SourceFigure& figure) {
  const Vector3 up = comparison.up ? *comparison.up : default_up_direction(comparison.surface);
  return comparison.view ? View{*comparison.view, up}
                         : default_view(figure, polyline(figure.positions(), comparison.cones), up);
}

// The same view of the mesh for every map, and one scale.
void draw_figures(Canvas& canvas, double top, const Comparison& comparison, const ColourScale& scale) {
  const SourceFigure figure(comparison.surface.V, comparison.surface.triangles);
  const Box box = cell(0, top, figure_row).inset(2 * picture_em, 0, 2 * picture_em, 0);
  const Camera camera = fit_camera(view_of(comparison, figure), figure.positions(),
                                   {static_cast<int>(box.width), static_cast<int>(box.height)}, 0.95);
  Ornaments none;
  none.commit();
  const ColourTable colours(scale);
  for (std::size_t k = 0; k < comparison.maps.size(); ++k) {
    const std::vector<FaceDistortion>& faces = comparison.maps[k].faces;
    const auto colour = [&](const Hit& hit) { return colours.of_face(faces[hit.primitive]); };
    canvas.image({box.x + static_cast<double>(k) * column, top}, figure.draw(camera, colour, none));
  }
  draw_scale(canvas, {0, top + figure_row, canvas.size().width * 1.0, scale_row}, scale);
}

}  // namespace

void write_comparison(const std::string& path, const Comparison& comparison) {
  const PictureFormat format = format_of(path);
  const Common common = common_of(comparison.maps);
  constexpr double figures_row = figure_row + scale_row;  // with their scale
  const double plots_top = title_row + (format == PictureFormat::png ? 2 * figures_row : 0);
  Canvas canvas(format,
                {static_cast<int>(column * static_cast<double>(comparison.maps.size())),
                 static_cast<int>(plots_top + histogram_row)},
                picture_em);
  if (format == PictureFormat::png) {
    draw_figures(canvas, title_row, comparison, common.area_scale);
    draw_figures(canvas, title_row + figures_row, comparison, common.angle_scale);
  }
  for (std::size_t k = 0; k < comparison.maps.size(); ++k) {
    draw_title(canvas, cell(k, 0, title_row), comparison.maps[k]);
    draw_chart(canvas, cell(k, plots_top, histogram_row).inset(picture_em, 0, picture_em, picture_em),
               area_histogram(common.areas[k], common.axes));
  }
  write_file(path, canvas.finish());
}

}  // namespace orbitutte
