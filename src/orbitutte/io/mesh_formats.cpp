// SPDX-License-Identifier: MIT
#include "orbitutte/io/mesh_formats.h"

#include <fmt/format.h>

#include <limits>

namespace orbitutte {

std::string room_for_text(const Mesh& mesh) {
  constexpr std::string_view longest_number = "-2.2250738585072014e-308", longest_index = "-2147483648";
  constexpr std::string_view around_three_numbers = "v   \n", around_three_indices = "3    \n";
  std::string text;
  text.reserve(mesh.V.rows() * (3 * longest_number.size() + around_three_numbers.size()) +
               mesh.F.rows() * (3 * longest_index.size() + around_three_indices.size()));
  return text;
}

int checked_count(std::size_t count, std::string_view things) {
  constexpr int most = std::numeric_limits<int>::max();
  if (count <= most) return static_cast<int>(count);
  throw MeshError(fmt::format("the mesh has more than {} {}; simplify it", most, things));
}

void end_face(PolygonMesh& mesh) {
  mesh.face_start.push_back(checked_count(mesh.corners.size(), "corners of faces"));
}

Points to_points(const std::vector<double>& coordinates) {
  const int count = checked_count(coordinates.size() / 3, "vertices");
  return Eigen::Map<const Points>(coordinates.data(), count, 3);
}

}  // namespace orbitutte
