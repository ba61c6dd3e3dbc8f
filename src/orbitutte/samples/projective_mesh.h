// SPDX-License-Identifier: MIT
// Triangulated projective planes: centrally symmetric triangulations of the sphere with antipodes identified.
#pragma once

#include "orbitutte/samples/even_maps.h"
#include "orbitutte/types.h"

namespace orbitutte {

/// The number of faces that projective_mesh makes if asked for `faces`: the nearest of 10 k^2 and 30 k^2, k
/// >= 1, and the smaller of two that are equally near. It differs by less than sqrt(10 faces). faces >= 10.
int projective_face_count(int faces);

/// A geodesic triangulation of the sphere, an icosahedron whose faces are divided, modulo the antipodal map.
/// Each pair of antipodes is one vertex, which the even map places in space; f faces have f/2 + 1 vertices.
/// The smallest mesh, with 10 faces, is the projective plane with six vertices. No orientation makes all
/// faces agree: they run counterclockwise around the northern hemisphere, so that all edges at which two
/// faces disagree lie on one closed curve. Vertices may have equal positions where the surface passes through
/// itself. faces >= 10, see projective_face_count.
Mesh projective_mesh(EvenMap map, int faces);

}  // namespace orbitutte
