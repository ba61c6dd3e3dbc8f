// SPDX-License-Identifier: MIT
// Maps from the unit sphere to space that take antipodes to the same point: surfaces of the projective plane.
#pragma once

#include "orbitutte/types.h"

namespace orbitutte {

/// Takes unit vectors to points in space; p and -p go to the same point.
using EvenMap = Vector3 (*)(const Vector3&);

/// Boy's surface, immersed: it is smooth everywhere and has one triple point, at 0. The parametrisation is
/// that of R. Bryant and R. Kusner (R. Kusner, Conformal geometry and complete minimal surfaces, 1987): with
/// D = z^6 + sqrt(5) z^3 - 1 for z in the unit disk,
///   g = (-3/2 Im z(1 - z^4)/D, -3/2 Re z(1 + z^4)/D, Im (1 + z^6)/D - 1/2),   point = g/|g|^2,
/// where z is the stereographic image of p or -p, whichever lies above the equator. The map is conformal, and
/// commutes with the rotation by 2 pi/3 about the z axis.
Vector3 boys_surface(const Vector3& p);

/// Steiner's Roman surface (yz, zx, xy). Its three double lines meet in a triple point, 0, and end in six
/// pinch points.
Vector3 roman_surface(const Vector3& p);

/// The cross-cap (yz, 2xy, x^2 - y^2): one double line between two pinch points.
Vector3 cross_cap(const Vector3& p);

/// A centrally symmetric figure with three pairs of limbs, r(p) p with
///   r(p) = 1 + sum_k h_k exp(-s_k (1 - <p, a_k>^2)),
/// whose antipodes are identified. The even map x -> |x| boys_surface(x/|x|), linear along rays, maps the
/// quotient into space as r(p) boys_surface(p), which is immersed as well.
Vector3 limbed_quotient(const Vector3& p);

}  // namespace orbitutte
