// SPDX-License-Identifier: MIT
#include "orbitutte/map/joined_overlay.h"

#include <algorithm>
#include <utility>

namespace orbitutte {
namespace {

// Names what a vertex of the overlay is on one of the surfaces.
void name_on_whole(const DividedEars& ears, int& vertex, int& halfedge) {
  if (halfedge >= 0) halfedge = ears.whole_halfedge(halfedge);
  if (vertex < 0 || !ears.is_middle(vertex)) return;
  halfedge = ears.halfedge_of_middle(vertex);
  vertex = -1;
}

bool are_same_points(const SurfacePoints& x, const SurfacePoints& y) {
  return x.triangle == y.triangle && x.barycentric == y.barycentric;
}

}  // namespace

Overlay joined_overlay(Overlay of_parts, const DividedEars& a, const DividedEars& b) {
  Overlay result = of_parts;
  for (OverlayVertex& v : result.vertices) {
    name_on_whole(a, v.a_vertex, v.a_halfedge);
    name_on_whole(b, v.b_vertex, v.b_halfedge);
  }
  for (OverlayFace& face : result.parents) {
    face.a = a.whole_triangle(face.a);
    face.b = b.whole_triangle(face.b);
  }
  result.on_a = a.on_whole(std::move(result.on_a));
  result.on_b = b.on_whole(std::move(result.on_b));
  result.of_parts = std::make_shared<const Overlay>(std::move(of_parts));
  return result;
}

bool say_the_same(const Overlay& x, const Overlay& y) {
  const auto are_same_vertices = [](const OverlayVertex& v, const OverlayVertex& w) {
    return v.a_vertex == w.a_vertex && v.b_vertex == w.b_vertex && v.a_halfedge == w.a_halfedge &&
           v.b_halfedge == w.b_halfedge;
  };
  const auto are_same_parents = [](const OverlayFace& f, const OverlayFace& g) {
    return f.a == g.a && f.b == g.b && f.placement == g.placement;
  };
  return std::equal(x.vertices.begin(), x.vertices.end(), y.vertices.begin(), y.vertices.end(),
                    are_same_vertices) &&
         std::equal(x.parents.begin(), x.parents.end(), y.parents.begin(), y.parents.end(),
                    are_same_parents) &&
         x.faces.start == y.faces.start && x.faces.corners == y.faces.corners &&
         are_same_points(x.on_a, y.on_a) && are_same_points(x.on_b, y.on_b);
}

}  // namespace orbitutte
