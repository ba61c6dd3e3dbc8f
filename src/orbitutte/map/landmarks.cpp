// SPDX-License-Identifier: MIT
#include "orbitutte/map/landmarks.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <numbers>
#include <string>
#include <unordered_map>

#include "orbitutte/orbifold/cone_target.h"
#include "orbitutte/orbifold/signature.h"

namespace orbitutte {
namespace {

using std::numbers::pi;

// One of the two surfaces, with its vertices of the landmarks.
struct MarkedSurface {
  const Surface& surface;
  char name;
  std::vector<int> vertices;
};

std::vector<int> vertices_of(const std::vector<Landmark>& landmarks, int Landmark::*vertex) {
  std::vector<int> result;
  result.reserve(landmarks.size());
  for (const Landmark& landmark : landmarks) result.push_back(landmark.*vertex);
  return result;
}

void require_same_topology(const Surface& a, const Surface& b) {
  if (a.topology != b.topology)
    throw MeshError(
        fmt::format("surface A is a {}, but surface B is a {}; a map between them needs two of one topology",
                    name_of(a.topology), name_of(b.topology)));
  if (a.topology != Topology::sphere && a.topology != Topology::disk)
    throw MeshError(fmt::format(
        "both surfaces are a {}; maps are made between spheres and between disks{}", name_of(a.topology),
        a.topology == Topology::projective_plane
            ? ", since the targets of projective planes have one mark alone, which holds no landmarks but one"
            : ""));
}

void require_vertices(const MarkedSurface& side) {
  std::vector<char> is_used(side.surface.vertex_count(), 0);
  for (const int v : side.surface.triangles.reshaped()) is_used[v] = 1;
  std::unordered_map<int, int> landmark_at;
  for (int k = 0; k < static_cast<int>(side.vertices.size()); ++k) {
    const int v = side.vertices[k];
    if (v < 0 || v >= side.surface.vertex_count())
      throw MeshError(fmt::format("landmark {} is vertex {} of {}, which has the vertices 0 to {}", k, v,
                                  side.name, side.surface.vertex_count() - 1));
    if (!is_used[v])
      throw MeshError(fmt::format(
          "landmark {} is vertex {} of {}, which belongs to no face; take a vertex of the surface", k, v,
          side.name));
    if (const auto [at, is_new] = landmark_at.try_emplace(v, k); !is_new)
      throw MeshError(
          fmt::format("landmarks {} and {} are both vertex {} of {}; give each a vertex of its own",
                      at->second, k, v, side.name));
  }
}

// Where the landmarks lie along the boundary, from the first of them on: indices into the list.
std::vector<int> order_on_boundary(const MarkedSurface& side, const std::vector<int>& on_boundary) {
  if (on_boundary.empty()) return {};
  const Surface& surface = side.surface;
  std::unordered_map<int, int> next, landmark_at;
  for (int h = 0; h < static_cast<int>(surface.connectivity.opposite.size()); ++h)
    if (surface.connectivity.opposite[h] < 0)
      next[halfedge_origin(surface.triangles, h)] = halfedge_target(surface.triangles, h);
  for (const int k : on_boundary) landmark_at[side.vertices[k]] = k;
  const int start = side.vertices[on_boundary.front()];
  std::vector<int> order;
  int v = start;
  do {
    if (const auto at = landmark_at.find(v); at != landmark_at.end()) order.push_back(at->second);
    v = next.at(v);
  } while (v != start);
  return order;
}

void require_same_order(const std::vector<int>& of_a, const std::vector<int>& of_b) {
  if (of_a == of_b) return;
  std::vector<int> turned = of_b;
  std::reverse(turned.begin() + 1, turned.end());
  if (turned == of_a)
    throw MeshError(
        "the boundary of B meets the landmarks in the opposite direction to that of A; if B is a mirror "
        "image, turn its faces over");
  throw MeshError(fmt::format(
      "the boundary of A meets the landmarks in the order {}, but that of B in the order {}; correct them",
      fmt::join(of_a, ","), fmt::join(of_b, ",")));
}

void require_enough(Topology topology, const LandmarkPlaces& places) {
  const int inside = static_cast<int>(places.inside.size()),
            outside = static_cast<int>(places.on_boundary.size());
  if (topology == Topology::sphere && inside > 0 && inside < 3)
    throw MeshError(fmt::format("{} landmark{} between two spheres; give three or more, or none for a guess",
                                inside, inside == 1 ? "" : "s"));
  if (topology == Topology::disk && inside + outside > 0 && 2 * inside + outside < 3)
    throw MeshError(fmt::format(
        "{} landmark{} on the boundary and {} inside; between two disks, give three on the boundary, one "
        "there and one inside, or more",
        outside, outside == 1 ? "" : "s", inside));
}

}  // namespace

LandmarkPlaces landmark_places(const Surface& a, const Surface& b, const std::vector<Landmark>& landmarks) {
  require_same_topology(a, b);
  const std::array<MarkedSurface, 2> sides = {
      {{a, 'A', vertices_of(landmarks, &Landmark::a)}, {b, 'B', vertices_of(landmarks, &Landmark::b)}}};
  for (const MarkedSurface& side : sides) require_vertices(side);
  const std::vector<char> a_boundary = a.boundary_vertices(), b_boundary = b.boundary_vertices();
  LandmarkPlaces places;
  for (int k = 0; k < static_cast<int>(landmarks.size()); ++k) {
    const bool is_on_a = a_boundary[landmarks[k].a] != 0, is_on_b = b_boundary[landmarks[k].b] != 0;
    if (is_on_a != is_on_b)
      throw MeshError(fmt::format(
          "landmark {} lies {} A at vertex {}, but {} B at vertex {}; take a vertex of the other kind", k,
          is_on_a ? "on the boundary of" : "inside", landmarks[k].a,
          is_on_b ? "on the boundary of" : "inside", landmarks[k].b));
    (is_on_a ? places.on_boundary : places.inside).push_back(k);
  }
  const std::vector<int> of_a = order_on_boundary(sides[0], places.on_boundary);
  require_same_order(of_a, order_on_boundary(sides[1], places.on_boundary));
  places.on_boundary = of_a;
  require_enough(a.topology, places);
  return places;
}

Target landmark_target(Topology topology, const LandmarkPlaces& places) {
  const std::size_t inside = places.inside.size(), outside = places.on_boundary.size();
  if (topology == Topology::sphere && inside <= 4) return parse_orbifold(std::string(inside, '2'));
  if (topology == Topology::sphere)
    return parse_orbifold(fmt::format("{}", fmt::join(std::vector<int>(inside, 2), ",")));
  if (inside == 0 && outside <= 4) return parse_orbifold(fmt::format("*{}", std::string(outside, '2')));
  return flat_landmark_target(topology, places);
}

Target flat_landmark_target(Topology topology, const LandmarkPlaces& places) {
  const std::size_t inside = places.inside.size(), outside = places.on_boundary.size();
  const double deficit =
      2 * pi / static_cast<double>(topology == Topology::sphere ? inside : outside + 2 * inside);
  std::vector<Mark> marks(inside, Mark{2 * pi - 2 * deficit, ConeKind::rotation});
  marks.insert(marks.end(), outside, Mark{pi - deficit, ConeKind::corner});
  return cone_target(topology, std::move(marks));
}

}  // namespace orbitutte
