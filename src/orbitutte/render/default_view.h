// SPDX-License-Identifier: MIT
// The view of a source mesh if none is asked for.
#pragma once

#include "orbitutte/render/source_figure.h"

namespace orbitutte {

/// Upright, a little from above, from the side that shows most of the marked vertices (rows of `marked`) and
/// of the surface; an open surface, from where it faces.
View default_view(const SourceFigure& figure, const Points& marked, const Vector3& up);

}  // namespace orbitutte
