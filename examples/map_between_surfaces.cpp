// SPDX-License-Identifier: MIT
// Two surfaces, one orbifold: out by the embedding of the first, back by that of the second. Between two
// meshes of one surface that map is the identity but for the meshes' edges, and comes closer to it as they
// get finer.
#include <Eigen/Geometry>
#include <cstdio>

#include "orbitutte/embed.h"
#include "orbitutte/io/mesh_io.h"
#include "orbitutte/map/point_map.h"
#include "orbitutte/samples/sample.h"

using namespace orbitutte;

// Where each vertex of the first mesh lies on the second, n x 3.
Points map_between(const Mesh& first, const Embedding& out, const Mesh& second, const Embedding& back) {
  const SurfacePoints found = PointLocator(back).locate(out.canonical_positions().topRows(first.V.rows()));
  Points images(first.V.rows(), 3);
  for (int v = 0; v < found.count(); ++v) {
    images.row(v).setZero();
    for (int k = 0; k < 3; ++k) {
      const int corner = back.source_vertex[back.triangles(found.triangle[v], k)];
      images.row(v) += found.barycentric(v, k) * second.V.row(corner);
    }
  }
  return images;
}

// The same surface, turned and twice as large: a conformal map does not see the difference.
Mesh turned(Mesh mesh) {
  const Matrix3 turn = Eigen::AngleAxisd(1, Vector3(1, 2, 3).normalized()).toRotationMatrix();
  mesh.V *= 2 * turn.transpose();
  return mesh;
}

int main() {
  const Target target = parse_orbifold("432");
  bool certified = true;
  for (const int faces : {1000, 4000, 16000}) {
    const Mesh first = sample_mesh({SampleShape::figure, faces});
    const Mesh second = sample_mesh({SampleShape::figure, faces * 3 / 2});  // other vertices, other triangles
    const EmbedResult out = embed(first, target, sample_cones(SampleShape::figure, first));
    const EmbedResult back = embed(turned(second), target, sample_cones(SampleShape::figure, second));
    const Points images = map_between(first, out.embedding, second, back.embedding);

    const auto distance = (images - first.V).rowwise().norm();
    std::printf("%6d onto %6d faces: vertices move by %.2f %% of the height in the mean, %.2f %% at most\n",
                faces, faces * 3 / 2, 50 * distance.mean(),
                50 * distance.maxCoeff());              // it is about 2 units high
    write_mesh("remeshed.obj", Mesh{images, first.F});  // the second surface in the first one's triangles
    certified = certified && out.certificate.bijective && back.certificate.bijective;
  }
  return certified ? 0 : 1;
}
