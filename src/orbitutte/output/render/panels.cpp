// SPDX-License-Identifier: MIT
#include "orbitutte/output/render/panels.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>

#include "orbitutte/output/render/checkerboard.h"
#include "orbitutte/output/render/default_view.h"
#include "orbitutte/output/render/mesh_lines.h"
#include "orbitutte/output/render/plots.h"
#include "orbitutte/output/render/source_figure.h"
#include "orbitutte/output/render/sphere_figure.h"

namespace orbitutte {
namespace {

constexpr double figure_fill = 0.9;      // of the picture's width or height
constexpr double median_square = 0.045;  // side on the source, whose half diagonal is 1

// The embedding's faces on the vertices of the source: those of the mesh, some turned over on projective
// planes.
Faces source_faces(const Embedding& embedding) {
  Faces faces = embedding.faces;
  for (int& v : faces.reshaped()) v = embedding.source_vertex[v];
  return faces;
}

Points marked_positions(const SourceFigure& figure, const Embedding& embedding) {
  std::vector<int> vertices;
  for (const ConeCopies& cone : embedding.cones) vertices.push_back(cone.vertex);
  return polyline(figure.positions(), vertices);
}

std::vector<int> source_of(const Embedding& embedding, const std::vector<int>& cut_vertices) {
  std::vector<int> vertices;
  for (const int v : cut_vertices) vertices.push_back(embedding.source_vertex[v]);
  return vertices;
}

PictureSize pixels(const Box& box) {
  return {std::max(1, static_cast<int>(std::round(box.width))),
          std::max(1, static_cast<int>(std::round(box.height)))};
}

// How bright the source is at every cut vertex under a light above the viewer, without shadows, 0 .. 1.
std::vector<float> relief(const SourceFigure& figure, const Embedding& embedding, const View& view) {
  const Vector3f light =
      (view_axes(view).transpose() * Vector3(-0.35, 0.75, 0.55).normalized()).cast<float>();
  std::vector<float> sum(figure.positions().rows(), 0), count(figure.positions().rows(), 0);
  for (Eigen::Index c = 0; c < figure.faces().size(); ++c) {
    const int v = figure.faces().data()[c];
    sum[v] += 0.5F + 0.5F * figure.normals().row(c).dot(light.transpose());
    count[v] += 1;
  }
  std::vector<float> result;
  for (const int v : embedding.source_vertex) result.push_back(count[v] > 0 ? sum[v] / count[v] : 1);
  return result;
}

// 86482 as 86,482.
std::string with_commas(long long number) {
  std::string text = std::to_string(number);
  for (int at = static_cast<int>(text.size()) - 3; at > 0; at -= 3) text.insert(at, 1, ',');
  return text;
}

// A ball's number. Where the ball is behind the figure, an open circle stands for it.
struct BallLabel {
  Vector3 centre;
  int order = 1;
  Rgb colour;
  bool is_visible = true;
};

void draw_label(Canvas& canvas, const Place& at, double radius, const BallLabel& label) {
  const double size = 1.25 * radius / canvas.em();
  const Place baseline = {at[0], at[1] + 0.36 * size * canvas.em()};
  if (label.is_visible) {
    canvas.text(baseline, std::to_string(label.order),
                {.size = size, .colour = ink::paper, .align = Align::centre, .bold = true});
    return;
  }
  canvas.disc(at, 0.9 * radius, ink::paper);
  canvas.ring(at, 0.9 * radius, {.width = 0.2 * radius / canvas.em(), .colour = label.colour});
  canvas.text(baseline, std::to_string(label.order),
              {.size = size, .colour = label.colour, .align = Align::centre, .bold = true});
}

Colour with_lines(const Colour& colour, const SourceFigure& figure, const Hit& hit, double pixel) {
  return colour * (1 - 0.45F * line_coverage(figure.positions(), figure.faces(), hit, pixel));
}

}  // namespace

// Each part is made when a panel first asks for it.
struct PanelPainter::Parts {
  const RenderSubject& subject;
  const RenderOptions& options;
  std::optional<SourceFigure> source_figure;
  std::optional<View> source_view;
  std::optional<std::vector<FaceDistortion>> faces;

  const SourceFigure& figure() {
    if (!source_figure) source_figure.emplace(subject.mesh.V, source_faces(subject.embedding));
    return *source_figure;
  }

  const View& view() {
    if (source_view) return *source_view;
    const Vector3 up = options.up ? *options.up : default_up(subject.mesh);
    source_view = options.view ? View{options.view->normalized(), up}
                               : default_view(figure(), marked_positions(figure(), subject.embedding), up);
    return *source_view;
  }

  const std::vector<FaceDistortion>& distortion() {
    if (!faces) faces = measure_faces(subject.mesh, subject.embedding);
    return *faces;
  }

  Camera camera(const Box& box) { return fit_camera(view(), figure().positions(), pixels(box), figure_fill); }

  void draw_surface(Canvas& canvas, const Box& box, const std::function<Colour(const Hit&, double)>& colour) {
    const Camera to = camera(box);
    Ornaments none;
    none.commit();
    canvas.image({box.x, box.y}, figure().draw(
                                     to, [&](const Hit& hit) { return colour(hit, to.pixel); }, none));
  }

  void draw_source(Canvas& canvas, const Box& box) {
    const Camera to = camera(box);
    const double reach = 0.5 * std::min(to.size.width, to.size.height) * to.pixel;
    const double ball = 0.042 * reach, tube = 0.0085 * reach;
    const Embedding& embedding = subject.embedding;
    Ornaments ornaments;
    for (std::size_t s = 0; s < embedding.seams.size(); ++s)
      ornaments.add_tube(polyline(figure().positions(), source_of(embedding, embedding.seams[s].left)), tube,
                         seam_colour(static_cast<int>(s)));
    const Points marked = marked_positions(figure(), embedding);
    for (Eigen::Index c = 0; c < marked.rows(); ++c)
      ornaments.add_ball(marked.row(c), ball, cone_colour(static_cast<int>(c)));
    ornaments.commit();
    const float lines = line_strength(mean_edge_length(figure().positions(), figure().faces()) / to.pixel);
    const Colour body = linear(bold_colour);
    const auto colour = [&](const Hit& hit) {
      return lines > 0 ? mix(body, with_lines(body, figure(), hit, to.pixel), lines) : body;
    };
    canvas.image({box.x, box.y}, figure().draw(to, colour, ornaments));
    for (Eigen::Index c = 0; c < marked.rows(); ++c) {
      const Vector3 at = to.project(marked.row(c).transpose() + ball * to.axes.row(2).transpose());
      draw_label(canvas, {box.x + at[0], box.y + at[1]}, ball / to.pixel,
                 {marked.row(c), embedding.cones[c].order, cone_colour(static_cast<int>(c)),
                  figure().is_visible(marked.row(c), view().viewer, ball)});
    }
  }

  // The tile in the middle, a little from above and from the right, the sphere's axis upright.
  View sphere_view(const Vector3& centre) const {
    if (options.view && options.panel == Panel::sphere)
      return {*options.view, options.up.value_or(Vector3::UnitZ())};
    const Matrix3 axes = view_axes({centre, Vector3::UnitZ()});
    const double tilt = std::min(0.16 * std::sqrt(4 * std::numbers::pi / subject.embedding.group_order), 0.3);
    return {(centre + tilt * (axes.row(0) + axes.row(1)).transpose()).normalized(), Vector3::UnitZ()};
  }

  void draw_sphere(Canvas& canvas, const Box& box) {
    const Embedding& embedding = subject.embedding;
    const SphereFigure sphere(embedding, relief(figure(), embedding, view()));
    const View from = sphere_view(sphere.centre());
    const Camera to = fit_camera(from, sphere_extent(), pixels(box), figure_fill);
    Camera whole = to;
    whole.centre.setZero();
    whole.pixel = 2 / (figure_fill * std::min(to.size.width, to.size.height));
    canvas.image({box.x, box.y}, sphere.draw(whole, sphere_ornaments(embedding, sphere.copies())));
    const double ball = ball_radius(embedding.group_order);
    for (std::size_t c = 0; c < embedding.cones.size(); ++c)
      for (const int v : embedding.cones[c].copies) {
        const Vector3 p = embedding.positions.row(v);
        if (p.dot(whole.axes.row(2)) < 0.1) continue;
        const Vector3 at = whole.project(p);
        draw_label(canvas, {box.x + at[0], box.y + at[1]}, ball / whole.pixel,
                   {p, embedding.cones[c].order, cone_colour(static_cast<int>(c)), true});
      }
  }

  void draw_area(Canvas& canvas, const Box& box) {
    const AreaScale scale = area_scale(distortion());
    const double legend = 4 * canvas.em();
    draw_surface(canvas, box.inset(0, 0, 0, legend),
                 [&](const Hit& hit, double) { return scale.colour(distortion()[hit.primitive]); });
    draw_scale(canvas, {box.x, box.bottom() - legend, box.width, legend}, scale);
  }

  void draw_angle(Canvas& canvas, const Box& box) {
    const AngleScale scale = angle_scale(distortion());
    const double legend = 4 * canvas.em();
    draw_surface(canvas, box.inset(0, 0, 0, legend),
                 [&](const Hit& hit, double) { return scale.colour(distortion()[hit.primitive]); });
    draw_scale(canvas, {box.x, box.bottom() - legend, box.width, legend}, scale);
  }

  void draw_checkerboard(Canvas& canvas, const Box& box) {
    const SphereFigure sphere(subject.embedding,
                              std::vector<float>(subject.embedding.source_vertex.size(), 1));
    const Checkerboard board(subject.embedding, figure().positions(), sphere.centre(), median_square);
    draw_surface(canvas, box, [&](const Hit& hit, double pixel) { return board.colour(hit, pixel); });
  }
};

PanelPainter::PanelPainter(const RenderSubject& subject, const RenderOptions& options)
    : parts_(new Parts{subject, options, {}, {}, {}}) {}

PanelPainter::~PanelPainter() = default;

void PanelPainter::draw(Panel panel, Canvas& canvas, const Box& box) {
  switch (panel) {
    case Panel::source:
      return parts_->draw_source(canvas, box);
    case Panel::sphere:
      return parts_->draw_sphere(canvas, box);
    case Panel::area:
      return parts_->draw_area(canvas, box);
    case Panel::angle:
      return parts_->draw_angle(canvas, box);
    case Panel::checkerboard:
      return parts_->draw_checkerboard(canvas, box);
    case Panel::histogram:
      return draw_histogram(canvas, box, parts_->distortion());
    case Panel::convergence:
      return draw_convergence(canvas, box, parts_->subject.report.history);
    case Panel::sheet:
      return;
  }
}

void draw_sheet(PanelPainter& painter, Canvas& canvas, const RenderSubject& subject) {
  const double em = canvas.em();
  const Box page =
      Box{0, 0, static_cast<double>(canvas.size().width), static_cast<double>(canvas.size().height)}.inset(
          1.5 * em, 1.5 * em, 1.5 * em, em);
  canvas.text({page.x, page.y + 1.6 * em},
              fmt::format("{}  onto  {}", subject.title, subject.report.signature),
              {.size = 1.7, .bold = true});
  std::vector<int> cones;
  for (const ConeCopies& cone : subject.report.cones) cones.push_back(cone.vertex);
  canvas.text(
      {page.x, page.y + 3.5 * em},
      fmt::format("{} triangles,  cones at vertices {},  group of order {},  energy {:.6g}, {}",
                  with_commas(subject.mesh.F.rows()), fmt::join(cones, ", "), subject.report.group_order,
                  subject.report.energy, subject.report.bijective ? "certified bijective" : "not certified"),
      {.colour = ink::quiet});
  const Box body = page.inset(0, 5 * em, 0, 0);
  const double gap = 1.5 * em, width = (body.width - 2 * gap) / 3, height = (body.height - gap) / 2;
  const auto cell = [&](int column, int row) {
    return Box{body.x + column * (width + gap), body.y + row * (height + gap), width, height};
  };
  const auto captioned = [&](Panel panel, const Box& box, const std::string& caption) {
    painter.draw(panel, canvas, box.inset(0, 0, 0, 2 * em));
    canvas.text({box.x + 0.5 * box.width, box.bottom() - 0.4 * em}, caption,
                {.align = Align::centre, .bold = true});
  };
  captioned(Panel::source, cell(0, 0), "Source mesh, marked vertices and seams");
  captioned(Panel::sphere, cell(1, 0), "Its tile on the sphere, and the copies");
  captioned(Panel::checkerboard, cell(2, 0), "Checkerboard through the map");
  captioned(Panel::area, cell(0, 1), "Area distortion");
  captioned(Panel::angle, cell(1, 1), "Angle distortion");
  const Box plots = cell(2, 1);
  captioned(Panel::histogram, {plots.x, plots.y, plots.width, 0.5 * plots.height},
            "Triangles by area distortion");
  captioned(Panel::convergence, {plots.x, plots.y + 0.5 * plots.height, plots.width, 0.5 * plots.height},
            "Convergence");
}

}  // namespace orbitutte
