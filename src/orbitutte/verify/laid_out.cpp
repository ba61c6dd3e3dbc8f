// SPDX-License-Identifier: MIT
#include "orbitutte/verify/laid_out.h"

#include <queue>

#include "orbitutte/verify/corner_layout.h"

namespace orbitutte {
namespace {

using Corner = CornerLayout::Corner;

// The corners of a coarse triangle f: those of the fine triangles count f .. count (f + 1) - 1 that lie at
// its vertices, all in the frame of the last of these, which lies in the middle.
class CoarseTriangles {
 public:
  CoarseTriangles(const Triangles& coarse, const CornerLayout& layout)
      : coarse_(coarse),
        layout_(layout),
        count_(static_cast<int>(layout.triangles().rows() / coarse.rows())) {}

  std::array<Corner, 3> corners(int f) const {
    std::array<Corner, 3> found;
    std::vector<char> seen(count_, 0);
    std::queue<std::pair<int, Isometry>> open;
    const auto enter = [&](int fine, const Isometry& into) {
      if (fine / count_ != f || seen[fine % count_]) return;
      seen[fine % count_] = 1;
      open.emplace(fine, into);
    };
    for (enter(count_ * f + count_ - 1, {}); !open.empty(); open.pop()) {
      const auto [fine, into] = open.front();
      for (int h = 3 * fine; h < 3 * fine + 3; ++h) {
        for (int k = 0; k < 3; ++k)
          if (halfedge_origin(layout_.triangles(), h) == coarse_(f, k))
            found[k] = layout_.moved(into, layout_.corner(h));
        if (const int g = layout_.opposite(h); g >= 0) enter(g / 3, into * layout_.beyond(h));
      }
    }
    return found;
  }

 private:
  const Triangles& coarse_;
  const CornerLayout& layout_;
  int count_;  // of the fine triangles in a coarse one
};

// Is triangle f turned over in the cut mesh, its second and third vertex exchanged?
bool is_turned(const Surface& surface, const Embedding& embedding, int f) {
  const auto cut = embedding.triangles.row(f);
  const auto source = [&](int k) { return embedding.source_vertex[cut[k % 3]]; };
  int k = 0;
  while (source(k) != surface.triangles(f, 0)) ++k;
  return source(k + 1) != surface.triangles(f, 1);
}

}  // namespace

Embedding laid_out(const Surface& surface, const Embedding& embedding,
                   const IntrinsicTriangulation& triangulation) {
  CornerLayout layout(surface, embedding);
  for (const Flip& flip : triangulation.flips) layout.flip(flip.h);
  return embedding_of_corners(embedding, surface.triangle_count(), [&](int h) { return layout.corner(h); });
}

Embedding sampled_on(const Triangles& coarse, const Surface& fine, const Embedding& embedding) {
  const CornerLayout layout(fine, embedding);
  const CoarseTriangles triangles(coarse, layout);
  const int count = static_cast<int>(fine.triangles.rows() / coarse.rows());
  std::array<Corner, 3> corners;  // of the triangle whose first corner was asked for last
  return embedding_of_corners(embedding, static_cast<int>(coarse.rows()), [&](int h) {
    if (h % 3 == 0) {
      corners = triangles.corners(h / 3);
      if (is_turned(fine, embedding, count * (h / 3 + 1) - 1)) std::swap(corners[1], corners[2]);
    }
    return corners[h % 3];
  });
}

}  // namespace orbitutte
