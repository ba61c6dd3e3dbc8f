// SPDX-License-Identifier: MIT
#include <Eigen/Geometry>
#include <algorithm>

#include "orbitutte/render/ball_labels.h"
#include "orbitutte/render/panels.h"
#include "orbitutte/render/sphere_figure.h"

namespace orbitutte {
namespace {

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

View sphere_view(const PictureParts& parts) {
  const RenderOptions& options = parts.options();
  View view = tile_view(parts.embedding());
  if (options.panel != Panel::sphere) return view;
  if (options.view) view.viewer = *options.view;
  if (options.up) view.up = *options.up;
  return view;
}

}  // namespace

void draw_sphere_panel(Canvas& canvas, const Box& box, PictureParts& parts) {
  const Embedding& embedding = parts.embedding();
  const SphereFigure sphere(embedding, relief(parts.figure(), embedding, parts.source_view()));
  const Camera camera = sphere_camera(embedding, sphere_view(parts), size_of(box), figure_fill);
  canvas.image({box.x, box.y}, sphere.draw(camera, sphere_ornaments(embedding, sphere.copies(), camera)));
  const DrawnSpace drawn = drawn_space(embedding);
  const double radius = ball_radius(embedding, camera.pixel) / camera.pixel;
  for (std::size_t c = 0; c < embedding.cones.size(); ++c)
    for (const int v : embedding.cones[c].copies) {
      const Vector3 at = camera.project(drawn.at(embedding.positions.row(v)));
      if (at[2] < 0) continue;  // on the far side
      draw_label(canvas, {.at = {box.x + at[0], box.y + at[1]},
                          .radius = radius,
                          .order = order_to_show(embedding, c),
                          .colour = cone_colour(static_cast<int>(c))});
    }
}

}  // namespace orbitutte
