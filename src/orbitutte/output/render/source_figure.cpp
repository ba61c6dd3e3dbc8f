// SPDX-License-Identifier: MIT
#include "orbitutte/output/render/source_figure.h"

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>

#include "orbitutte/parallel.h"

namespace orbitutte {
namespace {

constexpr double crease = 40 * std::numbers::pi / 180;
constexpr double camera_distance = 4;    // the figure lies in the unit ball
constexpr float surface_offset = 2e-4F;  // how far above the surface rays begin that leave it
constexpr float reach_of_shade = 0.6F;

Points in_unit_ball(const Points& V) {
  const Vector3 low = V.colwise().minCoeff(), high = V.colwise().maxCoeff();
  const double radius = std::max(0.5 * (high - low).norm(), std::numeric_limits<double>::min());
  return (V.rowwise() - 0.5 * (low + high).transpose()) / radius;
}

Vector3f interpolate(const CornerNormals& normals, const Hit& hit) {
  const auto corner = [&](int k) { return normals.row(3 * hit.primitive + k); };
  return ((1 - hit.u - hit.v) * corner(0) + hit.u * corner(1) + hit.v * corner(2)).transpose();
}

Vector3f towards(const Vector3f& normal, const Vector3f& viewer) {
  return normal.dot(viewer) < 0 ? Vector3f(-normal) : normal;
}

// The integral of the unit normal over the surface, and its area: closed surfaces have an integral of zero.
struct Orientation {
  Vector3 integral = Vector3::Zero();
  double area = 0;
};

Orientation orientation(const SourceFigure& figure) {
  Orientation result;
  const Points& V = figure.positions();
  for (Eigen::Index f = 0; f < figure.faces().rows(); ++f) {
    const auto F = figure.faces().row(f);
    const Vector3 a = V.row(F[0]), b = V.row(F[1]), c = V.row(F[2]);
    const Vector3 normal = 0.5 * (b - a).cross(c - a);
    result.integral += normal;
    result.area += normal.norm();
  }
  return result;
}

// The area that is seen where no part hides another, as a share of the whole.
double projected_share(const SourceFigure& figure, const Vector3& viewer) {
  const Points& V = figure.positions();
  double seen = 0, area = 0;
  for (Eigen::Index f = 0; f < figure.faces().rows(); ++f) {
    const auto F = figure.faces().row(f);
    const Vector3 a = V.row(F[0]), b = V.row(F[1]), c = V.row(F[2]);
    const Vector3 normal = 0.5 * (b - a).cross(c - a);
    seen += std::abs(normal.dot(viewer));
    area += normal.norm();
  }
  return area > 0 ? seen / area : 0;
}

// Twelve directions around the figure, a little from above.
std::vector<Vector3> directions_around(const Vector3& up) {
  const Matrix3 axes = front_axes(up);
  std::vector<Vector3> directions;
  for (int k = 0; k < 12; ++k) {
    const double azimuth = k * std::numbers::pi / 6;
    const Vector3 level = std::cos(azimuth) * axes.row(2) + std::sin(azimuth) * axes.row(0);
    directions.push_back((level + 0.2 * up).normalized());
  }
  return directions;
}

// A flat face seen straight on shows no depth.
Vector3 a_little_aside(const View& view) {
  const Matrix3 axes = view_axes(view);
  return (axes.row(2) + 0.3 * axes.row(0) + 0.2 * axes.row(1)).normalized();
}

// Marked vertices count most, then how much of the surface faces the viewer; the front breaks ties.
double score(const SourceFigure& figure, const Points& marked, const View& view) {
  const Vector3& viewer = view.viewer;
  double visible = 0;
  for (Eigen::Index i = 0; i < marked.rows(); ++i)
    visible += figure.is_visible(marked.row(i), viewer, 0.02) ? 1.0 / static_cast<double>(marked.rows()) : 0;
  return 0.6 * visible + 2 * projected_share(figure, viewer) + 0.2 * front_axes(view.up).row(2).dot(viewer);
}

}  // namespace

SourceFigure::SourceFigure(const Points& V, const Faces& F)
    : V_(in_unit_ball(V)), F_(F), normals_(corner_normals(V_, F_, crease)) {
  scene_.add_triangles(V_, F_);
  scene_.commit();
}

Image SourceFigure::draw(const Camera& camera, const SurfaceColour& colour,
                         const Ornaments& ornaments) const {
  return supersample(camera.size, [&](const Sample& sample) -> Rgba {
    const Ray ray = camera.ray(sample.x, sample.y, camera_distance);
    const auto surface = scene_.first_hit(ray), ornament = ornaments.first_hit(ray);
    if (ornament && (!surface || ornament->distance < surface->distance))
      return shade_ornament(camera, ornaments, *ornament);
    if (!surface) return Rgba::Zero();
    const Light light = light_at(camera, ray, *surface, sample.number);
    return opaque(light.diffuse * colour(*surface) + light.glossy);
  });
}

Light SourceFigure::light_at(const Camera& camera, const Ray& ray, const Hit& hit, unsigned sample) const {
  const Vector3f viewer = -ray.direction;
  const Vector3f side = towards(hit.normal, viewer);
  // Smooth normals agree with the side of the surface that is seen.
  Vector3f normal = interpolate(normals_, hit).normalized();
  if (!normal.allFinite()) normal = side;
  normal = towards(normal, side);
  const Vector3f origin = ray.origin + hit.distance * ray.direction + surface_offset * side;
  const float open = openness(scene_, {origin, normal}, reach_of_shade, sample);
  const Vector3f in_view = camera.axes.cast<float>() * normal;
  return {brightness(in_view, open), gloss(in_view) * open};
}

bool SourceFigure::is_visible(const Vector3& point, const Vector3& viewer, double clearance) const {
  const Vector3 start = point + clearance * viewer;
  return !scene_.is_blocked({start.cast<float>(), viewer.cast<float>()});
}

View default_view(const SourceFigure& figure, const Points& marked, const Vector3& up) {
  const Orientation open = orientation(figure);
  if (open.integral.norm() > 0.25 * open.area) return {a_little_aside({open.integral, up}), up};
  View best = {Vector3::UnitZ(), up};
  double best_score = -1;
  for (const Vector3& viewer : directions_around(up)) {
    const double s = score(figure, marked, {viewer, up});
    if (s > best_score + 1e-6) best_score = s, best.viewer = viewer;
  }
  return best;
}

Rgba shade_ornament(const Camera& camera, const Ornaments& ornaments, const Hit& hit) {
  Vector3f normal = camera.axes.cast<float>() * hit.normal;
  if (normal[2] < 0) normal = -normal;
  return opaque(ornaments.colour(hit) * (0.35F + 0.65F * brightness(normal, 1)) + 2 * gloss(normal));
}

}  // namespace orbitutte
