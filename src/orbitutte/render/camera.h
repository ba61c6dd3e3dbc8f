// SPDX-License-Identifier: MIT
// An orthographic camera: which ray each point of the picture looks along.
#pragma once

#include "orbitutte/render/image.h"
#include "orbitutte/render/ray_scene.h"

namespace orbitutte {

/// From where a figure is seen.
struct View {
  /// From the figure towards the viewer.
  Vector3 viewer = Vector3::UnitZ();
  /// What points up in the picture, as far as it can.
  Vector3 up = Vector3::UnitY();
};

struct Camera {
  /// Rows, unit: right, up, towards the viewer.
  Matrix3 axes = Matrix3::Identity();
  /// What the middle of the picture shows.
  Vector3 centre = Vector3::Zero();
  /// The length of a pixel's side in the world.
  double pixel = 1;
  PictureSize size;

  /// The ray into the picture at x, y (in pixels from the top left corner). It begins `distance` in front of
  /// the centre.
  Ray ray(float x, float y, double distance) const;

  /// Rays through one pixel. No two of them are in one column or row, so that edges near an axis are drawn as
  /// smoothly as others.
  Packet rays(int column, int row, double distance) const;

  /// Where a point appears: x, y in pixels, and its depth towards the viewer in the world's unit.
  Vector3 project(const Vector3& point) const;
};

/// Rows: right, up, towards the viewer. If `up` points at the viewer, another axis takes its place.
Matrix3 view_axes(const View& view);

/// The axes of the view from the front if `up` points up: the viewer is at +z, or at -y if `up` is along z.
Matrix3 front_axes(const Vector3& up);

/// The camera for which the points (n x 3) fill the share `fill` of the picture's width or height, whichever
/// is reached first.
Camera fit_camera(const View& view, const Points& points, const PictureSize& size, double fill);

}  // namespace orbitutte
