// SPDX-License-Identifier: MIT
// Meshes that the program makes itself, for demonstrations and tests without a file.
#pragma once

#include <string>
#include <vector>

#include "orbitutte/types.h"

namespace orbitutte {

enum class SampleShape {
  figure,  ///< a sphere: a little figure with a head, two arms, one of them raised, and two legs
  mask     ///< a disk: the front of a face, with one smooth boundary curve
};

/// "figure" or "mask".
std::string name(SampleShape shape);

struct SampleOptions {
  SampleShape shape = SampleShape::figure;
  int faces = 20000;  ///< 100 .. 20 million
};

/// A smooth surface, about 2 units high (y) and looking along z, in even triangles. Up to 10,000 the number
/// of faces is the one asked for; for the figure it is rounded up to an even number and to 124 at least.
/// Above, a mesh of 2,500 to 10,000 faces is divided, every triangle in four, as often as needed, and the
/// number is off by less than 0.05 %. The same options give the same mesh. Throws ArgumentError where the
/// number of faces is out of its range.
Mesh sample_mesh(const SampleOptions& options);

/// Vertices of a sample mesh that are far from each other, to be marked as cones. The figure: the top of the
/// head, the right foot, the raised left hand. The mask: three vertices of the boundary, as it runs around
/// the faces, and the tip of the nose.
std::vector<int> sample_cones(SampleShape shape, const Mesh& mesh);

}  // namespace orbitutte
