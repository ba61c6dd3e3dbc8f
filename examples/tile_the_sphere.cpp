// SPDX-License-Identifier: MIT
// A disk onto a triangle with three mirrors; its 48 images, welded along the mirrors, are the whole sphere.
#include <cstdio>

#include "orbitutte/embed.h"
#include "orbitutte/export/tiling.h"
#include "orbitutte/samples/sample.h"

int main() {
  using namespace orbitutte;
  const Mesh mesh = sample_mesh({SampleShape::mask, 4000});
  const Target target = parse_orbifold("*432");
  const EmbedResult result = embed(mesh, target, choose_cones(mesh, target));
  const Tiling tiling = weld_copies(result.embedding);
  write_tiling("sphere.glb", tiling);

  const long long edges = tiling.mesh.F.rows() * 3 / 2;
  std::printf("%d tiles, %lld vertices - %lld edges + %lld faces = %lld; see sphere.glb\n",
              tiling.copy_count(), static_cast<long long>(tiling.mesh.V.rows()), edges,
              static_cast<long long>(tiling.mesh.F.rows()),
              tiling.mesh.V.rows() - edges + tiling.mesh.F.rows());
  return result.certificate.bijective ? 0 : 1;
}
