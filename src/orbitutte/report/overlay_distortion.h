// SPDX-License-Identifier: MIT
// How much a map between two surfaces stretches each piece of the first, for colours.
#pragma once

#include <vector>

#include "orbitutte/report/colour_scale.h"

namespace orbitutte {

/// Of one triangle under a linear map with singular values s and t, both surfaces scaled to area one; NaN if
/// the triangle is degenerate on either.
struct PieceDistortion {
  /// s t: the area on B over the area on A.
  double area = 0;

  /// (s^2 + t^2 + s^-2 + t^-2)/4: 1 for isometries.
  double symmetric_dirichlet = 0;
};

/// A value for each triangle (T x 3) with corners at `from` on A and at `to` on B (n x 3 each).
std::vector<PieceDistortion> piece_distortions(const Triangles& triangles, const Points& from,
                                               const Points& to);

/// log2 of the areas, and the energies, of those that are not degenerate.
std::vector<double> piece_log_areas(const std::vector<PieceDistortion>& pieces);
std::vector<double> piece_energies(const std::vector<PieceDistortion>& pieces);

/// Scales of colours that hold nine tenths of the values: of the logarithms, and of the energies, which begin
/// at 1.
ColourScale map_area_scale(const std::vector<double>& log_areas);
ColourScale map_energy_scale(const std::vector<double>& energies);

}  // namespace orbitutte
