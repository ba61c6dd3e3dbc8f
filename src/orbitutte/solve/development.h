// SPDX-License-Identifier: MIT
// The triangles of a surface that was cut open, laid out in the space of their metric.
#pragma once

#include "orbitutte/cut/cut.h"
#include "orbitutte/solve/conformal_metric.h"

namespace orbitutte {

/// Positions (n_cut x 3) of the cut vertices: triangle after triangle, each beside one that lies there
/// already, those across long sides first and flat ones last. In the hyperbolic plane the marks lie around
/// (0, 0, 1), since digits are lost with the distance from there.
Points developed(const Surface& surface, const CutMesh& cut, Space space, const ConformalMetric& metric);

}  // namespace orbitutte
