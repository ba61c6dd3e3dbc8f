// SPDX-License-Identifier: MIT
// Images of flat orbifolds: the torus that covers them, and tiles that are parallelograms. Private to
// resample/.
// Tori as images of surfaces: H. Maron et al., "Convolutional neural networks on surfaces via seamless toric
// covers", ACM TOG 36 (2017).
#pragma once

#include "orbitutte/resample/grid.h"

namespace orbitutte {

/// `request` is of the kind periodic or tile. Throws ArgumentError as make_grid does.
Grid flat_grid(const GridRequest& request, const Embedding& embedding);

/// Where the image has a point of the plane (z = 1): the share of `across` and of `up`, 0 .. 1. A periodic
/// image has the point moved by a translation, a tile that of its images by the group that lies in the tile.
Eigen::Vector2d flat_place(const Grid& grid, const Vector3& point);

/// The pixel inside that a pixel beyond the sides is.
ImagePixel flat_pixel(const Grid& grid, const ImagePixel& pixel);

}  // namespace orbitutte
