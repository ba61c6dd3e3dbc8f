// SPDX-License-Identifier: MIT
// One surface onto another, so that landmarks come to lie on their partners: both are embedded into one
// orbifold, and what lies at the same point of it corresponds. Between two meshes of one surface that map is
// the identity but for the meshes' edges, and comes closer to it as they get finer.
#include <Eigen/Geometry>
#include <cstdio>

#include "orbitutte/inspect/recognition.h"
#include "orbitutte/io/mesh_io.h"
#include "orbitutte/map/composed_map.h"
#include "orbitutte/map/surface_map.h"
#include "orbitutte/samples/sample.h"

using namespace orbitutte;

// The same surface, turned and twice as large: a conformal map does not see the difference.
Mesh turned(Mesh mesh) {
  const Matrix3 turn = Eigen::AngleAxisd(1, Vector3(1, 2, 3).normalized()).toRotationMatrix();
  mesh.V *= 2 * turn.transpose();
  return mesh;
}

// Head, foot and hand of both figures.
std::vector<Landmark> landmarks_of(const Mesh& first, const Mesh& second) {
  const std::vector<int> a = sample_cones(SampleShape::figure, first),
                         b = sample_cones(SampleShape::figure, second);
  std::vector<Landmark> landmarks;
  for (std::size_t k = 0; k < a.size(); ++k) landmarks.push_back({a[k], b[k]});
  return landmarks;
}

int main() {
  bool certified = true;
  for (const int faces : {1000, 4000, 16000}) {
    const Mesh first = sample_mesh({SampleShape::figure, faces});
    const Mesh second = sample_mesh({SampleShape::figure, faces * 3 / 2});  // other vertices, other triangles
    const Surface a = make_surface(first), b = make_surface(turned(second));
    const SurfaceMap map = map_between(a, b, landmarks_of(first, second));
    const ComposedMap composed = compose(a, b, map);
    const Points images =
        transfer(composed.a_to_b, second.V);  // where the vertices of A lie on B, turned back

    const auto distance = (images - first.V).rowwise().norm();
    std::printf("%6d onto %6d faces: vertices move by %.2f %% of the height in the mean, %.2f %% at most\n",
                faces, faces * 3 / 2, 50 * distance.mean(),
                50 * distance.maxCoeff());              // it is about 2 units high
    write_mesh("remeshed.obj", Mesh{images, first.F});  // the second surface in the first one's triangles
    certified = certified && map.is_bijective() && composed.certificate.holds;
  }
  return certified ? 0 : 1;
}
