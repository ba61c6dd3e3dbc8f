// SPDX-License-Identifier: MIT
#include "orbitutte/render/map_sheet.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "orbitutte/export/common_view.h"
#include "orbitutte/export/html_text.h"
#include "orbitutte/export/overlay_pieces.h"
#include "orbitutte/io/file.h"
#include "orbitutte/render/ball_labels.h"
#include "orbitutte/render/chart_drawing.h"
#include "orbitutte/render/colour_table.h"
#include "orbitutte/render/default_view.h"
#include "orbitutte/render/panels.h"
#include "orbitutte/render/piece_finder.h"
#include "orbitutte/render/render.h"
#include "orbitutte/report/overlay_distortion.h"

namespace orbitutte {
namespace {

constexpr double height_of_sheet = 1840.0 / 2400, em_of_sheet = 1.0 / 96;  // of its width
constexpr double sheet_scale_height = 4;                                   // ems
constexpr double landmark_share = 0.042;  // of half the picture's shorter side
constexpr double cube_side = 0.14;        // where the surface's half diagonal is 1

// Which of the two surfaces a panel shows.
enum class Shown { a, b };

Triangles faces_on_source(const Embedding& embedding) {
  Triangles faces = embedding.triangles;
  for (int& v : faces.reshaped()) v = embedding.source_vertex[v];
  return faces;
}

Colour checkered(const Vector3& at) {
  constexpr double shift = 0.37;  // flat faces at round numbers shall not lie between cubes
  int sum = 0;
  for (int k = 0; k < 3; ++k) sum += static_cast<int>(std::floor(at[k] / cube_side + shift));
  return linear(sum % 2 == 0 ? bold_colour : ink::figure);
}

Colour of_srgb(const Vector3& channels) {
  const auto byte = [&](int k) {
    return static_cast<std::uint8_t>(std::lround(255 * std::clamp(channels[k], 0.0, 1.0)));
  };
  return linear({byte(0), byte(1), byte(2)});
}

Vector3 on_corners(const Points& values, const Triangles& triangles, int t, const Vector3& weights) {
  return weights[0] * values.row(triangles(t, 0)) + weights[1] * values.row(triangles(t, 1)) +
         weights[2] * values.row(triangles(t, 2));
}

Vector3 weights_of(const Hit& hit) { return {1.0 - hit.u - hit.v, hit.u, hit.v}; }

// Everything that panels share.
class SheetParts {
 public:
  explicit SheetParts(const MapSheet& sheet)
      : sheet_(sheet),
        figure_a_(sheet.a.V, faces_on_source(sheet.map.a.embedding)),
        figure_b_(sheet.b.V, faces_on_source(sheet.map.b.embedding)),
        pieces_(overlay_pieces(sheet.composed.overlay)),
        finder_(sheet.composed.overlay, pieces_, sheet.map.a.embedding),
        on_b_(positions_on(figure_b_.positions(), sheet.map.b.embedding, sheet.composed.overlay.on_b)),
        colours_of_b_(shown_colours(sheet.b)),
        colours_(positions_on(colours_of_b_, sheet.map.b.embedding, sheet.composed.overlay.on_b)),
        distortion_(
            piece_distortions(pieces_.triangles, sheet.composed.overlay_on_a, sheet.composed.overlay_on_b)) {
    const Vector3 up = sheet.up ? *sheet.up : default_up_direction(sheet.a);
    view_a_ = sheet.view ? View{sheet.view->normalized(), up} : default_view(figure_a_, marked(Shown::a), up);
    const Matrix3 rotation = turn_of_views(sheet.composed.overlay_on_a, sheet.composed.overlay_on_b);
    view_b_ = {rotation * view_a_.viewer, rotation * view_a_.up};
  }

  const MapSheet& sheet() const { return sheet_; }
  const std::vector<PieceDistortion>& distortion() const { return distortion_; }

  // The landmarks on the figure of A or of B.
  Points marked(Shown on) const {
    std::vector<int> vertices;
    vertices.reserve(sheet_.map.landmarks.size());
    for (const Landmark& landmark : sheet_.map.landmarks)
      vertices.push_back(on == Shown::a ? landmark.a : landmark.b);
    return polyline(figure(on).positions(), vertices);
  }

  const SourceFigure& figure(Shown of) const { return of == Shown::a ? figure_a_ : figure_b_; }
  const View& view(Shown of) const { return of == Shown::a ? view_a_ : view_b_; }

  // Colours of hits.

  Colour b_in_colours(const Hit& hit) const {
    return of_srgb(on_corners(colours_of_b_, figure_b_.faces(), hit.primitive, weights_of(hit)));
  }
  Colour b_in_checkers(const Hit& hit) const {
    return checkered(on_corners(figure_b_.positions(), figure_b_.faces(), hit.primitive, weights_of(hit)));
  }
  Colour a_in_colours(const Hit& hit) const {
    const PiecePoint at = finder_.find(hit.primitive, weights_of(hit));
    return at.piece < 0 ? linear(ink::unmeasured)
                        : of_srgb(on_corners(colours_, pieces_.triangles, at.piece, at.weights));
  }
  Colour a_in_checkers(const Hit& hit) const {
    const PiecePoint at = finder_.find(hit.primitive, weights_of(hit));
    return at.piece < 0 ? linear(ink::unmeasured)
                        : checkered(on_corners(on_b_, pieces_.triangles, at.piece, at.weights));
  }
  // The colour of what `value` takes from the distortion there; grey if that is not a finite number.
  template <typename Value>
  Colour a_on_scale(const Hit& hit, const ColourTable& colours, const Value& value) const {
    const PiecePoint at = finder_.find(hit.primitive, weights_of(hit));
    const double number = at.piece < 0 ? NAN : value(distortion_[at.piece]);
    return colours.at(std::isfinite(number) ? number : NAN);
  }

 private:
  const MapSheet& sheet_;
  SourceFigure figure_a_, figure_b_;
  OverlayPieces pieces_;
  PieceFinder finder_;
  Points on_b_, colours_of_b_, colours_;
  std::vector<PieceDistortion> distortion_;
  View view_a_, view_b_;
};

Ornaments landmark_balls(const Points& marked, double radius) {
  Ornaments balls;
  for (Eigen::Index k = 0; k < marked.rows(); ++k)
    balls.add_ball(marked.row(k), radius, cone_colour(static_cast<int>(k)));
  balls.commit();
  return balls;
}

// One surface with its landmarks, which are numbered from 1.
void draw_side(Canvas& canvas, const Box& box, const SheetParts& parts, Shown of,
               const SurfaceColour& colour) {
  const SourceFigure& figure = parts.figure(of);
  const Camera camera = fit_camera(parts.view(of), figure.positions(), size_of(box), figure_fill);
  const double radius = landmark_share * 0.5 * std::min(camera.size.width, camera.size.height) * camera.pixel;
  const Points marked = parts.marked(of);
  canvas.image({box.x, box.y}, figure.draw(camera, colour, landmark_balls(marked, radius)));
  for (Eigen::Index k = 0; k < marked.rows(); ++k) {
    const Vector3 at = camera.project(marked.row(k)), viewer = camera.axes.row(2);
    draw_label(canvas, {.at = {box.x + at[0], box.y + at[1]},
                        .radius = radius / camera.pixel,
                        .order = static_cast<int>(k) + 1,
                        .colour = cone_colour(static_cast<int>(k)),
                        .is_visible = figure.is_visible(marked.row(k), viewer, radius)});
  }
}

template <typename Value>
void draw_measure(Canvas& canvas, const Box& box, const SheetParts& parts, const ColourScale& scale,
                  const Value& value) {
  const ColourTable colours(scale);
  const double below = sheet_scale_height * canvas.em();
  draw_side(canvas, box.inset(0, 0, 0, below), parts, Shown::a,
            [&](const Hit& hit) { return parts.a_on_scale(hit, colours, value); });
  draw_scale(canvas, {box.x, box.bottom() - below, box.width, below}, scale);
}

std::string map_summary(const MapSheet& sheet) {
  const MapDistortion& distortion = sheet.composed.distortion;
  const bool certified = sheet.map.is_bijective() && sheet.composed.certificate.holds;
  return fmt::format(
      "{} landmarks, onto {};  overlay of {} faces;  symmetric Dirichlet energy: median {:.3g}, 90 % below "
      "{:.3g};  area within a factor of 4 on {:.1f} %;  {}",
      sheet.map.landmarks.size(), sheet.map.target().signature,
      grouped_digits(sheet.composed.overlay.face_count()), distortion.symmetric_dirichlet.median,
      distortion.symmetric_dirichlet.percentile_90, 100 * distortion.within_4,
      certified ? "certified bijective" : "not certified");
}

void draw_map_caption(Canvas& canvas, const Box& box, const std::string& text) {
  canvas.text({box.x + 0.5 * box.width, box.bottom() - 0.4 * canvas.em()}, text,
              {.align = Align::centre, .bold = true});
}

void draw_map_panels(Canvas& canvas, const Box& body, const SheetParts& parts) {
  const double gap = 1.5 * canvas.em();
  const double width = (body.width - 2 * gap) / 3, height = (body.height - gap) / 2;
  // Draws the caption of a panel and returns the box above.
  const auto cell = [&](int column, int row, const std::string& caption) {
    const Box box = {body.x + column * (width + gap), body.y + row * (height + gap), width, height};
    draw_map_caption(canvas, box, caption);
    return box.inset(0, 0, 0, 2 * canvas.em());
  };
  const bool has_colours = parts.sheet().b.colours.rows() > 0;
  draw_side(canvas, cell(0, 0, has_colours ? "B, in its colours" : "B, coloured by position"), parts,
            Shown::b, [&](const Hit& hit) { return parts.b_in_colours(hit); });
  draw_side(canvas, cell(1, 0, "A, in the colours of B"), parts, Shown::a,
            [&](const Hit& hit) { return parts.a_in_colours(hit); });
  draw_side(canvas, cell(0, 1, "B, in a checkerboard of cubes"), parts, Shown::b,
            [&](const Hit& hit) { return parts.b_in_checkers(hit); });
  draw_side(canvas, cell(1, 1, "A, in the checkerboard of B"), parts, Shown::a,
            [&](const Hit& hit) { return parts.a_in_checkers(hit); });
  draw_measure(canvas, cell(2, 0, "A: how areas change"), parts,
               map_area_scale(piece_log_areas(parts.distortion())),
               [](const PieceDistortion& piece) { return std::log2(piece.area); });
  draw_measure(canvas, cell(2, 1, "A: how shapes change"), parts,
               map_energy_scale(piece_energies(parts.distortion())),
               [](const PieceDistortion& piece) { return piece.symmetric_dirichlet; });
}

}  // namespace

std::string map_sheet_png(const MapSheet& sheet) {
  if (sheet.width < 300 || sheet.width > 10000)
    throw ArgumentError(fmt::format("a sheet {} pixels wide; it may have 300 to 10000", sheet.width));
  const PictureSize size = {sheet.width, static_cast<int>(std::lround(height_of_sheet * sheet.width))};
  Canvas canvas(PictureFormat::png, size, em_of_sheet * size.width);
  const double em = canvas.em();
  const SheetParts parts(sheet);
  const Box whole = {0, 0, size.width * 1.0, size.height * 1.0};
  const Box page = whole.inset(1.5 * em, 1.5 * em, 1.5 * em, 1.5 * em);
  canvas.text({page.x, page.y + 1.6 * em},
              fmt::format("A: {}   to   B: {}", sheet.name_of_a, sheet.name_of_b),
              {.size = 1.7, .bold = true});
  canvas.text({page.x, page.y + 3.5 * em}, map_summary(sheet), {.colour = ink::quiet});
  draw_map_panels(canvas, page.inset(0, 5 * em, 0, 0), parts);
  return canvas.finish();
}

void write_map_sheet(const std::string& path, const MapSheet& sheet) {
  if (ending_of(path) != ".png")
    throw ArgumentError(fmt::format("{}: the pictures of a map are written as .png", path));
  write_file(path, map_sheet_png(sheet));
}

}  // namespace orbitutte
