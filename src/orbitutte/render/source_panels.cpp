// SPDX-License-Identifier: MIT
// The panels that show the source mesh.
#include <algorithm>

#include "orbitutte/render/ball_labels.h"
#include "orbitutte/render/chart_drawing.h"
#include "orbitutte/render/checkerboard.h"
#include "orbitutte/render/colour_table.h"
#include "orbitutte/render/mesh_lines.h"
#include "orbitutte/render/panels.h"
#include "orbitutte/render/sphere_figure.h"

namespace orbitutte {
namespace {

constexpr double scale_height = 4;       // ems
constexpr double median_square = 0.045;  // side on the source, whose half diagonal is 1

// Sizes of ornaments, as shares of half the picture's shorter side.
constexpr double ball_share = 0.042, largest_ball_share = 0.08, tube_share = 0.0085, candidate_share = 0.014;
constexpr Rgb candidate_colour = {64, 64, 64};

Camera source_camera(const Box& box, PictureParts& parts) {
  return fit_camera(parts.source_view(), parts.figure().positions(), size_of(box), figure_fill);
}

std::vector<int> source_of(const Embedding& embedding, const std::vector<int>& cut_vertices) {
  std::vector<int> vertices = cut_vertices;
  for (int& v : vertices) v = embedding.source_vertex[v];
  return vertices;
}

// Of the picture, in the world's unit.
double half_side_of(const Camera& camera) {
  return 0.5 * std::min(camera.size.width, camera.size.height) * camera.pixel;
}

// In the world's unit: larger than usual in small pictures, so that the number can be read.
double source_ball_radius(const Camera& camera) {
  const double half_side = half_side_of(camera);
  return std::clamp(readable_radius * camera.pixel, ball_share * half_side, largest_ball_share * half_side);
}

void add_cones(PictureParts& parts, const Camera& camera, Ornaments& ornaments) {
  const Points marked = parts.marked_positions();
  for (Eigen::Index c = 0; c < marked.rows(); ++c)
    ornaments.add_ball(marked.row(c), source_ball_radius(camera), cone_colour(static_cast<int>(c)));
}

Ornaments source_ornaments(PictureParts& parts, const Camera& camera) {
  const double half_side = half_side_of(camera);
  const Embedding& embedding = parts.embedding();
  Ornaments ornaments;
  for (std::size_t s = 0; s < embedding.seams.size(); ++s)
    ornaments.add_tube(polyline(parts.figure().positions(), source_of(embedding, embedding.seams[s].left)),
                       tube_share * half_side, seam_colour(static_cast<int>(s)));
  add_cones(parts, camera, ornaments);
  ornaments.commit();
  return ornaments;
}

// The candidates and the cones that were chosen among them; nothing if there were none.
Ornaments candidate_ornaments(PictureParts& parts, const Camera& camera) {
  const std::vector<int>& candidates = parts.subject().candidates;
  Ornaments ornaments;
  for (const int v : candidates)
    ornaments.add_ball(parts.figure().positions().row(v), candidate_share * half_side_of(camera),
                       candidate_colour);
  if (!candidates.empty()) add_cones(parts, camera, ornaments);
  ornaments.commit();
  return ornaments;
}

void draw_surface(Canvas& canvas, const Box& box, PictureParts& parts, const SurfaceColour& colour) {
  const Camera camera = source_camera(box, parts);
  canvas.image({box.x, box.y}, parts.figure().draw(camera, colour, candidate_ornaments(parts, camera)));
}

// The orders of the cones, on their balls.
void draw_orders(Canvas& canvas, const Box& box, PictureParts& parts) {
  const Camera camera = source_camera(box, parts);
  const double radius = source_ball_radius(camera);
  const Vector3 viewer = camera.axes.row(2);
  const Points marked = parts.marked_positions();
  for (Eigen::Index c = 0; c < marked.rows(); ++c) {
    const Vector3 at = camera.project(marked.row(c));
    draw_label(canvas, {.at = {box.x + at[0], box.y + at[1]},
                        .radius = radius / camera.pixel,
                        .order = order_to_show(parts.embedding(), c),
                        .colour = cone_colour(static_cast<int>(c)),
                        .is_visible = parts.figure().is_visible(marked.row(c), viewer, radius)});
  }
}

// In ems, above the scale: the sheet has a histogram of its own, and on small pictures the figure needs the
// room.
double histogram_height(const Box& box, const PictureParts& parts) {
  constexpr double smallest = 350;  // pixels, of the box
  return parts.options().panel == Panel::area && std::min(box.width, box.height) >= smallest ? 5 : 0;
}

// One colour, and the triangulation if it is coarse enough.
SurfaceColour plain_colour(const SourceFigure& figure, double pixel) {
  const float lines = line_strength(mean_edge_length(figure.positions(), figure.faces()) / pixel);
  const Colour body = linear(bold_colour);
  return [&figure, pixel, lines, body](const Hit& hit) -> Colour {
    if (lines == 0) return Colour(body);
    return body * (1 - 0.45F * lines * line_coverage(figure.positions(), figure.faces(), hit, pixel));
  };
}

}  // namespace

void draw_source_panel(Canvas& canvas, const Box& box, PictureParts& parts) {
  const Camera camera = source_camera(box, parts);
  const SourceFigure& figure = parts.figure();
  canvas.image({box.x, box.y},
               figure.draw(camera, plain_colour(figure, camera.pixel), source_ornaments(parts, camera)));
  draw_orders(canvas, box, parts);
}

void draw_area_panel(Canvas& canvas, const Box& box, PictureParts& parts) {
  const std::vector<FaceDistortion>& faces = parts.distortion();
  const std::vector<double> areas = values_of(Measure::area, faces);
  const ColourScale scale = colour_scale(Measure::area, areas);
  const ColourTable colours(scale);
  const double em = canvas.em(), bars = histogram_height(box, parts) * em,
               below = scale_height * em + bars + (bars > 0 ? em : 0);
  const Box above = box.inset(0, 0, 0, below);
  draw_surface(canvas, above, parts, [&](const Hit& hit) { return colours.of_face(faces[hit.primitive]); });
  if (!parts.subject().candidates.empty()) draw_orders(canvas, above, parts);
  const Box legend = {box.x, box.bottom() - scale_height * em, box.width, scale_height * em};
  draw_scale(canvas, legend, scale);
  const Box bar = scale_bar(canvas, legend);
  if (bars > 0) draw_bars_on_scale(canvas, {bar.x, bar.y - bars, bar.width, bars}, areas, scale);
}

void draw_angle_panel(Canvas& canvas, const Box& box, PictureParts& parts) {
  const std::vector<FaceDistortion>& faces = parts.distortion();
  const ColourScale scale = colour_scale(Measure::angle, values_of(Measure::angle, faces));
  const ColourTable colours(scale);
  const double below = scale_height * canvas.em();
  draw_surface(canvas, box.inset(0, 0, 0, below), parts,
               [&](const Hit& hit) { return colours.of_face(faces[hit.primitive]); });
  draw_scale(canvas, {box.x, box.bottom() - below, box.width, below}, scale);
}

void draw_checkerboard_panel(Canvas& canvas, const Box& box, PictureParts& parts) {
  const Embedding& embedding = parts.embedding();
  const Checkerboard board(embedding, parts.figure().positions(), tile_centre(embedding), median_square);
  const double pixel = source_camera(box, parts).pixel;
  draw_surface(canvas, box, parts, [&](const Hit& hit) { return board.colour(hit, pixel); });
}

}  // namespace orbitutte
