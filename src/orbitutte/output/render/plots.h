// SPDX-License-Identifier: MIT
// The plots: a histogram of area distortion, and how the optimiser converged; and scales for coloured
// figures.
#pragma once

#include <vector>

#include "orbitutte/output/render/canvas.h"
#include "orbitutte/solve/lbfgs.h"
#include "orbitutte/verify/distortion.h"

namespace orbitutte {

/// How many triangles have which log2 A, in the colours of the scale; mean and median are marked.
void draw_histogram(Canvas& canvas, const Box& box, const std::vector<FaceDistortion>& faces);

/// The energy's excess over its last value and the gradient's norm, by iteration, on a logarithmic axis.
void draw_convergence(Canvas& canvas, const Box& box, const std::vector<Iteration>& history);

}  // namespace orbitutte
