// SPDX-License-Identifier: MIT
#include "orbitutte/map/composed_map.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace orbitutte {
namespace {

double landmark_error(const Surface& b, const SurfaceMap& map, const VertexMap& a_to_b) {
  double largest = 0;
  for (const Landmark& landmark : map.landmarks) {
    Vector3 image = Vector3::Zero();
    for (int k = 0; k < 3; ++k)
      image += a_to_b.images.barycentric(landmark.a, k) * Vector3(b.V.row(a_to_b.corners(landmark.a, k)));
    largest = std::max(largest, (image - Vector3(b.V.row(landmark.b))).norm());
  }
  return largest / std::sqrt(b.total_area());
}

ComposedMap composed_of(const Surface& a, const Surface& b, const SurfaceMap& map) {
  const Embedding &on_a = map.a.embedding, &on_b = map.b.embedding;
  ComposedMap result;
  result.overlay = overlay(on_a, on_b);
  VertexMaps maps = vertex_maps(result.overlay, on_a, on_b);
  result.a_to_b = std::move(maps.a_to_b);
  result.b_to_a = std::move(maps.b_to_a);
  result.certificate = certify(result.overlay, on_a, on_b);
  result.overlay_on_a = positions_on(a.V, on_a, result.overlay.on_a);
  result.overlay_on_b = positions_on(b.V, on_b, result.overlay.on_b);
  result.distortion =
      measure_map(overlay_triangles(result.overlay).triangles, result.overlay_on_a, result.overlay_on_b);
  result.landmark_error = landmark_error(b, map, result.a_to_b);
  return result;
}

}  // namespace

ComposedMap compose(const Surface& a, const Surface& b, const SurfaceMap& map) {
  return with_threads(map.a.threads, [&] { return composed_of(a, b, map); });
}

}  // namespace orbitutte
