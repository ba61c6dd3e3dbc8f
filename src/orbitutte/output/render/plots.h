// SPDX-License-Identifier: MIT
// The plots: a histogram of area distortion, and how the optimiser converged; and scales for coloured
// figures.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "orbitutte/output/render/canvas.h"
#include "orbitutte/solve/lbfgs.h"
#include "orbitutte/verify/distortion.h"

namespace orbitutte {

/// Which colours log2 A has: white at 0, blue where the map shrinks areas, red where it grows them.
struct AreaScale {
  double range = 1;  ///< the strongest colours stand for log2 A <= -range and >= range

  Colour colour(const FaceDistortion& face) const;
};

/// Which colours the ratio of singular values has: pale at 1.
struct AngleScale {
  double largest = 2;  ///< and all above

  Colour colour(const FaceDistortion& face) const;
};

/// Scales that hold nine tenths of the triangles, and for areas up to a factor of 64.
AreaScale area_scale(const std::vector<FaceDistortion>& faces);
AngleScale angle_scale(const std::vector<FaceDistortion>& faces);

/// A bar of colours with numbers below it and a title, centred in the box (which should be 4 ems high).
void draw_scale(Canvas& canvas, const Box& box, const AreaScale& scale);
void draw_scale(Canvas& canvas, const Box& box, const AngleScale& scale);

/// How many triangles have which log2 A, in the colours of the scale; mean and median are marked.
void draw_histogram(Canvas& canvas, const Box& box, const std::vector<FaceDistortion>& faces);

/// The energy's excess over its last value and the gradient's norm, by iteration, on a logarithmic axis.
void draw_convergence(Canvas& canvas, const Box& box, const std::vector<Iteration>& history);

}  // namespace orbitutte
