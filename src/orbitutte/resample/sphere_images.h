// SPDX-License-Identifier: MIT
// Images of the sphere: equirectangular, octahedral and cubes. Private to resample/.
// The octahedral one: E. Praun, H. Hoppe, "Spherical parametrization and remeshing", ACM TOG 22 (2003).
#pragma once

#include "orbitutte/resample/grid.h"

namespace orbitutte {

/// Points, areas and shape, and of octahedral and cube images the triangles.
Grid equirectangular_grid(int height, int width);
Grid octahedral_grid(int size);
Grid cube_grid(int size);

/// The pixel inside the image that a pixel beyond its sides is: around the pole, and around the axis; by half
/// turns about the middles of the sides; over the edges of the cube.
ImagePixel equirectangular_pixel(const ImagePixel& pixel, int height, int width);
ImagePixel octahedral_pixel(const ImagePixel& pixel, int size);
ImagePixel cube_pixel(const ImagePixel& pixel, int size);

/// Where a point is in an equirectangular image: column and row, whole numbers at the centres of pixels.
Eigen::Vector2d equirectangular_place(const Vector3& point, int height, int width);

}  // namespace orbitutte
