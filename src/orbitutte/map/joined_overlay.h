// SPDX-License-Identifier: MIT
// The overlay of two surfaces from that of their divided ears. Private to map/.
#pragma once

#include "orbitutte/map/divided_ears.h"
#include "orbitutte/map/overlay.h"

namespace orbitutte {

/// The same vertices and faces, named by the triangles, half-edges and vertices of the whole surfaces;
/// of_parts is what was given.
Overlay joined_overlay(Overlay of_parts, const DividedEars& a, const DividedEars& b);

/// Do both overlays say the same, but for of_parts?
bool say_the_same(const Overlay& x, const Overlay& y);

}  // namespace orbitutte
