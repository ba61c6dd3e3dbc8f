// SPDX-License-Identifier: MIT
// How the optimiser converged.
#pragma once

#include <vector>

#include "orbitutte/minimum.h"
#include "orbitutte/render/canvas.h"

namespace orbitutte {

/// The energy's excess over its last value and the gradient's norm, by iteration, on a logarithmic axis.
void draw_convergence(Canvas& canvas, const Box& box, const std::vector<Iteration>& history);

}  // namespace orbitutte
