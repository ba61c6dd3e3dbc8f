// SPDX-License-Identifier: MIT
// Meshes that the program makes itself, for demonstrations and tests without a file.
#pragma once

#include <string>
#include <vector>

#include "orbitutte/types.h"

namespace orbitutte {

enum class SampleShape {
  figure,    ///< a sphere: a little figure with a head, two arms, one of them raised, and two legs
  mask,      ///< a disk: the front of a face, with one smooth boundary curve
  boy,       ///< a projective plane: Boy's surface (boys_surface)
  roman,     ///< a projective plane: Steiner's Roman surface (roman_surface)
  crosscap,  ///< a projective plane: the cross-cap (cross_cap)
  quotient   ///< a projective plane: a figure with three pairs of opposite limbs, antipodes identified
             ///< (limbed_quotient)
};

/// "figure", "mask", "boy", "roman", "crosscap" or "quotient".
std::string name(SampleShape shape);

/// The shape of that name. Throws ArgumentError naming all where there is none.
SampleShape sample_shape(const std::string& name);

/// Whether the surface passes through itself in space, as every projective plane does. Its mesh does not, but
/// different vertices may have equal positions: a format that knows vertices by their positions (STL) would
/// weld them.
bool passes_through_itself(SampleShape shape);

/// Which mesh to make.
struct SampleOptions {
  SampleShape shape = SampleShape::figure;
  int faces = 20000;  ///< 100 .. 20 million; for projective planes 10 .. 20 million
};

/// A smooth surface, about 2 units high (y) and looking along z, in even triangles. Up to 10,000 the number
/// of faces is the one asked for; for the figure it is rounded up to an even number and to 124 at least.
/// Above, a mesh of 2,500 to 10,000 faces is divided, every triangle in four, as often as needed, and the
/// number is off by less than 0.05 %. Projective planes have the nearest number of faces that a divided
/// icosahedron allows (projective_face_count), and are 1 to 4 units wide; their triangles are close to
/// regular on Boy's surface, and slivers at the pinch points of the Roman surface and the cross-cap. The same
/// options give the same mesh. Throws ArgumentError where the number of faces is out of its range.
Mesh sample_mesh(const SampleOptions& options);

/// Vertices of a sample mesh that are far from each other, to be marked as cones. The figure: the top of the
/// head, the right foot, the raised left hand. The mask: three vertices of the boundary, as it runs around
/// the faces, and the tip of the nose. Projective planes: one vertex, the highest (z).
std::vector<int> sample_cones(SampleShape shape, const Mesh& mesh);

}  // namespace orbitutte
