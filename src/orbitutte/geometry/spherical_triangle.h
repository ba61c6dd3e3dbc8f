// SPDX-License-Identifier: MIT
// Lengths, angles and areas on the unit sphere, as the certificate and the distortion measure them.
#pragma once

#include "orbitutte/types.h"

namespace orbitutte {

/// The length of the shorter great arc between two unit vectors, radians; accurate for neighbours and
/// antipodes.
double arc_length(const Vector3& p, const Vector3& q);

/// The signed area (solid angle) of the triangle a, b, c of unit vectors, in (-2 pi, 2 pi), positive where
/// counterclockwise from outside: tan(area/2) = det[a b c]/(1 + ab + bc + ca) (Oosterom, Strackee 1983).
double signed_area(const Vector3& a, const Vector3& b, const Vector3& c);

/// The angle at p from the arc to q counterclockwise to the arc to r, in (-pi, pi].
double angle_at(const Vector3& p, const Vector3& q, const Vector3& r);

}  // namespace orbitutte
