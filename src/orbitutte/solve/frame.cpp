// SPDX-License-Identifier: MIT
#include "orbitutte/solve/frame.h"

namespace orbitutte {
namespace {

constexpr double small = 1e-7;  // edges shorter than this have fewer than nine digits
constexpr int sweeps = 200;

}  // namespace

std::optional<Isometry> resolving_frame(const DirichletEnergy& energy, const Points& positions) {
  const auto [vertex, length] = energy.smallest_spot(positions);
  if (!(length < small)) return std::nullopt;
  return energy.space().to_origin(positions.row(vertex));
}

Points settle_in_frame(const Points& positions, const Isometry& frame, const DirichletEnergy& energy,
                       const BoundaryConditions& boundary) {
  Points result = frame.on_rows(positions);
  boundary.make_feasible(result);
  energy.relax_small(result, 10 * small, sweeps);
  return result;
}

}  // namespace orbitutte
