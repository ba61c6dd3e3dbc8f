// SPDX-License-Identifier: MIT
#include "orbitutte/solve/ears.h"

#include <Eigen/Geometry>
#include <algorithm>

namespace orbitutte {
namespace {

// Collects the ears of one mirror after the other.
class EarSearch {
 public:
  EarSearch(const FaceView& faces, int vertex_count)
      : faces_(faces), faces_at_(vertex_count, 0), last_face_(vertex_count, -1), side_of_(vertex_count, -1) {
    for (int f = 0; f < faces.count(); ++f) {
      for (const int v : faces[f]) {
        ++faces_at_[v];
        last_face_[v] = f;
      }
    }
  }

  void search(int s, const std::vector<int>& side, const Vector3& outward) {
    for (const int v : side) side_of_[v] = s;
    for (std::size_t k = 1; k + 1 < side.size(); ++k) {
      if (faces_at_[side[k]] != 1) continue;
      const int face = last_face_[side[k]];
      std::size_t end = k + 1;  // the tips of a face follow each other
      while (end + 1 < side.size() && faces_at_[side[end]] == 1 && last_face_[side[end]] == face) ++end;
      if (std::all_of(faces_[face].begin(), faces_[face].end(), [&](int w) { return side_of_[w] == s; }))
        for (std::size_t tip = k; tip < end; ++tip)
          ears.push_back({face, side[tip], {side[k - 1], side[end]}, outward});
      k = end - 1;
    }
  }

  std::vector<Ear> ears;

 private:
  const FaceView& faces_;
  std::vector<int> faces_at_, last_face_, side_of_;  // of every cut vertex
};

}  // namespace

std::vector<Ear> find_ears(const FaceView& faces, const Tile& tile, const BoundaryConditions& boundary) {
  std::vector<int> straight;  // sides whose vertices stay on them
  for (int s = 0; s < static_cast<int>(tile.sides.size()); ++s)
    if (tile.sides[s].held() || tile.sides[s].partner == s) straight.push_back(s);
  if (straight.empty()) return {};
  EarSearch search(faces, static_cast<int>(boundary.transform_of.size()));
  for (const int s : straight) search.search(s, boundary.sides[s], tile.sides[s].outward());
  return std::move(search.ears);
}

int count_faces(const std::vector<Ear>& ears) {
  int faces = 0, last = -1;
  for (const Ear& ear : ears) {
    faces += ear.face != last;
    last = ear.face;
  }
  return faces;
}

void round_outward(const std::vector<Ear>& ears, Points& positions) {
  for (const Ear& ear : ears) positions.row(ear.tip) += outward_rounding * ear.outward.transpose();
}

}  // namespace orbitutte
