// SPDX-License-Identifier: MIT
#include "orbitutte/cut/cut.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <unordered_map>
#include <utility>

#include "orbitutte/cut/one_sided_loop.h"
#include "orbitutte/parallel.h"

namespace orbitutte {
namespace {

// A random number in [0, 1) for an edge and a seed, the same on every machine (the mixing function of
// SplitMix64).
double random_unit(std::uint64_t seed, std::uint64_t edge) {
  std::uint64_t z = seed * 0x9e3779b97f4a7c15ULL + edge * 0xbf58476d1ce4e5b9ULL + 0x94d049bb133111ebULL;
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ULL;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebULL;
  return static_cast<double>((z ^ (z >> 31)) >> 11) * 0x1.0p-53;
}

void perturb_lengths(EdgeGraph& graph, std::uint64_t seed) {
  if (seed == 0) return;
  for (std::size_t e = 0; e < graph.length.size(); ++e) graph.length[e] *= 1 + 2 * random_unit(seed, e);
}

double straight_distance(const Surface& surface, int i, int j) {
  return (surface.V.row(i) - surface.V.row(j)).norm();
}

// Chooses which of three marks the cut passes through: the one nearest to the other two in space, or one that
// the seed decides.
int middle_mark(const Surface& surface, const std::vector<int>& marks, std::uint64_t seed) {
  if (seed != 0) return static_cast<int>(3 * random_unit(seed, 0));
  const auto detour = [&](int k) {
    return straight_distance(surface, marks[k], marks[(k + 1) % 3]) +
           straight_distance(surface, marks[k], marks[(k + 2) % 3]);
  };
  int best = 0;
  for (const int k : {1, 2})
    if (detour(k) < detour(best)) best = k;
  return best;
}

MeshError no_path(int i, int j) {
  return MeshError(fmt::format("no edge path joins the marked vertices {} and {}; mark others", i, j));
}

Path path_through_two(const EdgeGraph& graph, const std::vector<int>& marks) {
  Path path = shortest_path(graph, marks[0], {marks[1]});
  if (path.empty()) throw no_path(marks[0], marks[1]);
  return path;
}

// The distance in space of every vertex to the nearer of two.
std::vector<double> straight_distances(const Surface& surface, const std::array<int, 2>& to) {
  std::vector<double> result(surface.vertex_count());
  parallel_ranges(surface.vertex_count(), [&](int begin, int end) {
    for (int v = begin; v < end; ++v)
      result[v] = std::min(straight_distance(surface, v, to[0]), straight_distance(surface, v, to[1]));
  });
  return result;
}

Path path_through_three(const Surface& surface, const EdgeGraph& graph, const std::vector<int>& marks,
                        std::uint64_t seed) {
  const int middle = middle_mark(surface, marks, seed);
  const int first = marks[(middle + 2) % 3], last = marks[(middle + 1) % 3];
  auto [back, forth] =
      disjoint_paths(graph, marks[middle], {first, last}, straight_distances(surface, {first, last}));
  if (back.empty()) throw no_path(marks[middle], first);
  std::reverse(back.begin(), back.end());
  back.insert(back.end(), forth.begin() + 1, forth.end());
  return back;
}

Path path_through(const Surface& surface, const EdgeGraph& graph, const std::vector<int>& marks,
                  std::uint64_t seed) {
  if (marks.size() == 2) return path_through_two(graph, marks);
  return path_through_three(surface, graph, marks, seed);
}

// A half-edge that leaves each vertex (-1 if no face uses it). At a boundary vertex it lies on the boundary.
std::vector<int> outgoing_halfedges(const Triangles& F, const std::vector<int>& opposite, int vertex_count) {
  std::vector<int> result(vertex_count, -1);
  for (int h = 0; h < static_cast<int>(F.size()); ++h) {
    int& out = result[halfedge_origin(F, h)];
    if (out < 0 || opposite[h] < 0) out = h;
  }
  return result;
}

void check_marks(const std::vector<int>& marks, const std::vector<int>& outgoing) {
  const int n = static_cast<int>(outgoing.size());
  for (std::size_t k = 0; k < marks.size(); ++k) {
    if (marks[k] < 0 || marks[k] >= n)
      throw MeshError(fmt::format("the marked vertex {} is out of range; the mesh has the vertices 0 to {}",
                                  marks[k], n - 1));
    if (std::count(marks.begin(), marks.begin() + k, marks[k]))
      throw MeshError(fmt::format("the vertex {} is marked twice; mark different vertices", marks[k]));
    if (outgoing[marks[k]] < 0)
      throw MeshError(
          fmt::format("the marked vertex {} belongs to no face; mark a vertex of the surface", marks[k]));
  }
}

void check_marks_of_disk(const std::vector<int>& marks, int inner_marks,
                         const std::vector<char>& on_boundary) {
  for (int k = 0; k < static_cast<int>(marks.size()); ++k) {
    if (k >= inner_marks && !on_boundary[marks[k]])
      throw MeshError(
          fmt::format("the marked vertex {} is inside the disk; mark a vertex on its boundary", marks[k]));
    if (k < inner_marks && on_boundary[marks[k]])
      throw MeshError(
          fmt::format("the marked vertex {} is on the boundary of the disk; mark a vertex inside", marks[k]));
  }
}

void check_number_of_marks_of_disk(const std::vector<int>& marks, int inner_marks) {
  if (inner_marks > 1 || (inner_marks == 1 && marks.size() > 2))
    throw MeshError(
        fmt::format("{} of {} marked vertices are inside the disk; mark one inside, and at most one on the "
                    "boundary",
                    inner_marks, marks.size()));
}

void check_number_of_marks(const std::vector<int>& marks, bool one_sided) {
  if (marks.empty() && !one_sided) return;
  const std::size_t fewest = one_sided ? 1 : 2, most = one_sided ? 1 : 3;
  if (marks.size() < fewest || marks.size() > most)
    throw MeshError(fmt::format("{} marked vertices on a {}", marks.size(),
                                one_sided ? "projective plane; mark one" : "sphere; mark two or three"));
}

// The path from the mark inside a disk to the nearest unmarked vertex of the boundary. It meets the boundary
// only at its end, since it would otherwise cut the disk in two.
Path path_to_boundary(EdgeGraph graph, const std::vector<int>& marks, const std::vector<char>& on_boundary) {
  std::vector<int> to;
  for (int v = 0; v < graph.vertex_count(); ++v)
    if (on_boundary[v] && std::find(marks.begin(), marks.end(), v) == marks.end()) to.push_back(v);
  graph.dead_end = on_boundary;
  Path path = shortest_path(graph, marks[0], to);
  if (path.empty())
    throw MeshError(fmt::format(
        "no edge path leads from the marked vertex {} to the boundary; mark another vertex", marks[0]));
  return path;
}

struct CutPath {
  Path vertices;
  std::vector<int> edges;
};

CutPath with_edges(Path path, const EdgeGraph& graph) {
  CutPath result = {std::move(path), {}};
  for (std::size_t k = 1; k < result.vertices.size(); ++k)
    result.edges.push_back(edge_between(graph, result.vertices[k - 1], result.vertices[k]));
  return result;
}

// The input mesh with its half-edges opened along the cut. Faces are turned over if the surface has no
// orientation.
struct OpenedMesh {
  CutMesh cut;
  std::vector<int> opposite;  // -1 on the boundary and at the cut
};

CutMesh uncut(const Surface& surface) {
  CutMesh cut;
  cut.F = surface.triangles;
  cut.source_vertex.resize(surface.V.rows());
  for (int v = 0; v < cut.vertex_count(); ++v) cut.source_vertex[v] = v;
  return cut;
}

OpenedMesh opened_along(const std::vector<int>& edges, const Surface& surface) {
  OpenedMesh result = {uncut(surface), surface.connectivity.opposite};
  if (edges.empty()) return result;
  const Connectivity& connectivity = surface.connectivity;
  std::vector<char> is_cut(connectivity.edges.size(), 0);
  for (const int e : edges) is_cut[e] = 1;
  parallel_ranges(static_cast<int>(result.opposite.size()), [&](int begin, int end) {
    for (int h = begin; h < end; ++h)
      if (const int e = connectivity.edge_of[h]; e >= 0 && is_cut[e]) result.opposite[h] = -1;
  });
  return result;
}

// Turns faces of a surface without orientation over so that all agree once it is cut.
void turn_faces(OpenedMesh& mesh) {
  const Triangles F = mesh.cut.F;
  mesh.cut.F = agreeing_faces(F, mesh.opposite);
  for (Eigen::Index f = 0; f < F.rows(); ++f) mesh.cut.turned.push_back(mesh.cut.F(f, 1) != F(f, 1));
  const std::vector<int> opposite = mesh.opposite;
  const auto moved = [&](int h) { return mesh.cut.source_halfedge(h); };  // which undoes itself
  for (int h = 0; h < static_cast<int>(opposite.size()); ++h)
    mesh.opposite[moved(h)] = opposite[h] < 0 ? -1 : moved(opposite[h]);
}

// The first half-edge on the boundary of the opened mesh that leaves vertex v.
int boundary_halfedge(int v, const OpenedMesh& mesh) {
  int h = 0;
  while (mesh.opposite[h] >= 0 || halfedge_origin(mesh.cut.F, h) != v) ++h;
  return h;
}

// Gives the vertex another index in the faces of one sector: those from the boundary half-edge `begin` to the
// one that arrives at its origin.
void renumber_sector(int begin, int vertex, const std::vector<int>& opposite, Triangles& F) {
  for (int h = begin; h >= 0; h = opposite[previous_halfedge(h)]) F.data()[h] = vertex;
}

// The vertex where the boundary of an unmarked disk begins: the first that lies on it and in more than one
// face, so that no tip of an ear is an end of the mirror.
int start_of_boundary(const Surface& surface, const std::vector<char>& on_boundary) {
  std::vector<int> faces_at(on_boundary.size(), 0);
  const FaceView faces = surface.faces();
  for (int f = 0; f < faces.count(); ++f)
    for (const int v : faces[f]) ++faces_at[v];
  int first = -1;
  for (int v = 0; v < static_cast<int>(on_boundary.size()); ++v) {
    if (!on_boundary[v]) continue;
    if (faces_at[v] > 1) return v;
    if (first < 0) first = v;
  }
  return first;
}

// The half-edge on the boundary that follows another one.
int next_on_boundary(int h, const std::vector<int>& opposite) {
  h = next_halfedge(h);
  while (opposite[h] >= 0) h = next_halfedge(opposite[h]);
  return h;
}

// The boundary of the opened mesh from a half-edge on, all the way around.
std::vector<int> boundary_walk(int start, const OpenedMesh& mesh) {
  std::vector<int> walk;
  int h = start;
  do {
    walk.push_back(h);
    h = next_on_boundary(h, mesh.opposite);
  } while (h != start);
  return walk;
}

// Follows the boundary. The first time it passes a vertex, the faces there keep its index; every further time
// they get a new copy.
CutMesh split_along_boundary(const std::vector<int>& walk, OpenedMesh mesh) {
  CutMesh& cut = mesh.cut;
  std::vector<char> passed(cut.source_vertex.size(), 0);
  for (const int h : walk) {
    const int v = halfedge_origin(cut.F, h);
    int vertex = v;
    if (passed[v]) {
      vertex = cut.vertex_count();
      cut.source_vertex.push_back(v);
    }
    passed[v] = 1;
    renumber_sector(h, vertex, mesh.opposite, cut.F);
    cut.boundary.push_back(vertex);
  }
  return std::move(cut);
}

std::vector<int> order_met(const std::vector<int>& boundary, const std::vector<int>& source,
                           const std::vector<int>& marks) {
  std::unordered_map<int, int> mark_of;
  for (std::size_t k = 0; k < marks.size(); ++k) mark_of[marks[k]] = static_cast<int>(k);
  std::vector<int> order;
  for (const int v : boundary) {
    const auto mark = mark_of.find(source[v]);
    if (mark == mark_of.end()) continue;
    order.push_back(mark->second);
    mark_of.erase(mark);
  }
  return order;
}

// Do the marks go around in their order, in one direction or the other?
bool goes_around(const std::vector<int>& arrangement) {
  const int count = static_cast<int>(arrangement.size());
  const auto follows = [count](int mark, int next) { return next == (mark + 1) % count; };
  const auto precedes = [count](int mark, int next) { return mark == (next + 1) % count; };
  const auto all = [&](const auto& related) {
    return std::adjacent_find(arrangement.begin(), arrangement.end(),
                              [&](int mark, int next) { return !related(mark, next); }) == arrangement.end();
  };
  return all(follows) || all(precedes);
}

void check_order_met(const std::vector<int>& arrangement, const std::vector<int>& marks) {
  if (goes_around(arrangement)) return;
  std::vector<int> met;
  met.reserve(arrangement.size());
  for (const int mark : arrangement) met.push_back(marks[mark]);
  throw MeshError(
      fmt::format("the boundary meets the marked vertices in the order {}, not {}; mark them in that order",
                  fmt::join(met, ","), fmt::join(marks, ",")));
}

// Trees.

std::vector<int> vertices_on(const std::vector<char>& on_boundary) {
  std::vector<int> result;
  for (std::size_t v = 0; v < on_boundary.size(); ++v)
    if (on_boundary[v]) result.push_back(static_cast<int>(v));
  return result;
}

// The edges of the tree from the roots to the other marks inside.
std::vector<int> tree_of_marks(const Surface& surface, const std::vector<int>& roots,
                               const std::vector<int>& marks, const CutOptions& options) {
  if (marks.empty()) return {};
  EdgeGraph graph = edge_length_graph(surface);
  perturb_lengths(graph, options.seed);
  std::vector<int> edges = tree_edges(graph, roots, marks);
  if (edges.empty())
    throw MeshError(fmt::format("no edge path joins the marked vertex {} to the cut; mark another vertex",
                                marks.front()));
  return edges;
}

// The first vertex of the boundary where an edge of the cut ends.
int end_of_tree(const Surface& surface, const std::vector<int>& edges, const std::vector<char>& on_boundary) {
  int first = static_cast<int>(on_boundary.size());
  for (const int e : edges)
    for (const int v : surface.connectivity.edges[e])
      if (on_boundary[v]) first = std::min(first, v);
  return first;
}

// The half-edge along which the walk around a cut disk leaves a vertex of its boundary: that which follows
// the surface's own boundary there, so that all cuts that end at the vertex come first.
int first_halfedge_at(int vertex, const Surface& surface, const OpenedMesh& opened) {
  int h = 0;
  while (surface.connectivity.opposite[h] >= 0 || halfedge_target(surface.triangles, h) != vertex) ++h;
  return next_on_boundary(h, opened.opposite);
}

// Where sides begin along the walk: at marks, and where the cut does not just pass.
std::vector<CutSide> beginnings_of_sides(const std::vector<int>& walk, const Surface& surface,
                                         const std::vector<int>& marks,
                                         const std::vector<char>& on_boundary) {
  std::unordered_map<int, int> visits;
  for (const int h : walk) ++visits[halfedge_origin(surface.triangles, h)];
  std::vector<CutSide> sides;
  for (int k = 0; k < static_cast<int>(walk.size()); ++k) {
    const int v = halfedge_origin(surface.triangles, walk[k]), passing = on_boundary[v] ? 1 : 2;
    if (visits[v] != passing || std::find(marks.begin(), marks.end(), v) != marks.end())
      sides.push_back({k, static_cast<int>(sides.size())});
  }
  return sides;
}

// The sides along the walk, each with its partner: the one that begins with the edge with which it ends.
std::vector<CutSide> sides_of_tree(const std::vector<int>& walk, const Surface& surface,
                                   const std::vector<int>& marks, const std::vector<char>& on_boundary) {
  std::vector<CutSide> sides = beginnings_of_sides(walk, surface, marks, on_boundary);
  std::unordered_map<int, int> ending_with;  // an edge of the cut
  for (std::size_t s = 0; s < sides.size(); ++s) {
    const int first = walk[sides[s].begin];
    const int last = walk[s + 1 < sides.size() ? sides[s + 1].begin - 1 : static_cast<int>(walk.size()) - 1];
    if (surface.connectivity.opposite[first] < 0) continue;
    const auto partner = ending_with.find(surface.connectivity.edge_of[first]);
    if (partner != ending_with.end()) {
      sides[s].partner = partner->second;
      sides[partner->second].partner = static_cast<int>(s);
    } else {
      ending_with[surface.connectivity.edge_of[last]] = static_cast<int>(s);
    }
  }
  return sides;
}

// The marks on the boundary of the surface, the first `inner_marks` left out, as the cut mesh meets them.
void check_order_on_boundary(const CutMesh& cut, const std::vector<int>& marks, int inner_marks) {
  std::vector<int> arrangement;
  for (const int mark : cut.arrangement)
    if (mark >= inner_marks && mark < static_cast<int>(marks.size()))
      arrangement.push_back(mark - inner_marks);
  check_order_met(arrangement, {marks.begin() + inner_marks, marks.end()});
}

void check_marks_of_tree(const Surface& surface, const std::vector<int>& marks, int inner_marks,
                         const std::vector<char>& on_boundary) {
  check_marks(marks,
              outgoing_halfedges(surface.triangles, surface.connectivity.opposite, surface.vertex_count()));
  const bool is_closed = std::find(on_boundary.begin(), on_boundary.end(), 1) == on_boundary.end();
  if (marks.size() < (is_closed ? 2 : 1))
    throw MeshError(fmt::format("a cut through {} marked vertices; mark more", marks.size()));
  if (!is_closed) check_marks_of_disk(marks, inner_marks, on_boundary);
}

// The marks of a cut, of which the first lie inside.
struct CutMarks {
  const std::vector<int>& all;
  int inner = 0;
};

// Opens the surface along the edges of a tree that joins the marks inside, and, on a disk, the boundary.
CutMesh cut_along_edges(const Surface& surface, const CutMarks& marks, const std::vector<int>& edges,
                        const std::vector<char>& on_boundary) {
  const bool is_closed = std::find(on_boundary.begin(), on_boundary.end(), 1) == on_boundary.end();
  OpenedMesh opened = opened_along(edges, surface);
  std::vector<int> all_marks = marks.all;
  if (!is_closed && marks.inner == static_cast<int>(marks.all.size()))
    all_marks.push_back(end_of_tree(surface, edges, on_boundary));
  const int start = is_closed ? boundary_halfedge(all_marks[0], opened)
                              : first_halfedge_at(all_marks[marks.inner], surface, opened);
  const std::vector<int> walk = boundary_walk(start, opened);
  CutMesh cut = split_along_boundary(walk, std::move(opened));
  cut.marks = all_marks;
  cut.arrangement = order_met(cut.boundary, cut.source_vertex, cut.marks);
  if (!is_closed) check_order_on_boundary(cut, marks.all, marks.inner);
  cut.sides = sides_of_tree(walk, surface, cut.marks, on_boundary);
  return cut;
}

// A path that never meets itself, nor marks before it comes to them.
class Tour {
 public:
  Tour(EdgeGraph graph, const std::vector<int>& marks) : graph_(std::move(graph)) {
    graph_.dead_end.assign(graph_.vertex_count(), 0);
    for (const int v : marks) block(v);
  }

  // No path passes through the vertex from now on.
  void block(int v) { graph_.dead_end[v] = 1; }

  void go(int from, int to) { go_to_nearest(from, {to}); }

  // Takes the shortest path that is left. Where vertices of the tour shut it off, nothing is.
  void go_to_nearest(int from, const std::vector<int>& to) {
    graph_.dead_end[from] = 0;
    const Path path = shortest_path(graph_, from, to);
    if (path.empty())
      throw MeshError(fmt::format(
          "the cut through the marked vertices before {} leaves no edge path on from there; mark them in "
          "another order, or make the mesh finer",
          from));
    for (std::size_t k = 1; k < path.size(); ++k)
      edges_.push_back(edge_between(graph_, path[k - 1], path[k]));
    for (const int v : path) block(v);
  }

  const std::vector<int>& edges() const { return edges_; }

 private:
  EdgeGraph graph_;
  std::vector<int> edges_;
};

}  // namespace

EdgeGraph edge_length_graph(const Surface& surface) {
  const std::vector<std::array<int, 2>>& edges = surface.connectivity.edges;
  EdgeGraph graph = {vertex_neighbors(edges, surface.vertex_count()), std::vector<double>(edges.size()), {}};
  const double total = parallel_sum(static_cast<int>(graph.length.size()), [&](int e) {
    const auto [i, j] = edges[e];
    return graph.length[e] = straight_distance(surface, i, j);
  });
  const double tiny = total > 0 ? 1e-6 * total / static_cast<double>(graph.length.size()) : 1.0;
  for (double& length : graph.length) length += tiny;
  return graph;
}

CutMesh cut_to_disk(const Surface& surface, const std::vector<int>& marks, int inner_marks,
                    const CutOptions& options) {
  const std::vector<int>& opposite = surface.connectivity.opposite;
  const std::vector<int> outgoing = outgoing_halfedges(surface.triangles, opposite, surface.vertex_count());
  check_marks(marks, outgoing);
  const std::vector<char> on_boundary = surface.boundary_vertices();
  const bool closed = std::find(on_boundary.begin(), on_boundary.end(), 1) == on_boundary.end();
  const bool one_sided =
      closed && surface.topology != Topology::sphere && has_turned_faces(surface.triangles, opposite);
  if (closed) check_number_of_marks(marks, one_sided);
  if (!closed) {
    check_marks_of_disk(marks, inner_marks, on_boundary);
    check_number_of_marks_of_disk(marks, inner_marks);
  }
  if (closed && marks.empty()) return uncut(surface);
  CutPath path = {{marks.empty() ? start_of_boundary(surface, on_boundary) : marks[0]},
                  {}};  // if nothing is cut
  if (closed || inner_marks > 0) {
    EdgeGraph graph = edge_length_graph(surface);
    perturb_lengths(graph, options.seed);
    path = with_edges(one_sided ? one_sided_loop(graph, surface, marks[0])
                      : closed  ? path_through(surface, graph, marks, options.seed)
                                : path_to_boundary(graph, marks, on_boundary),
                      graph);
  }
  OpenedMesh opened = opened_along(path.edges, surface);
  if (one_sided) turn_faces(opened);
  const std::vector<int> walk = boundary_walk(boundary_halfedge(path.vertices.front(), opened), opened);
  CutMesh cut = split_along_boundary(walk, std::move(opened));
  cut.marks = marks;
  if (!closed && (inner_marks > 0 || marks.empty())) cut.marks.push_back(path.vertices.back());
  cut.arrangement = order_met(cut.boundary, cut.source_vertex, cut.marks);
  if (!closed) check_order_met(cut.arrangement, cut.marks);
  return cut;
}

CutMesh cut_along_tree(const Surface& surface, const std::vector<int>& marks, int inner_marks,
                       const CutOptions& options) {
  const std::vector<char> on_boundary = surface.boundary_vertices();
  check_marks_of_tree(surface, marks, inner_marks, on_boundary);
  const std::vector<int> outer = vertices_on(on_boundary);
  const bool is_closed = outer.empty();
  const std::vector<int> inner(marks.begin() + (is_closed ? 1 : 0), marks.begin() + inner_marks);
  return cut_along_edges(surface, {marks, inner_marks},
                         tree_of_marks(surface, is_closed ? std::vector{marks[0]} : outer, inner, options),
                         on_boundary);
}

CutMesh cut_along_tour(const Surface& surface, const std::vector<int>& marks, int inner_marks,
                       const CutOptions& options) {
  const std::vector<char> on_boundary = surface.boundary_vertices();
  check_marks_of_tree(surface, marks, inner_marks, on_boundary);
  EdgeGraph graph = edge_length_graph(surface);
  perturb_lengths(graph, options.seed);
  Tour tour(std::move(graph), marks);
  for (int v = 0; v < surface.vertex_count(); ++v)
    if (on_boundary[v]) tour.block(v);
  const bool is_closed = vertices_on(on_boundary).empty();
  const bool has_corner = inner_marks < static_cast<int>(marks.size());
  if (!is_closed && has_corner && inner_marks > 0) tour.go(marks[inner_marks], marks[0]);
  if (!is_closed && !has_corner) tour.go_to_nearest(marks[0], vertices_on(on_boundary));
  for (int k = 1; k < inner_marks; ++k) tour.go(marks[k - 1], marks[k]);
  return cut_along_edges(surface, {marks, inner_marks}, tour.edges(), on_boundary);
}

}  // namespace orbitutte
