// SPDX-License-Identifier: MIT
// Triangulated projective planes: centrally symmetric triangulations of the sphere, antipodes identified.
#pragma once

#include "orbitutte/samples/even_maps.h"
#include "orbitutte/types.h"

namespace orbitutte {

/// The number of faces that projective_mesh makes where `faces` are asked for: the nearest of 10 k^2 and
/// 30 k^2, k >= 1, the smaller one of two that are equally near. It is off by less than sqrt(10 faces).
/// faces >= 10.
int projective_face_count(int faces);

/// A geodesic triangulation of the sphere, an icosahedron whose faces are divided, modulo the antipodal map:
/// each class of two antipodes is one vertex, laid into space by the even map; of f faces, f/2 + 1 vertices.
/// The smallest, 10 faces, is the projective plane of six vertices. No turning of faces makes all of them
/// agree: they run counterclockwise around the northern hemisphere, so that all edges over which two faces
/// disagree lie along one closed curve. Vertices may have equal positions where the surface passes
/// through itself. faces >= 10, see projective_face_count.
Mesh projective_mesh(EvenMap map, int faces);

}  // namespace orbitutte
