// SPDX-License-Identifier: MIT
#include "orbitutte/distortion_floor.h"

#include "orbitutte/embed.h"
#include "orbitutte/mesh/subdivision.h"
#include "orbitutte/verify/laid_out.h"

namespace orbitutte {
namespace {

constexpr int subdivisions = 2;

Surface subdivided_surface(const Surface& surface) {
  Mesh mesh = {surface.V, surface.triangles};
  for (int k = 0; k < subdivisions; ++k) mesh = subdivided(mesh);
  return make_surface(std::move(mesh));
}

}  // namespace

std::optional<Distortion> distortion_floor(const Surface& surface, const Target& target,
                                           const std::vector<int>& cones, const EmbedOptions& options) {
  EmbedOptions fine_options = options;
  fine_options.weights = {};
  fine_options.weights_file.clear();
  const Surface fine = subdivided_surface(surface);
  const EmbedResult result = embed(fine, target, cones, fine_options);
  if (!result.certificate.bijective) return std::nullopt;
  return measure_distortion(surface, sampled_on(surface.triangles, fine, result.embedding));
}

}  // namespace orbitutte
