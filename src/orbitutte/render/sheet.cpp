// SPDX-License-Identifier: MIT
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <string>
#include <vector>

#include "orbitutte/export/html_text.h"
#include "orbitutte/orbifold/symmetry_group.h"
#include "orbitutte/orbifold/target_words.h"
#include "orbitutte/render/panels.h"
#include "orbitutte/render/render.h"

namespace orbitutte {
namespace {

// What the source mesh is drawn with.
const char* source_caption(const Embedding& embedding) {
  if (embedding.target.is_polygon()) return "Source mesh and the corners of the polygon";
  return embedding.cones.empty() ? "Source mesh" : "Source mesh, marked vertices and seams";
}

std::string marked_vertices_text(const Embedding& embedding) {
  std::vector<int> marked;
  for (const ConeCopies& cone : embedding.cones) marked.push_back(cone.vertex);
  return marked.empty() ? std::string() : fmt::format("marked vertices {},  ", fmt::join(marked, ", "));
}

std::string summary(const RenderSubject& subject) {
  const Report& report = subject.report;
  return fmt::format("{} faces,  {}{},  energy {:.6g},  {}",
                     grouped_digits(subject.embedding.faces().count()),
                     marked_vertices_text(subject.embedding), group_text(subject.embedding.target),
                     report.energy, report.bijective ? "certified bijective" : "not certified");
}

// Returns what remains below.
Box draw_headline(Canvas& canvas, const Box& box, const RenderSubject& subject) {
  const double em = canvas.em();
  canvas.text({box.x, box.y + 1.6 * em}, fmt::format("{}  onto  {}", subject.title, subject.report.signature),
              {.size = 1.7, .bold = true});
  canvas.text({box.x, box.y + 3.5 * em}, summary(subject), {.colour = ink::quiet});
  return box.inset(0, 5 * em, 0, 0);
}

struct Captioned {
  Panel panel;
  std::string caption;
};

void draw_captioned(Canvas& canvas, const Box& box, PictureParts& parts, const Captioned& what) {
  const double em = canvas.em();
  draw_panel(what.panel, canvas, box.inset(0, 0, 0, 2 * em), parts);
  canvas.text({box.x + 0.5 * box.width, box.bottom() - 0.4 * em}, what.caption,
              {.align = Align::centre, .bold = true});
}

}  // namespace

std::string tile_caption(const Embedding& embedding) {
  if (embedding.seams.empty()) return "Its image on the sphere";
  const std::string where = drawn_in(embedding.space());
  const bool are_all = embedding.target.group_order > 0;
  const char* copies = !tiles_its_space(embedding.target) ? ""
                       : are_all                          ? ", and the copies"
                                                          : ", and copies";
  return fmt::format("Its tile {}{}", where, copies);
}

void draw_sheet(Canvas& canvas, const Box& box, PictureParts& parts) {
  const double gap = 1.5 * canvas.em();
  const Box body = draw_headline(canvas, box, parts.subject());
  const double width = (body.width - 2 * gap) / 3, height = (body.height - gap) / 2;
  const auto cell = [&](int column, int row) {
    return Box{body.x + column * (width + gap), body.y + row * (height + gap), width, height};
  };
  draw_captioned(canvas, cell(0, 0), parts, {Panel::source, source_caption(parts.embedding())});
  draw_captioned(canvas, cell(1, 0), parts, {Panel::sphere, tile_caption(parts.embedding())});
  draw_captioned(canvas, cell(2, 0), parts, {Panel::checkerboard, "Checkerboard through the map"});
  draw_captioned(canvas, cell(0, 1), parts, {Panel::area, "Area distortion"});
  draw_captioned(canvas, cell(1, 1), parts, {Panel::angle, "Angle distortion"});
  const Box plots = cell(2, 1), upper = plots.inset(0, 0, 0, 0.5 * height),
            lower = plots.inset(0, 0.5 * height, 0, 0);
  draw_captioned(canvas, upper, parts, {Panel::histogram, "Faces by area distortion"});
  draw_captioned(canvas, lower, parts, {Panel::convergence, "Convergence"});
}

}  // namespace orbitutte
