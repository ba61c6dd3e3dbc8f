// SPDX-License-Identifier: MIT
// Meshes that the program generates, for demonstrations and for tests without a file.
#pragma once

#include <string>
#include <vector>

#include "orbitutte/names.h"
#include "orbitutte/types.h"

namespace orbitutte {

enum class SampleShape {
  /// A sphere: a little figure with a head, two arms, one of them raised, and two legs.
  figure,
  /// A disk: the front of a face, with one smooth boundary curve.
  mask,
  /// A projective plane: Boy's surface (boys_surface).
  boy,
  /// A projective plane: Steiner's Roman surface (roman_surface).
  roman,
  /// A projective plane: the cross-cap (cross_cap).
  crosscap,
  /// A projective plane: a figure with three pairs of opposite limbs, antipodes identified (limbed_quotient).
  quotient
};

/// Its names.
template <>
struct NameTable<SampleShape> {
  static constexpr NamedValue<SampleShape> rows[] = {
      {SampleShape::figure, "figure"},     {SampleShape::mask, "mask"},
      {SampleShape::boy, "boy"},           {SampleShape::roman, "roman"},
      {SampleShape::crosscap, "crosscap"}, {SampleShape::quotient, "quotient"}};
};

/// Does the surface pass through itself in space, as every projective plane does? Its mesh does not, but
/// different vertices may have equal positions. A format that identifies vertices by position (STL) would
/// weld them.
bool passes_through_itself(SampleShape shape);

/// Which mesh to make.
struct SampleOptions {
  SampleShape shape = SampleShape::figure;
  /// 100 to 20 million; for projective planes 10 to 20 million.
  int faces = 20000;
};

/// A smooth surface in even triangles, about 2 units high (y) and looking along z. Up to 10,000, the number
/// of faces is exactly the one asked for; the figure's is rounded up to an even number, and is at least 124.
/// Above that, a mesh of 2,500 to 10,000 faces is divided, each triangle into four, as often as needed, and
/// the number differs by less than 0.05 %. Projective planes get the nearest number of faces that a divided
/// icosahedron allows (projective_face_count), and are 1 to 4 units wide. Their triangles are close to
/// regular on Boy's surface, and slivers at the pinch points of the Roman surface and the cross-cap. The same
/// options give the same mesh. Throws ArgumentError if the number of faces is out of range.
Mesh sample_mesh(const SampleOptions& options);

/// Vertices of a sample mesh that are far from each other, to be marked as cones. On the figure: the top of
/// the head, the right foot, the raised left hand. On the mask: three vertices of the boundary, in the order
/// in which it runs around the faces, and the tip of the nose. On projective planes: the highest vertex (z).
std::vector<int> sample_cones(SampleShape shape, const Mesh& mesh);

}  // namespace orbitutte
