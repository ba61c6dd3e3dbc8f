// SPDX-License-Identifier: MIT
#include "orbitutte/render/camera.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>

namespace orbitutte {

Matrix3 view_axes(const View& view) {
  const Vector3 towards = view.viewer.normalized();
  Vector3 right = view.up.normalized().cross(towards);
  if (right.norm() < 1e-6) right = towards.unitOrthogonal();
  right.normalize();
  Matrix3 axes;
  axes << right.transpose(), towards.cross(right).transpose(), towards.transpose();
  return axes;
}

Matrix3 front_axes(const Vector3& up) {
  const Vector3 above = up.normalized();
  const bool along_z = std::abs(above[2]) > 0.7;
  const Vector3 front = along_z ? Vector3(-Vector3::UnitY()) : Vector3(Vector3::UnitZ());
  return view_axes({(front - front.dot(above) * above).normalized(), above});
}

Ray Camera::ray(float x, float y, double distance) const {
  const Vector3 in_view((x - 0.5 * size.width) * pixel, (0.5 * size.height - y) * pixel, distance);
  const Vector3 origin = centre + axes.transpose() * in_view;
  return {origin.cast<float>(), -axes.row(2).transpose().cast<float>()};
}

Packet Camera::rays(int column, int row, double distance) const {
  // In sixteenths of a pixel: the points for eight samples of common graphics hardware.
  constexpr std::array<std::array<int, 2>, packet_size> places = {
      {{9, 5}, {7, 11}, {13, 9}, {5, 3}, {3, 13}, {1, 7}, {11, 15}, {15, 1}}};
  const Ray corner = ray(static_cast<float>(column), static_cast<float>(row), distance);
  const Vector3f right = (pixel / 16 * axes.row(0)).cast<float>(),
                 down = (-pixel / 16 * axes.row(1)).cast<float>();
  Packet rays;
  for (int k = 0; k < packet_size; ++k)
    rays[k] = {
        corner.origin + static_cast<float>(places[k][0]) * right + static_cast<float>(places[k][1]) * down,
        corner.direction};
  return rays;
}

Vector3 Camera::project(const Vector3& point) const {
  const Vector3 in_view = axes * (point - centre);
  return {0.5 * size.width + in_view[0] / pixel, 0.5 * size.height - in_view[1] / pixel, in_view[2]};
}

Camera fit_camera(const View& view, const Points& points, const PictureSize& size, double fill) {
  Camera camera;
  camera.axes = view_axes(view);
  camera.size = size;
  const Points in_view = points * camera.axes.transpose();
  const Vector3 low = in_view.colwise().minCoeff(), high = in_view.colwise().maxCoeff();
  camera.centre = camera.axes.transpose() * (0.5 * (low + high));
  const Vector3 extent = high - low;
  camera.pixel = std::max({extent[0] / size.width, extent[1] / size.height, 1e-9}) / fill;
  return camera;
}

}  // namespace orbitutte
