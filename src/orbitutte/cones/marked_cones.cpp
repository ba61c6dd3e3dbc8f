// SPDX-License-Identifier: MIT
#include "orbitutte/cones/marked_cones.h"

#include <fmt/format.h>

#include <algorithm>

#include "orbitutte/cones/extremities.h"
#include "orbitutte/orbifold/target_words.h"

namespace orbitutte {
MarkedCones marked_cones(const Surface& surface, const std::string& signature,
                         const std::vector<int>& vertices, const std::vector<double>& angles) {
  if (vertices.size() != angles.size())
    throw ArgumentError(
        fmt::format("there are {} marked vertices, but {} angles; give one angle for each vertex",
                    vertices.size(), angles.size()));
  const std::vector<char> on_boundary = surface.boundary_vertices();
  const Topology topology = topology_of_cones(signature);
  const auto is_corner = [&](int v) {
    return topology == Topology::disk && v >= 0 && v < surface.vertex_count() && on_boundary[v] != 0;
  };
  MarkedCones result;
  std::vector<Mark> marks;
  for (const bool takes_corners : {false, true}) {
    for (std::size_t k = 0; k < vertices.size(); ++k) {
      if (is_corner(vertices[k]) != takes_corners) continue;
      marks.push_back({angles[k], takes_corners ? ConeKind::corner : ConeKind::rotation});
      result.vertices.push_back(vertices[k]);
    }
  }
  result.target = cone_target(topology, std::move(marks));
  return result;
}

MarkedCones cones_at_extremities(const Surface& surface, const std::string& signature,
                                 const std::vector<double>& angles) {
  const bool is_disk = topology_of_cones(signature) == Topology::disk;
  if (surface.topology != topology_of_cones(signature))
    throw MeshError(fmt::format("the mesh is a {}, but {} needs a {}", text_of(surface.topology), signature,
                                text_of(topology_of_cones(signature))));
  const int count = static_cast<int>(angles.size());
  const WantedExtremities wanted = {is_disk ? 0 : count, is_disk ? count : 0};
  return marked_cones(surface, signature, choose_extremities(surface, wanted), angles);
}

}  // namespace orbitutte
