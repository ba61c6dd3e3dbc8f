// SPDX-License-Identifier: MIT
// A program of somebody else: embeds a sample mesh and asks for its certificate.
#include <orbitutte/embed.h>
#include <orbitutte/samples/sample.h>
#include <orbitutte/version.h>

#include <cstdio>

int main() {
  using namespace orbitutte;
  const Mesh mesh = sample_mesh({SampleShape::figure, 2000});
  const Target target = parse_orbifold("432");
  EmbedResult result = embed(mesh, target, choose_cones(mesh, target));
  result.embedding.positions.resize(0, 3);  // frees here what the library allocated
  try {
    parse_orbifold("no symbol");
  } catch (const ArgumentError&) {  // thrown there, caught here
    std::printf("orbitutte %s: bijective %d\n", version, result.certificate.bijective);
    return result.certificate.bijective ? 0 : 1;
  }
  return 2;
}
