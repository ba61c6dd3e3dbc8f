// SPDX-License-Identifier: MIT
// Edges, fans, components, orientation, boundary and genus. Counting sorts and sorts of short ranges give
// orders, and disjoint sets give connections, so no mesh is too large or too broken.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <utility>

#include "orbitutte/inspect/coincidence.h"
#include "orbitutte/inspect/inspection_steps.h"

namespace orbitutte::inspection {

void find_edges(InspectedMesh& s) {
  const auto lower = [&](int h) { return s.well_formed(s.face_of[h]) ? s.lower(h) : -1; };
  Groups by_lower = group_by(s.corner_count(), s.mesh.vertex_count(), lower);
  auto& half_edges = by_lower.items;
  for (int v = 0; v < by_lower.size(); ++v) {
    std::sort(half_edges.begin() + by_lower.start[v], half_edges.begin() + by_lower.start[v + 1],
              [&](int g, int h) { return std::pair(s.upper(g), g) < std::pair(s.upper(h), h); });
  }
  s.edges.start.clear();
  for (int i = 0; i < static_cast<int>(half_edges.size()); ++i) {
    const bool same = i > 0 && s.lower(half_edges[i]) == s.lower(half_edges[i - 1]) &&
                      s.upper(half_edges[i]) == s.upper(half_edges[i - 1]);
    if (!same) s.edges.start.push_back(i);
  }
  s.edges.start.push_back(static_cast<int>(half_edges.size()));
  s.edges.items = std::move(half_edges);
}

DisjointSets corner_fans(const InspectedMesh& s) {
  DisjointSets fans(s.corner_count());
  for (int e = 0; e < s.edge_count(); ++e) {
    if (s.faces_on(e) != 2) continue;
    const int g = s.half_edge(e, 0), h = s.half_edge(e, 1);
    for (const int v : {s.origin(g), s.target(g)}) fans.unite(s.corner_at(v, g), s.corner_at(v, h));
  }
  return fans;
}

namespace {

void report_edges(const InspectedMesh& s, Inspection& result) {
  int edges = 0, first = -1;
  for (int e = 0; e < s.edge_count(); ++e) {
    if (s.faces_on(e) <= 2) continue;
    if (edges++ == 0) first = e;
  }
  if (edges == 0) return;
  std::vector<int> faces;
  faces.reserve(s.faces_on(first));
  for (int i = 0; i < s.faces_on(first); ++i) faces.push_back(s.face_of[s.half_edge(first, i)]);
  add(result, DefectKind::non_manifold_edge, edges,
      fmt::format("edge ({}, {}) belongs to {} faces ({}){}; remove the extra faces so that every edge has "
                  "one or two",
                  s.lower(s.half_edge(first, 0)), s.upper(s.half_edge(first, 0)), faces.size(), listed(faces),
                  such(edges, "edges")));
}

// Vertices of malformed faces, and of faces on an edge with too many faces. They may have one fan once those
// are mended.
std::vector<char> excused_vertices(const InspectedMesh& s) {
  std::vector<char> face_excused(s.mesh.face_count(), 0), excused(s.mesh.vertex_count(), 0);
  for (int e = 0; e < s.edge_count(); ++e) {
    for (int i = 0; s.faces_on(e) > 2 && i < s.faces_on(e); ++i)
      face_excused[s.face_of[s.half_edge(e, i)]] = 1;
  }
  for (int c = 0; c < s.corner_count(); ++c) {
    const int f = s.face_of[c];
    if (!face_excused[f] && s.state[f] != FaceState::malformed) continue;
    if (in_range(s.mesh, s.mesh.corners[c])) excused[s.mesh.corners[c]] = 1;
  }
  return excused;
}

void report_vertices(const InspectedMesh& s, Inspection& result) {
  DisjointSets fan_of = corner_fans(s);
  const auto starts_fan = [&](int c) { return s.well_formed(s.face_of[c]) && fan_of.find(c) == c; };
  std::vector<int> fans(s.mesh.vertex_count(), 0);
  for (int c = 0; c < s.corner_count(); ++c) {
    if (starts_fan(c)) ++fans[s.mesh.corners[c]];
  }
  const std::vector<char> excused = excused_vertices(s);
  int vertices = 0, first = -1;
  for (int v = 0; v < s.mesh.vertex_count(); ++v) {
    if (fans[v] < 2 || excused[v]) continue;
    if (vertices++ == 0) first = v;
  }
  if (vertices == 0) return;
  std::vector<int> faces;
  for (int c = 0; c < s.corner_count(); ++c) {
    if (s.mesh.corners[c] == first && starts_fan(c)) faces.push_back(s.face_of[c]);
  }
  add(result, DefectKind::non_manifold_vertex, vertices,
      fmt::format("the faces around vertex {} form {} fans that meet only there (one of each: faces {}){}; "
                  "give every fan "
                  "its own copy of the vertex",
                  first, faces.size(), listed(faces), such(vertices, "vertices")));
}

// A component: what is connected through the corners of faces.
struct Component {
  int vertex = -1;  // its smallest one
  int vertices = 0;
  int edges = 0;
  int faces = 0;  // well-formed ones
  bool orientable = true;
  std::vector<int> curves;  // indices into Inspection::boundary

  int euler_characteristic() const { return vertices - edges + faces; }
  bool projective_plane() const { return !orientable && curves.empty() && euler_characteristic() == 1; }
  // 2 - 2 g = chi + b.
  int genus() const {
    return orientable ? (2 - euler_characteristic() - static_cast<int>(curves.size())) / 2 : 0;
  }
};

struct Components {
  std::vector<int> of_vertex;   // -1 where no well-formed face is connected to the vertex
  std::vector<Component> list;  // in the order of their smallest vertices

  Component& of(int vertex) { return list[of_vertex[vertex]]; }
};

Components find_components(const InspectedMesh& s) {
  DisjointSets connected(s.mesh.vertex_count());
  std::vector<char> referenced(s.mesh.vertex_count(), 0), used(s.mesh.vertex_count(), 0);
  for (int c = 0; c < s.corner_count(); ++c) {
    const int v = s.origin(c), w = s.target(c);
    if (!in_range(s.mesh, v)) continue;
    referenced[v] = 1;
    if (s.well_formed(s.face_of[c])) used[v] = 1;
    if (in_range(s.mesh, w)) connected.unite(v, w);
  }
  for (int v = 0; v < s.mesh.vertex_count(); ++v) {
    if (used[v]) used[connected.find(v)] = 1;
  }
  Components result;
  result.of_vertex.assign(s.mesh.vertex_count(), -1);
  for (int v = 0; v < s.mesh.vertex_count(); ++v) {
    const int root = connected.find(v);
    if (!referenced[v] || !used[root]) continue;
    if (root == v) {
      result.of_vertex[v] = static_cast<int>(result.list.size());
      result.list.emplace_back().vertex = v;
    }
    result.of_vertex[v] = result.of_vertex[root];
    ++result.of(v).vertices;
  }
  for (int e = 0; e < s.edge_count(); ++e) ++result.of(s.origin(s.half_edge(e, 0))).edges;
  for (int f = 0; f < s.mesh.face_count(); ++f) {
    if (s.well_formed(f)) ++result.of(s.mesh.corners[s.mesh.face_start[f]]).faces;
  }
  return result;
}

// "the surface"; or the component by its smallest vertex if there are several.
std::string subject(const Components& components, const Component& component) {
  return components.list.size() == 1 ? "the surface"
                                     : fmt::format("the component of vertex {}", component.vertex);
}

std::string welding_advice(const InspectedMesh& s) {
  std::vector<std::array<int, 2>> boundary;
  for (int e = 0; e < s.edge_count(); ++e)
    if (s.faces_on(e) == 1) boundary.push_back({s.lower(s.half_edge(e, 0)), s.upper(s.half_edge(e, 0))});
  return orbitutte::welding_advice(find_coincidence(s.mesh.V, boundary));
}

void report_components(const InspectedMesh& s, Components components, Inspection& result) {
  auto& list = components.list;
  result.components = static_cast<int>(list.size());
  // A face with an index out of range may connect them.
  if (result.components < 2 || has(result, DefectKind::index_out_of_range)) return;
  std::stable_sort(list.begin(), list.end(), [](const auto& a, const auto& b) { return a.faces > b.faces; });
  std::vector<int> sizes;
  sizes.reserve(list.size());
  for (const Component& component : list) sizes.push_back(component.faces);
  add(result, DefectKind::several_components, result.components,
      fmt::format("the surface has {} components, of {} faces, the first around vertex {}, the second around "
                  "vertex {}; keep "
                  "one of them or join them{}",
                  result.components, listed(sizes), list[0].vertex, list[1].vertex,
                  in_brackets(welding_advice(s))));
}

// The two sides of every face, f and f + m, united where one passes into the other across an edge of two
// faces: the orientation double cover. A component is orientable unless it contains both sides of a face in
// one set.
DisjointSets face_sides(const InspectedMesh& s) {
  const int m = s.mesh.face_count();
  DisjointSets sides(2 * m);
  for (int e = 0; e < s.edge_count(); ++e) {
    if (s.faces_on(e) != 2) continue;
    const int f = s.face_of[s.half_edge(e, 0)], g = s.face_of[s.half_edge(e, 1)];
    const int turn = s.runs_twice(e) ? m : 0;
    sides.unite(f, g + turn);
    sides.unite(f + m, g + m - turn);
  }
  return sides;
}

void find_orientability(const InspectedMesh& s, Components& components) {
  const int m = s.mesh.face_count();
  DisjointSets sides = face_sides(s);
  for (int f = 0; f < m; ++f) {
    if (s.well_formed(f) && sides.find(f) == sides.find(f + m))
      components.of(s.mesh.corners[s.mesh.face_start[f]]).orientable = false;
  }
}

// The first edge of a component that two faces run through in the same direction, and how many there are.
// Faces that are given twice are not counted, since either of the two may have to go.
struct Clash {
  int edge = -1;
  int count = 0;
};

template <typename Concerned>
Clash find_clashes(const InspectedMesh& s, const Concerned& concerned) {
  Clash result;
  for (int e = 0; e < s.edge_count(); ++e) {
    if (s.faces_on(e) != 2 || !s.runs_twice(e) || !concerned(e)) continue;
    if (result.count++ == 0) result.edge = e;
  }
  return result;
}

std::string clash_of(const InspectedMesh& s, int edge) {
  const int g = s.half_edge(edge, 0), h = s.half_edge(edge, 1);
  return fmt::format("faces {} and {} run through edge ({}, {}) in the same direction", s.face_of[g],
                     s.face_of[h], s.lower(g), s.upper(g));
}

void report_orientation(const InspectedMesh& s, Components& components, Inspection& result) {
  const Clash clash = find_clashes(s, [&](int e) {
    const int g = s.half_edge(e, 0), h = s.half_edge(e, 1);
    return components.of(s.origin(g)).orientable && !s.has_double[s.face_of[g]] &&
           !s.has_double[s.face_of[h]];
  });
  if (clash.count == 0) return;
  add(result, DefectKind::inconsistent_orientation, clash.count,
      fmt::format("{}{}; turn faces until all are counterclockwise seen from outside",
                  clash_of(s, clash.edge), such(clash.count, "edges")));
}

// The two neighbours of every boundary vertex along the boundary, its successor along the faces' half-edges
// first if the faces agree; -1 in the interior. Manifold vertices have no third.
std::vector<std::array<int, 2>> boundary_neighbors(const InspectedMesh& s) {
  std::vector<std::array<int, 2>> result(s.mesh.vertex_count(), {-1, -1});
  const auto put = [&](int v, int slot, int neighbor) {
    result[v][result[v][slot] < 0 ? slot : 1 - slot] = neighbor;
  };
  for (int e = 0; e < s.edge_count(); ++e) {
    if (s.faces_on(e) != 1) continue;
    const int h = s.half_edge(e, 0);
    put(s.origin(h), 0, s.target(h));
    put(s.target(h), 1, s.origin(h));
  }
  return result;
}

std::vector<std::vector<int>> boundary_curves(const InspectedMesh& s) {
  const auto neighbors = boundary_neighbors(s);
  std::vector<char> visited(s.mesh.vertex_count(), 0);
  std::vector<std::vector<int>> curves;
  for (int first = 0; first < s.mesh.vertex_count(); ++first) {
    if (visited[first] || neighbors[first][0] < 0) continue;
    std::vector<int>& curve = curves.emplace_back();
    int previous = neighbors[first][1], v = first;
    while (!visited[v]) {
      visited[v] = 1;
      curve.push_back(v);
      const int next = neighbors[v][0] == previous ? neighbors[v][1] : neighbors[v][0];
      previous = std::exchange(v, next);
    }
  }
  std::stable_sort(curves.begin(), curves.end(),
                   [](const auto& a, const auto& b) { return a.size() > b.size(); });
  return curves;
}

void report_holes(const InspectedMesh& s, const Components& components, Inspection& result) {
  int curves = 0;
  const Component* first = nullptr;
  for (const Component& component : components.list) {
    if (component.curves.size() < 2) continue;
    curves += static_cast<int>(component.curves.size());
    if (!first) first = &component;
  }
  if (!first) return;
  std::vector<int> lengths, vertices;
  for (const int c : first->curves) {
    lengths.push_back(static_cast<int>(result.boundary[c].size()));
    vertices.push_back(result.boundary[c].front());
  }
  add(result, DefectKind::holes, curves,
      fmt::format("{} has {} holes, of {} edges, through vertices {}; fill all of them for a sphere, or all "
                  "but one for a "
                  "disk{}",
                  subject(components, *first), lengths.size(), listed(lengths), listed(vertices),
                  in_brackets(welding_advice(s))));
}

void report_genus(const Components& components, Inspection& result) {
  int genus = 0;
  const Component* first = nullptr;
  for (const Component& component : components.list) {
    if (component.genus() == 0) continue;
    genus += component.genus();
    if (!first) first = &component;
  }
  if (!first) return;
  const bool one = first->genus() == 1;
  add(result, DefectKind::genus, genus,
      fmt::format("{} has genus {} ({}); an orbifold embedding needs a sphere or a disk: cut {} and close "
                  "the two ends{}",
                  subject(components, *first), first->genus(),
                  one ? "a handle, as a torus has" : fmt::format("{} handles", first->genus()),
                  one ? "the handle" : "every handle", one ? "" : " of each"));
}

void report_non_orientability(const InspectedMesh& s, Components& components, Inspection& result) {
  const auto offends = [](const Component& c) { return !c.orientable && !c.projective_plane(); };
  const auto count = std::count_if(components.list.begin(), components.list.end(), offends);
  if (count == 0) return;
  const Component& first = *std::find_if(components.list.begin(), components.list.end(), offends);
  const Clash clash =
      find_clashes(s, [&](int e) { return &components.of(s.origin(s.half_edge(e, 0))) == &first; });
  const std::size_t holes = first.curves.size();
  add(result, DefectKind::not_orientable, count,
      fmt::format("{} is not orientable (Euler characteristic {}, {} hole{}): {}, and no turning of faces "
                  "makes all agree; an "
                  "orbifold embedding needs a sphere, a disk or a closed projective plane: cut it open",
                  subject(components, first), first.euler_characteristic(),
                  holes == 0 ? "no" : std::to_string(holes), holes == 1 ? "" : "s", clash_of(s, clash.edge)));
}

Topology topology_of(const Component& component) {
  if (component.projective_plane()) return Topology::projective_plane;
  if (!component.orientable || component.genus() != 0) return Topology::other;
  return component.curves.empty()       ? Topology::sphere
         : component.curves.size() == 1 ? Topology::disk
                                        : Topology::other;
}

// Is the mesh a surface: every face well-formed, every edge of one or two faces, every vertex of one fan?
bool is_surface(const Inspection& result) {
  using enum DefectKind;
  const std::array<DefectKind, 5> broken = {index_out_of_range, too_few_corners, repeated_vertex,
                                            non_manifold_edge, non_manifold_vertex};
  return std::none_of(broken.begin(), broken.end(), [&](DefectKind kind) { return has(result, kind); });
}

void classify(const InspectedMesh& s, Components& components, Inspection& result) {
  result.boundary = boundary_curves(s);
  for (int c = 0; c < static_cast<int>(result.boundary.size()); ++c)
    components.of(result.boundary[c].front()).curves.push_back(c);
  for (const Component& component : components.list)
    result.orientable = result.orientable && component.orientable;
  if (components.list.size() == 1) result.genus = components.list[0].genus();

  report_holes(s, components, result);
  report_genus(components, result);
  report_non_orientability(s, components, result);
  if (!result.defects.empty()) return;
  result.topology = topology_of(components.list[0]);
  if (result.topology == Topology::disk) result.welding_advice = welding_advice(s);
}

}  // namespace

void inspect_topology(InspectedMesh& s, Inspection& result) {
  find_edges(s);
  result.edges = s.edge_count();
  report_edges(s, result);
  report_vertices(s, result);

  Components components = find_components(s);
  find_orientability(s, components);
  report_orientation(s, components, result);
  report_components(s, components, result);
  using enum DefectKind;
  if (!has(result, index_out_of_range) && !has(result, too_few_corners) && !has(result, repeated_vertex)) {
    for (const Component& component : components.list)
      result.euler_characteristic += component.euler_characteristic();
  }
  if (is_surface(result)) classify(s, components, result);
}

}  // namespace orbitutte::inspection
