// SPDX-License-Identifier: MIT
// One disk onto one triangle twice (figure 9): as the tile of the orbifold *222, where boundary vertices
// slide on mirrors, and with the boundary held. The first is nearly conformal, the second is sheared.
#include <Eigen/LU>
#include <cstdio>
#include <utility>

#include "orbitutte/embed.h"
#include "orbitutte/orbifold/polygon.h"
#include "orbitutte/samples/sample.h"

using namespace orbitutte;

// The triangle onto which an embedding with three corners goes, counterclockwise.
std::vector<PolygonCorner> triangle_of(const Embedding& embedding) {
  std::vector<PolygonCorner> corners;
  Matrix3 positions;
  for (const ConeCopies& cone : embedding.cones) {
    positions.row(static_cast<Eigen::Index>(corners.size())) = embedding.positions.row(cone.vertex);
    corners.push_back({cone.vertex, embedding.positions.row(cone.vertex)});
  }
  if (positions.determinant() < 0) std::swap(corners[1], corners[2]);
  return corners;
}

void print(const char* name, const EmbedResult& result) {
  std::printf("  %-22s energy / twice the area %.4f, angle distortion: mean %.4f, max %.2f\n", name,
              result.minimum.energy / (2 * result.certificate.expected_area), result.distortion.angle.mean,
              result.distortion.angle.max);
}

int main() {
  bool certified = true;
  for (const int faces : {1000, 4000, 16000}) {
    const Mesh mesh = sample_mesh({SampleShape::mask, faces});
    std::vector<int> corners = sample_cones(SampleShape::mask, mesh);
    corners.resize(3);

    EmbedOptions options;
    options.weights.kind = WeightKind::cotan;  // the paper's
    const EmbedResult free = embed(mesh, parse_orbifold("*222"), corners, options);
    const Target triangle = polygon_target(triangle_of(free.embedding));
    const EmbedResult fixed = embed(mesh, triangle, corner_vertices(triangle), options);

    std::printf("%d faces\n", faces);
    print("mirrors (*222)", free);
    print("held, by arc length", fixed);
    certified = certified && free.certificate.bijective && fixed.certificate.bijective;
  }
  return certified ? 0 : 1;
}
