// SPDX-License-Identifier: MIT
#include "orbitutte/render/source_figure.h"

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>

#include "orbitutte/render/exposure_grid.h"

namespace orbitutte {
namespace {

constexpr double crease = 40 * std::numbers::pi / 180;
constexpr double distance_to_source = 4;  // the figure lies in the unit ball
constexpr float surface_offset = 2e-4F;   // how far above the surface rays begin that leave it
constexpr float reach_of_shade = 0.6F;

// Vertices that no face uses are put on the first face's first corner, so that they do not make the figure
// small.
Points used_positions(const Points& V, const Triangles& F) {
  Points used = V(F(0, 0), Eigen::all).replicate(V.rows(), 1);
  for (const int v : F.reshaped()) used.row(v) = V.row(v);
  return used;
}

Points in_unit_ball(const Points& V) {
  const Vector3 low = V.colwise().minCoeff(), high = V.colwise().maxCoeff();
  const double radius = std::max(0.5 * (high - low).stableNorm(), std::numeric_limits<double>::min());
  return (V.rowwise() - (0.5 * low + 0.5 * high).transpose()) / radius;
}

Vector3f interpolate(const CornerNormals& normals, const Hit& hit) {
  const auto corner = [&](int k) { return normals.row(3 * hit.primitive + k); };
  return ((1 - hit.u - hit.v) * corner(0) + hit.u * corner(1) + hit.v * corner(2)).transpose();
}

// The ornaments that rays meet before the surface.
Hits ornaments_before(const Hits& surface, const Ornaments& ornaments, Packet rays) {
  for (int k = 0; k < packet_size; ++k)
    if (surface[k]) rays[k].length = surface[k]->distance;
  return ornaments.first_hits(rays);
}

// What reaches the viewer from a surface, diffusely and in a highlight.
struct Shade {
  float diffuse = 1, highlight = 0;
};

Shade shade_of(const Camera& camera, const Vector3f& normal, const Exposure& exposure) {
  const Vector3f in_view = camera.axes.cast<float>() * normal;
  return {brightness(in_view, exposure), gloss(in_view) * exposure.openness * exposure.lit};
}

Vector3f towards(const Vector3f& normal, const Vector3f& viewer) {
  return normal.dot(viewer) < 0 ? Vector3f(-normal) : normal;
}

}  // namespace

SourceFigure::SourceFigure(const Points& V, const Triangles& F)
    : V_(in_unit_ball(used_positions(V, F))), F_(F), normals_(corner_normals(V_, F_, crease)) {
  scene_.add_triangles(V_, F_);
  scene_.commit();
}

Image SourceFigure::draw(const Camera& camera, const SurfaceColour& colour,
                         const Ornaments& ornaments) const {
  const Blocker are_blocked = [&](const Packet& rays) {
    return scene_.are_blocked(rays) | ornaments.are_blocked(rays);
  };
  const auto exposure = [&](const Ray& above, float turn) -> Exposure {
    return {openness(are_blocked, above, turn), lit(are_blocked, above.origin, camera.axes, turn)};
  };
  const auto seen = [&](const Packet& rays) {
    const Hits surface = scene_.first_hits(rays), ornament = ornaments_before(surface, ornaments, rays);
    Normals normals;
    for (int k = 0; k < packet_size; ++k)
      if (surface[k] && !ornament[k]) normals[k] = normal_at(rays[k], *surface[k]);
    return normals;
  };
  const ExposureGrid light(camera, distance_to_source, {seen, exposure});
  return picture_of(camera.size, [&](int column, int row) -> Rgba {
    const Packet rays = camera.rays(column, row, distance_to_source);
    const Hits surface = scene_.first_hits(rays), ornament = ornaments_before(surface, ornaments, rays);
    Rgba sum = Rgba::Zero();
    int shaded = -1;  // the face that this is the shade of, as everywhere in the pixel
    Shade shade;
    for (int k = 0; k < packet_size; ++k) {
      if (ornament[k]) {
        sum += shade_ornament(camera, ornaments, *ornament[k]);
      } else if (surface[k]) {
        if (shaded != surface[k]->primitive) {
          const Ray above = normal_at(rays[k], *surface[k]);
          shade = shade_of(camera, above.direction, light.at(column, row, above));
          shaded = surface[k]->primitive;
        }
        sum += opaque(shade.diffuse * colour(*surface[k]) + shade.highlight);
      }
    }
    return sum / packet_size;
  });
}

// From just above the surface along its smooth normal, on the side that is seen, as far as shade reaches.
Ray SourceFigure::normal_at(const Ray& ray, const Hit& hit) const {
  const Vector3f side = towards(hit.normal, -ray.direction);
  // Smooth normals agree with the side of the surface that is seen.
  Vector3f normal = interpolate(normals_, hit).normalized();
  if (!normal.allFinite()) normal = side;
  return {ray.origin + hit.distance * ray.direction + surface_offset * side, towards(normal, side),
          reach_of_shade};
}

bool SourceFigure::is_visible(const Vector3& point, const Vector3& viewer, double clearance) const {
  const Vector3 start = point + clearance * viewer;
  return !scene_.is_blocked({start.cast<float>(), viewer.cast<float>()});
}

Rgba shade_ornament(const Camera& camera, const Ornaments& ornaments, const Hit& hit) {
  Vector3f normal = camera.axes.cast<float>() * hit.normal;
  if (normal[2] < 0) normal = -normal;
  return opaque(ornaments.colour(hit) * (0.35F + 0.65F * brightness(normal, {})) + 2 * gloss(normal));
}

}  // namespace orbitutte
