// SPDX-License-Identifier: MIT
// From a triangle mesh in memory to a certified embedding into the orbifold 432, and what it says of itself.
#include <cstdio>

#include "orbitutte/embed.h"
#include "orbitutte/samples/sample.h"

int main() {
  using namespace orbitutte;
  const Mesh mesh = sample_mesh({SampleShape::figure, 8000});
  const Target target = parse_orbifold("432");
  const std::vector<int> cones = choose_cones(mesh, target);

  EmbedOptions options;
  options.progress = [](const Progress& progress) {
    if (progress.stage == "optimize")
      std::printf("iteration %2d: E = %.12g\n", progress.iteration, progress.energy);
    return true;  // false would cancel
  };
  const EmbedResult result = embed(mesh, target, cones, options);

  std::printf("%s after %d iterations, %s\n", name_of(result.minimum.termination).c_str(),
              result.minimum.iterations,
              result.certificate.bijective ? "certified bijective" : "not certified");
  for (const Check& check : result.certificate.checks)
    std::printf("  %-15s %s\n", check.name.c_str(), check.passed ? "holds" : check.detail.c_str());
  std::printf("mean distortion: area %.3f, angles %.3f\n", result.distortion.area.mean,
              result.distortion.angle.mean);
  return result.certificate.bijective ? 0 : 1;
}
