// SPDX-License-Identifier: MIT
#include "orbitutte/export/tiled_faces.h"

#include <fmt/format.h>

#include <algorithm>
#include <span>
#include <utility>

namespace orbitutte {
namespace {

using Corners = std::span<const int>;

// Do both lie on some mirror?
bool share_mirror(const MirrorsOfVertices& mirrors, int v, int w) {
  for (const int mirror : mirrors[v])
    if (mirror >= 0 && (mirror == mirrors[w][0] || mirror == mirrors[w][1])) return true;
  return false;
}

bool lies_on(const MirrorsOfVertices& mirrors, int v, int mirror) {
  return mirrors[v][0] == mirror || mirrors[v][1] == mirror;
}

// All vertices on one and the same mirror.
bool is_arc(const MirrorsOfVertices& mirrors, const Corners& face) {
  const auto& first = mirrors[face.front()];
  return std::any_of(first.begin(), first.end(), [&](int mirror) {
    return mirror >= 0 &&
           std::all_of(face.begin(), face.end(), [&](int v) { return lies_on(mirrors, v, mirror); });
  });
}

int mirror_count(const MirrorsOfVertices& mirrors, int v) {
  return static_cast<int>(std::count_if(mirrors[v].begin(), mirrors[v].end(), [](int m) { return m >= 0; }));
}

// The corner whose removal leaves a side that lies on no mirror. Of several, the one on the most mirrors, so
// that corners inside the tile remain until the end. -1 if there is none.
int corner_to_cut(const MirrorsOfVertices& mirrors, const std::vector<int>& ring) {
  const int n = static_cast<int>(ring.size());
  int best = -1;
  for (int k = 0; k < n; ++k) {
    if (share_mirror(mirrors, ring[(k + n - 1) % n], ring[(k + 1) % n])) continue;
    if (best < 0 || mirror_count(mirrors, ring[k]) > mirror_count(mirrors, ring[best])) best = k;
  }
  return best;
}

class Selection {
 public:
  Selection(const Embedding& embedding, const MirrorsOfVertices& mirrors)
      : embedding_(embedding), mirrors_(mirrors) {}

  TiledFaces run() {
    const FaceView faces = embedding_.faces();
    int triangle = 0;  // the first of the face
    for (int f = 0; f < faces.count(); ++f) {
      const int triangles = static_cast<int>(faces[f].size()) - 2;
      if (is_arc(mirrors_, faces[f])) {
        result_.left_out.push_back(f);
      } else {
        take(f, faces[f], triangle);
      }
      triangle += triangles;
    }
    require_no_chord();
    const auto count = static_cast<Eigen::Index>(corners_.size() / 3);
    result_.triangles = Eigen::Map<const Triangles>(corners_.data(), count, 3);
    return std::move(result_);
  }

 private:
  void take(int f, const Corners& face, int first_triangle) {
    result_.input_faces.push_back(f);
    note_sides_on_mirrors(face);
    const int triangles = static_cast<int>(face.size()) - 2;
    result_.face_of.insert(result_.face_of.end(), triangles, f);
    if (triangles == 1 || !has_diagonal_on_mirror(face, first_triangle)) {
      const int* const begin = embedding_.triangles.data() + 3 * std::ptrdiff_t{first_triangle};
      corners_.insert(corners_.end(), begin, begin + 3 * std::ptrdiff_t{triangles});
    } else {
      divide(f, face);
    }
    if (embedding_.polygons.count() == 0) return;
    result_.polygons.corners.insert(result_.polygons.corners.end(), face.begin(), face.end());
    result_.polygons.start.push_back(static_cast<int>(result_.polygons.corners.size()));
  }

  bool has_diagonal_on_mirror(const Corners& face, int first_triangle) const {
    const auto is_side = [&](int v, int w) {
      for (std::size_t k = 0; k < face.size(); ++k) {
        const int a = face[k], b = face[(k + 1) % face.size()];
        if ((a == v && b == w) || (a == w && b == v)) return true;
      }
      return false;
    };
    for (int t = first_triangle; t < first_triangle + static_cast<int>(face.size()) - 2; ++t)
      for (int k = 0; k < 3; ++k) {
        const int v = embedding_.triangles(t, k), w = embedding_.triangles(t, (k + 1) % 3);
        if (share_mirror(mirrors_, v, w) && !is_side(v, w)) return true;
      }
    return false;
  }

  // Polygons are convex, so any corner may be cut off.
  void divide(int f, const Corners& face) {
    std::vector<int> ring(face.begin(), face.end());
    while (ring.size() > 3) {
      const int k = corner_to_cut(mirrors_, ring), n = static_cast<int>(ring.size());
      if (k < 0)
        throw MeshError(fmt::format(
            "face {} of the input cannot be divided into triangles none of which coincides with its mirror "
            "image, so that its copies make up no closed mesh; divide it by an edge in the input",
            f));
      corners_.insert(corners_.end(), {ring[(k + n - 1) % n], ring[k], ring[(k + 1) % n]});
      ring.erase(ring.begin() + k);
    }
    corners_.insert(corners_.end(), ring.begin(), ring.end());
  }

  void note_sides_on_mirrors(const Corners& face) {
    for (std::size_t k = 0; k < face.size(); ++k) {
      const auto [v, w] = std::minmax(face[k], face[(k + 1) % face.size()]);
      if (share_mirror(mirrors_, v, w)) on_mirrors_.emplace_back(v, w);
    }
  }

  // An edge of two faces with both ends on a mirror.
  void require_no_chord() {
    std::sort(on_mirrors_.begin(), on_mirrors_.end());
    const auto chord = std::adjacent_find(on_mirrors_.begin(), on_mirrors_.end());
    if (chord == on_mirrors_.end()) return;
    throw MeshError(fmt::format(
        "edge ({}, {}) of the input joins two vertices of one mirror, so that it coincides with its "
        "mirror image and the copies make up no closed mesh; split the edge by a vertex and embed "
        "the mesh again",
        embedding_.source_vertex[chord->first], embedding_.source_vertex[chord->second]));
  }

  const Embedding& embedding_;
  const MirrorsOfVertices& mirrors_;
  std::vector<int> corners_;                     // of the triangles
  std::vector<std::pair<int, int>> on_mirrors_;  // sides of faces
  TiledFaces result_;
};

}  // namespace

TiledFaces tiled_faces(const Embedding& embedding, const MirrorsOfVertices& mirrors) {
  return Selection(embedding, mirrors).run();
}

}  // namespace orbitutte
