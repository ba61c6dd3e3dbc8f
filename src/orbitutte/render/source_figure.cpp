// SPDX-License-Identifier: MIT
#include "orbitutte/render/source_figure.h"

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>

#include "orbitutte/parallel.h"

namespace orbitutte {
namespace {

constexpr double crease = 40 * std::numbers::pi / 180;
constexpr double distance_to_source = 4;  // the figure lies in the unit ball
constexpr float surface_offset = 2e-4F;   // how far above the surface rays begin that leave it
constexpr float reach_of_shade = 0.6F;
constexpr int rays_to_surroundings = 3;  // for each sample

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
  const Blocker is_blocked = [&](const Ray& ray) {
    return scene_.is_blocked(ray) || ornaments.is_blocked(ray);
  };
  return supersample(camera.size, [&](const Sample& sample) -> Rgba {
    const Ray ray = camera.ray(sample.x, sample.y, distance_to_source);
    const auto surface = scene_.first_hit(ray), ornament = ornaments.first_hit(ray);
    if (ornament && (!surface || ornament->distance < surface->distance))
      return shade_ornament(camera, ornaments, *ornament);
    if (!surface) return Rgba::Zero();
    const Ray above = normal_at(ray, *surface);
    const Exposure exposure = {openness(is_blocked, above, rays_to_surroundings, sample),
                               lit(is_blocked, above.origin, camera.axes, sample)};
    const Vector3f normal = camera.axes.cast<float>() * above.direction;
    return opaque(brightness(normal, exposure) * colour(*surface) +
                  gloss(normal) * exposure.openness * exposure.lit);
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
