// SPDX-License-Identifier: MIT
// A ray from the centre finds the triangle at every visible point of the sphere: it meets the flat triangle
// whose spherical triangle holds the point. So the picture shows great arcs and a round outline, however
// coarse the mesh is.
#include "orbitutte/render/sphere_figure.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "orbitutte/orbifold/polygon.h"
#include "orbitutte/orbifold/symmetry_group.h"
#include "orbitutte/render/ball_labels.h"
#include "orbitutte/render/exposure_grid.h"
#include "orbitutte/render/mesh_lines.h"
#include "orbitutte/render/source_figure.h"

namespace orbitutte {
namespace {

constexpr double camera_distance = 3;

// Balls and tubes darken the sphere around them.
constexpr float above_sphere = 1.0002F;
constexpr float reach_of_contact = 0.1F;
constexpr float contact = 0.55F;  // the share of the light that they can take away

// A tile that is held on a polygon stands alone.
std::vector<TileCopy> copies_of(const Embedding& embedding) {
  constexpr int enough_to_fill_a_picture = 200;
  return embedding.seams.empty() ? std::vector<TileCopy>(1)
                                 : tile_copies(embedding, enough_to_fill_a_picture);
}

RayScene copies_of_tile(const Points& positions, const Triangles& faces,
                        const std::vector<TileCopy>& copies) {
  RayScene tile;
  tile.add_triangles(positions, faces);
  tile.commit();
  RayScene scene;
  for (const TileCopy& copy : copies) scene.add_copy(tile, copy.transform.matrix());
  scene.commit();
  return scene;
}

// The least distance at which two marked vertices of the tile are drawn; 2 if there is only one.
double smallest_gap(const Embedding& embedding) {
  const DrawnSpace drawn = drawn_space(embedding);
  double gap = 2;
  std::vector<Vector3> corners;
  for (const ConeCopies& cone : embedding.cones)
    for (const int v : cone.copies) {
      const Vector3 at = drawn.at(embedding.positions.row(v));
      for (const Vector3& other : corners) gap = std::min(gap, (at - other).norm());
      corners.push_back(at);
    }
  return gap;
}

// Where a ball around a point of the sphere has to be so that the sphere hides no more than its rear half, as
// an orthographic camera sees no difference otherwise; on the far side, the point.
Vector3 brought_forward(Space space, const Vector3& point, double radius, const Vector3& viewer) {
  const double depth = point.dot(viewer);
  if (depth < 0) return point;
  const double inner = std::max(0.0, (point - depth * viewer).norm() - radius);  // its nearest to the middle
  return point + (space.lift(inner, 0).z() - depth) * viewer;
}

// The geodesics through these vertices, in steps so short that no chord sinks into the sphere by more than a
// small part of a tube.
Points arcs(Space space, const Points& positions, const std::vector<int>& vertices) {
  constexpr double step = 0.05;  // radians
  std::vector<Vector3> points = {positions.row(vertices.front())};
  for (std::size_t i = 1; i < vertices.size(); ++i) {
    const Vector3 from = points.back(), to = positions.row(vertices[i]);
    const double length = space.distance(from, to);
    const int count = std::max(1, static_cast<int>(std::ceil(length / step)));
    const Vector3 tangent = space.tangent(from, to - from);
    for (int k = 1; k < count; ++k)
      points.push_back(space.at(from, tangent / space.norm(tangent), length * k / count));
    points.push_back(to);
  }
  Points result(static_cast<Eigen::Index>(points.size()), 3);
  for (std::size_t i = 0; i < points.size(); ++i) result.row(static_cast<Eigen::Index>(i)) = points[i];
  return result;
}

// Where points of the space (n x 3) are drawn after an isometry; those between the ends that are nearer than
// `least` to the one before are left out.
Points drawn_line(const DrawnSpace& drawn, const Isometry& transform, const Points& points, double least) {
  std::vector<Vector3> kept;
  for (Eigen::Index i = 0; i < points.rows(); ++i) {
    const Vector3 at = drawn.at(transform * Vector3(points.row(i)));
    const bool is_end = i == 0 || i + 1 == points.rows();
    if (is_end || (at - kept.back()).norm() >= least) kept.push_back(at);
  }
  Points result(static_cast<Eigen::Index>(kept.size()), 3);
  for (std::size_t i = 0; i < kept.size(); ++i) result.row(static_cast<Eigen::Index>(i)) = kept[i];
  return result;
}

// The seams of all copies, thin and grey; no line is thinner than a small part of a pixel.
Ornaments seams_of_copies(const Embedding& embedding, const std::vector<TileCopy>& copies, double pixel) {
  constexpr double thinnest = 0.05;
  const DrawnSpace drawn = drawn_space(embedding);
  const Vector3 middle = tile_centre(embedding);
  const double radius = 0.45 * seam_radius(embedding.target);
  std::vector<Points> lines;
  for (const Seam& seam : embedding.seams)
    lines.push_back(arcs(embedding.space(), embedding.positions, seam.left));
  Ornaments result;
  for (const TileCopy& copy : copies) {
    const double there = radius * drawn.scale(copy.transform * middle) / drawn.scale(middle);
    if (there < thinnest * pixel) continue;
    for (const Points& line : lines)
      result.add_tube(drawn_line(drawn, copy.transform, line, 0.5 * pixel), there, {120, 124, 134});
  }
  result.commit();
  return result;
}

// Those of the copies, the first in bold.
std::vector<Colour> colours_of_copies(const std::vector<TileCopy>& copies) {
  std::vector<Colour> colours = {linear(bold_colour)};
  for (std::size_t c = 1; c < copies.size(); ++c)
    colours.push_back(mix(linear(tile_colour(copies[c].colour, false)), linear(ink::paper),
                          copies[c].mirrored ? 0.45F : 0.6F));
  return colours;
}

}  // namespace

SphereFigure::SphereFigure(const Embedding& embedding, std::vector<float> relief)
    : drawn_(drawn_space(embedding)),
      positions_(embedding.positions),
      faces_(embedding.triangles),
      relief_(std::move(relief)),
      copies_(copies_of(embedding)),
      copy_colours_(colours_of_copies(copies_)),
      edge_length_(mean_edge_length(positions_, faces_)),
      scene_(copies_of_tile(positions_, faces_, copies_)) {}

Colour SphereFigure::surface_colour(const std::optional<Hit>& hit, double pixel) const {
  if (!hit) return around_;  // outside of a tile that has no copies
  const auto corner = faces_.row(hit->primitive);
  const float relief =
      (1 - hit->u - hit->v) * relief_[corner[0]] + hit->u * relief_[corner[1]] + hit->v * relief_[corner[2]];
  const float strength = hit->copy == 0 ? 0.7F : 0.3F;
  const float line = line_strength(edge_length_ / pixel) * line_coverage(positions_, faces_, *hit, pixel);
  return copy_colours_[hit->copy] * (1 - strength + strength * relief) * (1 - 0.5F * line);
}

SphereFigure::Meeting SphereFigure::meeting(const Ray& ray) const {
  const Vector3 origin = ray.origin.cast<double>(), direction = ray.direction.cast<double>();
  const std::optional<double> distance = drawn_.surface().meeting(origin, direction);
  if (!distance) return {};
  const Vector3 at = drawn_.surface().retract(origin + *distance * direction);
  return {.distance = static_cast<float>(*distance),
          .point = drawn_.point_at(at),
          .normal = {above_sphere * at.cast<float>(), drawn_.surface().upright(at).cast<float>(),
                     reach_of_contact}};
}

SphereFigure::Seen SphereFigure::look(const Ornaments& ornaments, Packet rays) const {
  Seen seen;
  for (int k = 0; k < packet_size; ++k) {
    seen.surface[k] = meeting(rays[k]);
    rays[k].length = seen.surface[k].distance;
  }
  seen.ornaments = ornaments.first_hits(rays);
  for (int k = 0; k < packet_size; ++k) {
    const bool passes = std::isinf(seen.surface[k].distance);
    // Copies' seams do not stand out: the outline stays round.
    if (passes && seen.ornaments[k] && seen.ornaments[k]->copy >= 0) seen.ornaments[k].reset();
    if (seen.ornaments[k]) seen.surface[k].point.reset();
  }
  return seen;
}

// The sum over the points seen through a pixel. The light there, and the scale, are those of the first.
Rgba SphereFigure::surface_sum(const Seen& seen, const Camera& camera, const SurfaceLight& light) const {
  const auto first = std::find_if(seen.surface.begin(), seen.surface.end(),
                                  [](const Meeting& meeting) { return meeting.point.has_value(); });
  if (first == seen.surface.end()) return Rgba::Zero();
  const Vector3f normal = camera.axes.cast<float>() * first->normal.direction;
  const float shade = 1 - contact + contact * light(first->normal).openness,
              diffuse = (0.40F + 0.62F * brightness(normal, {})) * shade, highlight = 0.6F * gloss(normal);
  const double pixel = camera.pixel / drawn_.scale(*first->point);
  Packet outwards;
  for (int k = 0; k < packet_size; ++k)
    if (const auto& point = seen.surface[k].point) {
      outwards[k] = {Vector3f::Zero(), point->cast<float>()};
    } else {
      outwards[k].length = -1;
    }
  const Hits hits = scene_.first_hits(outwards);
  Rgba sum = Rgba::Zero();
  for (int k = 0; k < packet_size; ++k)
    if (seen.surface[k].point) sum += opaque(diffuse * surface_colour(hits[k], pixel) + highlight);
  return sum;
}

Image SphereFigure::draw(const Camera& camera, const Ornaments& ornaments) const {
  const Blocker are_blocked = [&](const Packet& rays) { return ornaments.are_blocked(rays); };
  const auto exposure = [&](const Ray& normal, float turn) -> Exposure {
    return {.openness = openness(are_blocked, normal, turn)};
  };
  const auto normals = [&](const Packet& rays) {
    const Seen seen = look(ornaments, rays);
    Normals result;
    for (int k = 0; k < packet_size; ++k)
      if (seen.surface[k].point) result[k] = seen.surface[k].normal;
    return result;
  };
  const ExposureGrid grid(camera, camera_distance, {normals, exposure});
  return picture_of(camera.size, [&](int column, int row) -> Rgba {
    const Seen seen = look(ornaments, camera.rays(column, row, camera_distance));
    Rgba sum = surface_sum(seen, camera, [&](const Ray& normal) { return grid.at(column, row, normal); });
    for (const std::optional<Hit>& ornament : seen.ornaments)
      if (ornament) sum += shade_ornament(camera, ornaments, *ornament);
    return sum / packet_size;
  });
}

double seam_radius(const Target& target) {
  const double side = std::sqrt(target_area(target));
  return std::clamp(0.012 * side, 0.005, 0.012);
}

double ball_radius(const Embedding& embedding, double pixel) {
  const double wanted = std::max(5.5 * seam_radius(embedding.target), readable_radius * pixel);
  return std::min(wanted, std::max(0.3 * smallest_gap(embedding), 0.01));
}

Ornaments sphere_ornaments(const Embedding& embedding, const std::vector<TileCopy>& copies,
                           const Camera& camera) {
  const DrawnSpace drawn = drawn_space(embedding);
  const double radius = seam_radius(embedding.target);
  Ornaments result;
  result.add_copies(seams_of_copies(embedding, copies, camera.pixel), {Matrix3::Identity()});
  for (std::size_t s = 0; s < embedding.seams.size(); ++s) {
    const Seam& seam = embedding.seams[s];
    for (const std::vector<int>* bank : {&seam.left, &seam.right})
      result.add_tube(drawn_line(drawn, Isometry(), arcs(embedding.space(), embedding.positions, *bank), 0),
                      radius, seam_colour(static_cast<int>(s)));
  }
  const double ball = ball_radius(embedding, camera.pixel);
  for (std::size_t c = 0; c < embedding.cones.size(); ++c)
    for (const int v : embedding.cones[c].copies)
      result.add_ball(
          brought_forward(drawn.surface(), drawn.at(embedding.positions.row(v)), ball, camera.axes.row(2)),
          ball, cone_colour(static_cast<int>(c)));
  result.commit();
  return result;
}

namespace {

// The tile, and the copies around it if there are any.
DrawnSpace::Ball around_tile(const Embedding& embedding) {
  const double tiles_across = tiles_its_space(embedding.target) ? 2.2 : 1.1;
  const Vector3 centre = tile_centre(embedding);
  const Points away = embedding.positions.rowwise() - centre.transpose();
  return {centre, tiles_across * away.rowwise().norm().maxCoeff()};
}

}  // namespace

Camera sphere_camera(const Embedding& embedding, const View& view, const PictureSize& size, double fill) {
  Camera camera;
  camera.axes = view_axes(view);
  camera.size = size;
  const DrawnSpace::Ball shown = drawn_space(embedding).whole().value_or(around_tile(embedding));
  camera.centre = shown.centre;
  camera.pixel = 2 * shown.radius / (fill * std::min(size.width, size.height));
  return camera;
}

DrawnSpace drawn_space(const Embedding& embedding) { return {embedding.space(), tile_centre(embedding)}; }

Vector3 tile_centre(const Embedding& embedding) {
  const Points& X = embedding.positions;
  Vector3 sum = Vector3::Zero();
  for (Eigen::Index f = 0; f < embedding.triangles.rows(); ++f) {
    const auto v = embedding.triangles.row(f);
    const Vector3 a = X.row(v[0]), b = X.row(v[1]), c = X.row(v[2]);
    sum += (b - a).cross(c - a).norm() * (a + b + c);
  }
  return sum.norm() > 1e-12 ? embedding.space().retract(sum) : Vector3(Vector3::UnitX());
}

View tile_view(const Embedding& embedding) {
  if (!embedding.space().is_closed()) return {Vector3::UnitZ(), Vector3::UnitY()};
  const Vector3 centre = tile_centre(embedding);
  const double reach = 1 - std::max(0.0, (embedding.positions * centre).minCoeff());
  const Matrix3 axes = view_axes({centre, Vector3::UnitZ()});
  const double tilt = 0.08 + 0.3 * reach;
  return {(centre + tilt * (axes.row(0) + axes.row(1)).transpose()).normalized(), Vector3::UnitZ()};
}

}  // namespace orbitutte
