// SPDX-License-Identifier: MIT
#include "orbitutte/export/sphere_surface.h"

#include <fmt/format.h>

namespace orbitutte {

PolygonMesh sphere_surface(const Embedding& embedding, double radius) {
  if (embedding.space() != Space::sphere())
    throw ArgumentError(
        fmt::format("the map onto {} is not on the sphere, and only spheres are written as surfaces; embed "
                    "with --orbifold 1",
                    embedding.target.signature));
  constexpr double largest = 1e30;  // such files keep single precision
  if (!(radius > 0)) throw ArgumentError(fmt::format("--radius is {}; give a positive number", radius));
  if (!(radius <= largest))
    throw ArgumentError(
        fmt::format("--radius is {}, more than single precision holds; give at most {}", radius, largest));
  PolygonMesh mesh;
  mesh.V = radius * embedding.positions;
  const FaceView faces = embedding.faces();
  mesh.corners.reserve(static_cast<std::size_t>(faces.start(faces.count())));
  mesh.face_start.reserve(faces.count() + std::size_t{1});
  for (int f = 0; f < faces.count(); ++f) {
    mesh.corners.insert(mesh.corners.end(), faces[f].begin(), faces[f].end());
    mesh.face_start.push_back(static_cast<int>(mesh.corners.size()));
  }
  return mesh;
}

}  // namespace orbitutte
