// SPDX-License-Identifier: MIT
#include "orbitutte/cut/cut.h"

#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <functional>
#include <map>
#include <numeric>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "random_spheres.h"

namespace orbitutte::cut_test {
namespace {

using test::face_count;
using test::vertex_count;

/// With all marks on the boundary, or all inside where there is none.
CutMesh cut_open(const Mesh& mesh, const std::vector<int>& marks, std::uint64_t seed = 0) {
  return cut_to_disk(test::unjudged(mesh), marks, 0, {seed});
}

/// With the first mark inside a disk.
CutMesh cut_inside(const Mesh& mesh, const std::vector<int>& marks, std::uint64_t seed = 0) {
  return cut_to_disk(test::unjudged(mesh), marks, 1, {seed});
}

bool same(const CutMesh& a, const CutMesh& b) {
  return a.F == b.F && a.source_vertex == b.source_vertex && a.boundary == b.boundary && a.marks == b.marks &&
         a.arrangement == b.arrangement;
}

// Each check names the fault that it finds; empty where there is none.

/// The faces of the input, on vertices that come from theirs; the first n vertices are the input's own.
std::string fault_in_faces(const Mesh& mesh, const CutMesh& cut) {
  const int n = vertex_count(mesh);
  if (cut.vertex_count() < n || cut.F.rows() != mesh.F.rows()) return "vertices or faces are missing";
  for (int v = 0; v < n; ++v)
    if (cut.source_vertex[v] != v) return "the first vertices are not the input's";
  for (int k = 0; k < mesh.F.size(); ++k) {
    const int v = cut.F.data()[k];
    if (v < 0 || v >= cut.vertex_count()) return "a face has no such vertex";
    if (cut.source_vertex[v] != mesh.F.data()[k]) return "a face is not the input's";
  }
  const std::set<int> used(cut.F.data(), cut.F.data() + cut.F.size());
  for (int v = n; v < cut.vertex_count(); ++v)
    if (!used.count(v)) return "a copy belongs to no face";
  return {};
}

/// The half-edges of the boundary, in its order; fewer where consecutive vertices are joined by none.
std::vector<int> boundary_halfedges(const CutMesh& cut) {
  std::map<std::pair<int, int>, int> halfedge;
  for (int h = 0; h < cut.F.size(); ++h) halfedge[{halfedge_origin(cut.F, h), halfedge_target(cut.F, h)}] = h;
  std::vector<int> result;
  for (std::size_t k = 0; k < cut.boundary.size(); ++k) {
    const auto at = halfedge.find({cut.boundary[k], cut.boundary[(k + 1) % cut.boundary.size()]});
    if (at != halfedge.end()) result.push_back(at->second);
  }
  return result;
}

int component_count(int faces, const std::vector<std::pair<int, int>>& glued) {
  std::vector<int> parent(faces);
  std::iota(parent.begin(), parent.end(), 0);
  const std::function<int(int)> root = [&](int f) {
    return parent[f] == f ? f : parent[f] = root(parent[f]);
  };
  for (const auto& [f, g] : glued) parent[root(f)] = root(g);
  int roots = 0;
  for (int f = 0; f < faces; ++f) roots += parent[f] == f;
  return roots;
}

/// Connected, of Euler characteristic 1, with one boundary curve that meets no vertex twice, and glued like
/// the input everywhere else.
std::string fault_in_disk(const Mesh& mesh, const CutMesh& cut) {
  const std::vector<int> opposite = connectivity_of(mesh.F, vertex_count(mesh)).opposite;
  const std::vector<int> around = boundary_halfedges(cut);
  const std::set<int> outer(around.begin(), around.end());
  const int b = static_cast<int>(cut.boundary.size()), halfedges = static_cast<int>(cut.F.size());
  if (static_cast<int>(outer.size()) != b) return "the boundary does not run along half-edges";
  if (std::set<int>(cut.boundary.begin(), cut.boundary.end()).size() != outer.size())
    return "the boundary touches itself";
  std::vector<std::pair<int, int>> glued;
  for (int h = 0; h < halfedges; ++h) {
    const int o = opposite[h];
    if (outer.count(h)) {
      if (o >= 0 && !outer.count(o)) return "a cut has one side";
      continue;
    }
    if (o < 0 || outer.count(o)) return "there is a boundary beside the boundary";
    if (halfedge_origin(cut.F, o) != halfedge_target(cut.F, h) ||
        halfedge_target(cut.F, o) != halfedge_origin(cut.F, h))
      return "a gap is open";
    glued.emplace_back(h / 3, o / 3);
  }
  if (component_count(face_count(mesh), glued) != 1) return "the mesh falls apart";
  const std::set<int> used(cut.F.data(), cut.F.data() + cut.F.size());
  const int vertices = static_cast<int>(used.size()), edges = b + (halfedges - b) / 2;
  return vertices - edges + halfedges / 3 == 1 ? "" : "the Euler characteristic is not 1";
}

/// All marks on the boundary, which begins at the first of the arrangement and meets them in its order.
std::string fault_in_arrangement(const CutMesh& cut, const std::vector<int>& marks) {
  std::vector<int> met;
  for (const int v : cut.boundary) {
    const auto mark = std::find(marks.begin(), marks.end(), cut.source_vertex[v]) - marks.begin();
    const int k = static_cast<int>(mark);
    if (k < static_cast<int>(marks.size()) && !std::count(met.begin(), met.end(), k)) met.push_back(k);
  }
  if (met.size() != marks.size()) return "a mark is not on the boundary";
  if (met != cut.arrangement) return "the boundary meets the marks in another order";
  if (cut.source_vertex[cut.boundary.front()] != marks[met.front()]) return "the boundary begins at no mark";
  return {};
}

/// The boundary of a sphere runs along the cut and comes back the same way; the ends of the cut are the first
/// and the last mark of the arrangement, and the one between has two copies.
std::string fault_in_seam(const CutMesh& cut, const std::vector<int>& marks) {
  const std::size_t b = cut.boundary.size();
  const auto source = [&](std::size_t k) { return cut.source_vertex[cut.boundary[k % b]]; };
  for (std::size_t k = 0; k < b; ++k)
    if (source(k) != source(b - k)) return "the boundary does not come back the way it went";
  if (b % 2 != 0 || source(b / 2) != marks[cut.arrangement.back()])
    return "the cut does not end at the last mark";
  for (std::size_t k = 0; k < marks.size(); ++k) {
    const bool inner = marks.size() == 3 && cut.arrangement[1] == static_cast<int>(k);
    int copies = 0;
    for (std::size_t i = 0; i < b; ++i) copies += source(i) == marks[k];
    if (copies != (inner ? 2 : 1)) return "a mark has another number of copies";
  }
  return {};
}

std::string fault_in_sphere(const Mesh& mesh, const std::vector<int>& marks, std::uint64_t seed) {
  const CutMesh cut = cut_open(mesh, marks, seed);
  std::string fault = fault_in_faces(mesh, cut);
  if (fault.empty()) fault = fault_in_disk(mesh, cut);
  if (fault.empty()) fault = fault_in_arrangement(cut, marks);
  if (fault.empty()) fault = fault_in_seam(cut, marks);
  if (fault.empty() && !same(cut, cut_open(mesh, marks, seed))) fault = "a second cut is different";
  return fault;
}

/// Cuts through all pairs and all triples of vertices, in every order.
std::string fault_in_any_sphere(const Mesh& mesh, std::uint64_t seed) {
  const int n = vertex_count(mesh);
  for (int a = 0; a < n; ++a) {
    for (int b = 0; b < n; ++b) {
      if (a == b) continue;
      if (const std::string fault = fault_in_sphere(mesh, {a, b}, seed); !fault.empty()) return fault;
      for (int c = 0; c < n; ++c) {
        if (c == a || c == b) continue;
        if (const std::string fault = fault_in_sphere(mesh, {a, b, c}, seed); !fault.empty()) return fault;
      }
    }
  }
  return {};
}

// ------------------------------------------------------------------------------------------------- spheres

TEST(Cut, ThroughAnyVerticesOfATetrahedronGivesADisk) {
  for (const std::uint64_t seed : {0, 1, 2, 3}) EXPECT_EQ(fault_in_any_sphere(test::tetrahedron(), seed), "");
}

TEST(Cut, ThroughAnyVerticesOfAnOctahedronGivesADisk) {
  for (const std::uint64_t seed : {0, 1, 2, 3}) EXPECT_EQ(fault_in_any_sphere(test::octahedron(), seed), "");
}

TEST(Cut, ThroughAnyVerticesWhereAllFacesAreSplitGivesADisk) {
  // Every face of the tetrahedron has a vertex of degree three, whose neighbours are the corners: marks
  // there, and marks all on one face or next to each other, block the obvious second path.
  const Mesh once = test::with_all_faces_split(test::tetrahedron());
  for (const std::uint64_t seed : {0, 1, 2}) EXPECT_EQ(fault_in_any_sphere(once, seed), "");
  EXPECT_EQ(fault_in_any_sphere(test::with_face_split(test::with_face_split(once, 0), 12), 0), "");
}

TEST(Cut, ThroughThreeMarksOfDegreeThreeGivesADisk) {
  const Mesh mesh = test::with_all_faces_split(test::octahedron());  // the new vertices are 6 .. 13
  for (int a = 6; a < 14; ++a)
    for (int b = 6; b < 14; ++b)
      for (int c = 6; c < 14; ++c)
        EXPECT_EQ(a != b && b != c && c != a ? fault_in_sphere(mesh, {a, b, c}, 0) : "", "");
}

TEST(Cut, ThroughAllCornersOfAFaceGivesADisk) {
  const Mesh mesh = test::perturbed(test::icosphere(1), 0.1, 3);
  for (int f = 0; f < face_count(mesh); ++f) {
    const int a = mesh.F(f, 0), b = mesh.F(f, 1), c = mesh.F(f, 2);
    for (const std::uint64_t seed : {0, 5}) {
      EXPECT_EQ(fault_in_sphere(mesh, {a, b, c}, seed), "");
      EXPECT_EQ(fault_in_sphere(mesh, {c, b, a}, seed), "");
    }
  }
}

TEST(Cut, BetweenNeighborsIsOneEdge) {
  const Mesh mesh = test::icosahedron();
  const CutMesh cut = cut_open(mesh, {0, 1});
  EXPECT_EQ(cut.boundary, (std::vector<int>{0, 1}));
  EXPECT_EQ(cut.F, mesh.F);
  EXPECT_EQ(cut.vertex_count(), 12);
}

TEST(Cut, AddsOneCopyForEveryInnerVertexOfThePath) {
  const Mesh mesh = test::icosphere(2);
  for (const auto& marks : {std::vector<int>{0, 11}, std::vector<int>{0, 11, 5}}) {
    const CutMesh cut = cut_open(mesh, marks);
    EXPECT_EQ(cut.vertex_count() - vertex_count(mesh), static_cast<int>(cut.boundary.size()) / 2 - 1);
  }
}

TEST(Cut, BetweenTwoMarksIsAShortestPath) {
  const Mesh mesh = test::perturbed(test::icosphere(2), 0.03, 4);
  const Connectivity connectivity = connectivity_of(mesh.F, vertex_count(mesh));
  const EdgeGraph graph = edge_length_graph(test::unjudged(mesh));
  const CutMesh cut = cut_open(mesh, {0, 11});
  double length = 0;
  for (std::size_t k = 0; k < cut.boundary.size() / 2; ++k) {
    const int v = cut.source_vertex[cut.boundary[k]], w = cut.source_vertex[cut.boundary[k + 1]];
    const std::array<int, 2> edge = {std::min(v, w), std::max(v, w)};
    const auto at = std::lower_bound(connectivity.edges.begin(), connectivity.edges.end(), edge);
    length += graph.length[at - connectivity.edges.begin()];
  }
  EXPECT_NEAR(length, distances(graph, {0})[11], 1e-12);
}

TEST(Cut, SeedsGiveOtherCutsThroughTheSameMarks) {
  const Mesh mesh = test::icosphere(2);
  for (const auto& marks : {std::vector<int>{0, 11}, std::vector<int>{0, 11, 5}}) {
    std::set<std::vector<int>> boundaries;
    for (std::uint64_t seed = 0; seed < 20; ++seed) {
      EXPECT_EQ(fault_in_sphere(mesh, marks, seed), "") << "seed " << seed;
      boundaries.insert(cut_open(mesh, marks, seed).boundary);
    }
    EXPECT_GT(boundaries.size(), 10u);
  }
}

TEST(Cut, SeedsTakeEveryMarkAsTheMiddleOne) {
  std::set<int> middles;
  for (std::uint64_t seed = 1; seed <= 30; ++seed)
    middles.insert(cut_open(test::icosphere(1), {0, 11, 5}, seed).arrangement[1]);
  EXPECT_EQ(middles.size(), 3u);
}

TEST(Cut, LeavesVerticesWithoutFacesAlone) {
  Mesh mesh = test::octahedron();
  mesh.V.conservativeResize(8, 3);
  mesh.V.bottomRows(2).setZero();
  EXPECT_EQ(fault_in_sphere(mesh, {0, 1, 2}, 0), "");
}

TEST(Cut, NeedsNoPositions) {
  Mesh mesh = test::icosphere(1);
  mesh.V.setZero();
  EXPECT_EQ(fault_in_sphere(mesh, {0, 11}, 0), "");
  EXPECT_EQ(fault_in_sphere(mesh, {0, 11, 5}, 0), "");
}

RC_GTEST_PROP(Cut, OfAnyTriangulatedSphereThroughAnyMarksIsADisk,
              (std::uint32_t seed, std::uint64_t cut_seed)) {
  const Mesh mesh = test::random_sphere(seed, static_cast<int>(seed % 25));
  std::vector<int> marks = test::permutation(vertex_count(mesh), seed + 1);
  marks.resize(2 + seed % 2);
  RC_ASSERT(fault_in_sphere(mesh, marks, 0) == "");
  RC_ASSERT(fault_in_sphere(mesh, marks, cut_seed) == "");
}

// --------------------------------------------------------------------------------------------------- disks

/// The boundary vertices of a grid from vertex 0, counterclockwise.
std::vector<int> grid_boundary(int columns, int rows) {
  std::vector<int> result;
  for (int x = 0; x < columns; ++x) result.push_back(x);
  for (int y = 0; y < rows; ++y) result.push_back(y * (columns + 1) + columns);
  for (int x = columns; x > 0; --x) result.push_back(rows * (columns + 1) + x);
  for (int y = rows; y > 0; --y) result.push_back(y * (columns + 1));
  return result;
}

TEST(Cut, LeavesDisksUncut) {
  const Mesh mesh = test::grid_disk(4, 3);
  for (const std::uint64_t seed : {0, 1, 2}) {
    const CutMesh cut = cut_open(mesh, {0, 4, 19}, seed);
    EXPECT_EQ(cut.F, mesh.F);
    EXPECT_EQ(cut.vertex_count(), vertex_count(mesh));
    EXPECT_EQ(fault_in_faces(mesh, cut), "");
    EXPECT_EQ(fault_in_disk(mesh, cut), "");
    EXPECT_EQ(cut.boundary, grid_boundary(4, 3));
  }
}

TEST(Cut, BoundaryOfADiskRunsCounterclockwiseFromTheFirstMark) {
  const Mesh mesh = test::grid_disk(4, 3);
  const std::vector<int> boundary = grid_boundary(4, 3);
  for (std::size_t k = 0; k < boundary.size(); ++k) {
    std::vector<int> expected = boundary;
    std::rotate(expected.begin(), expected.begin() + k, expected.end());
    EXPECT_EQ(cut_open(mesh, {boundary[k]}).boundary, expected);
  }
}

TEST(Cut, ArrangementFollowsTheBoundaryOfADisk) {
  const Mesh mesh = test::round_disk(3);  // its boundary is 19, 20, ..., 36
  EXPECT_EQ(cut_open(mesh, {19, 25, 30}).arrangement, (std::vector<int>{0, 1, 2}));
  EXPECT_EQ(cut_open(mesh, {25, 30, 19}).arrangement, (std::vector<int>{0, 1, 2}));
  EXPECT_EQ(cut_open(mesh, {19, 30, 25}).arrangement, (std::vector<int>{0, 2, 1}));
  EXPECT_EQ(cut_open(mesh, {30, 25, 19}).arrangement, (std::vector<int>{0, 2, 1}));
  EXPECT_EQ(cut_open(mesh, {36, 19}).arrangement, (std::vector<int>{0, 1}));
  EXPECT_EQ(cut_open(mesh, {20, 36, 28, 24}).arrangement, (std::vector<int>{0, 3, 2, 1}));
}

// Any marks, as they go around from any of them in either direction.
std::vector<int> marks_around(const std::vector<int>& boundary, std::uint32_t seed) {
  std::vector<int> places = test::permutation(static_cast<int>(boundary.size()), seed);
  places.resize(1 + seed % boundary.size());
  const int first = places.front();
  std::sort(places.begin(), places.end());
  std::rotate(places.begin(), std::find(places.begin(), places.end(), first), places.end());
  if (seed % 2 == 1) std::reverse(places.begin(), places.end());
  std::vector<int> marks;
  for (const int k : places) marks.push_back(boundary[k]);
  return marks;
}

RC_GTEST_PROP(Cut, OfADiskArrangesAnyMarksAlongTheBoundary, (std::uint32_t seed)) {
  const Mesh mesh = test::grid_disk(4, 3);
  const std::vector<int> marks = marks_around(grid_boundary(4, 3), seed);
  const CutMesh cut = cut_open(mesh, marks);
  RC_ASSERT(fault_in_arrangement(cut, marks) == "");
  RC_ASSERT(cut.arrangement.front() == 0);
}

// ------------------------------------------------------------------------------ disks with a mark inside

std::vector<char> on_boundary(const Mesh& mesh) {
  std::vector<char> result(vertex_count(mesh), 0);
  const Connectivity connectivity = connectivity_of(mesh.F, vertex_count(mesh));
  for (int h = 0; h < mesh.F.size(); ++h)
    if (connectivity.opposite[h] < 0) result[halfedge_origin(mesh.F, h)] = 1;
  return result;
}

/// The boundary begins at the mark inside and goes along one bank, around the mesh's own boundary from the
/// cut's end to its copy, and back along the other bank.
std::string fault_in_round_trip(const Mesh& mesh, const CutMesh& cut) {
  const std::vector<char> outer = on_boundary(mesh);
  const int b = static_cast<int>(cut.boundary.size()), n = vertex_count(mesh);
  const auto source = [&](int k) { return cut.source_vertex[cut.boundary[(k + b) % b]]; };
  int end = 0;
  while (end < b && !outer[source(end)]) ++end;
  if (cut.boundary[0] != cut.marks[0] || end == 0) return "the boundary does not begin at the mark inside";
  if (source(end) != cut.marks.back()) return "the cut does not end where it says";
  for (int k = 0; k <= end; ++k) {
    if (source(k) != source(-k)) return "the banks are not copies of each other";
    if (cut.boundary[k] >= n) return "the first bank has copies";
    if (k > 0 && cut.boundary[b - k] < n) return "the second bank has no copies";
  }
  for (int k = end; k <= b - end; ++k)
    if (!outer[source(k)]) return "the boundary of the mesh is left on the way round";
  const int round = static_cast<int>(std::count(outer.begin(), outer.end(), 1));
  return b - 2 * end == round ? "" : "the boundary of the mesh is not all there";
}

std::string fault_in_opened_disk(const Mesh& mesh, const std::vector<int>& marks, std::uint64_t seed) {
  const CutMesh cut = cut_inside(mesh, marks, seed);
  std::string fault = fault_in_faces(mesh, cut);
  if (fault.empty()) fault = fault_in_disk(mesh, cut);
  if (fault.empty()) fault = fault_in_arrangement(cut, cut.marks);
  if (fault.empty()) fault = fault_in_round_trip(mesh, cut);
  if (fault.empty() && cut.marks.size() != marks.size() + 1)
    fault = "the end of the cut is not among the marks";
  if (fault.empty() && !std::equal(marks.begin(), marks.end(), cut.marks.begin())) fault = "other marks";
  if (fault.empty() && cut.arrangement[1] != static_cast<int>(marks.size())) fault = "the end is not second";
  if (fault.empty() && !same(cut, cut_inside(mesh, marks, seed))) fault = "a second cut is different";
  return fault;
}

TEST(Cut, FromAnyVertexInsideADiskWithAnyMarkOnItsBoundaryGivesADisk) {
  for (const Mesh& mesh : {test::grid_disk(4, 3), test::round_disk(3)}) {
    const std::vector<char> outer = on_boundary(mesh);
    for (int a = 0; a < vertex_count(mesh); ++a) {
      if (outer[a]) continue;
      for (const std::uint64_t seed : {0, 1, 2}) {
        EXPECT_EQ(fault_in_opened_disk(mesh, {a}, seed), "");
        for (int b = 0; b < vertex_count(mesh); ++b) {
          if (!outer[b]) continue;
          EXPECT_EQ(fault_in_opened_disk(mesh, {a, b}, seed), "") << a << " " << b;
        }
      }
    }
  }
}

TEST(Cut, FromAMarkInsideEndsAtTheNearestVertexOfTheBoundaryThatIsNotMarked) {
  const Mesh mesh = test::perturbed(test::round_disk(6), 0.03, 4);
  const std::vector<char> outer = on_boundary(mesh);
  const EdgeGraph graph = edge_length_graph(test::unjudged(mesh));
  for (const int a : {0, 7, 20, 45}) {
    const std::vector<double> d = distances(graph, {a});
    const int nearest = cut_inside(mesh, {a}).marks.back(),
              next = cut_inside(mesh, {a, nearest}).marks.back();
    EXPECT_NE(next, nearest);
    for (int v = 0; v < vertex_count(mesh); ++v) {
      if (!outer[v]) continue;
      EXPECT_GE(d[v], d[nearest]);
      EXPECT_TRUE(v == nearest || d[v] >= d[next]);
    }
  }
}

TEST(Cut, SeedsGiveOtherCutsOfADisk) {
  const Mesh mesh = test::round_disk(7);
  std::set<std::vector<int>> with_mark, alone;
  std::set<int> ends;
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    EXPECT_EQ(fault_in_opened_disk(mesh, {0, 130}, seed), "") << "seed " << seed;
    EXPECT_EQ(fault_in_opened_disk(mesh, {0}, seed), "") << "seed " << seed;
    with_mark.insert(cut_inside(mesh, {0, 130}, seed).boundary);
    alone.insert(cut_inside(mesh, {0}, seed).boundary);
    ends.insert(cut_inside(mesh, {0}, seed).marks.back());
  }
  EXPECT_GT(with_mark.size(), 5u);
  EXPECT_GT(alone.size(), 10u);
  EXPECT_GT(ends.size(), 5u);
}

/// A random sphere without one of its faces, or without all around a vertex.
Mesh random_disk(std::uint32_t seed) {
  const Mesh sphere = test::random_sphere(seed, static_cast<int>(5 + seed % 25));
  std::vector<int> gone = {static_cast<int>(seed % sphere.F.rows())};
  if (seed % 2) {
    gone.clear();
    for (int f = 0; f < face_count(sphere); ++f)
      if ((sphere.F.row(f).array() == 0).any()) gone.push_back(f);
  }
  return test::without_faces(sphere, gone);
}

RC_GTEST_PROP(Cut, OfAnyTriangulatedDiskIsADisk, (std::uint32_t seed, std::uint64_t cut_seed)) {
  const Mesh mesh = random_disk(seed);
  const std::vector<char> outer = on_boundary(mesh);
  std::vector<char> used(outer.size(), 0);
  for (const int v : mesh.F.reshaped()) used[v] = 1;
  std::vector<int> inside, around;
  for (const int v : test::permutation(vertex_count(mesh), seed + 1)) {
    if (used[v]) (outer[v] ? around : inside).push_back(v);
  }
  RC_PRE(!inside.empty());
  RC_ASSERT(fault_in_opened_disk(mesh, {inside[0]}, 0) == "");
  RC_ASSERT(fault_in_opened_disk(mesh, {inside[0]}, cut_seed) == "");
  for (const int v : around) RC_ASSERT(fault_in_opened_disk(mesh, {inside[0], v}, cut_seed) == "");
}

// --------------------------------------------------------------------------------------- projective planes

/// The input with its faces turned as in the cut mesh.
Mesh turned_like(const Mesh& mesh, const CutMesh& cut) {
  Mesh result = mesh;
  for (int f = 0; f < face_count(mesh); ++f)
    if (cut.source_vertex[cut.F(f, 1)] == mesh.F(f, 2)) std::swap(result.F(f, 1), result.F(f, 2));
  return result;
}

/// The boundary runs twice around one loop, in the same direction; but for the copies it meets no vertex
/// twice.
std::string fault_in_loop(const CutMesh& cut, int mark) {
  const std::size_t b = cut.boundary.size(), half = b / 2;
  const auto source = [&](std::size_t k) { return cut.source_vertex[cut.boundary[k]]; };
  if (b % 2 != 0 || half < 3) return "the boundary is no loop run twice";
  std::set<int> met;
  for (std::size_t k = 0; k < half; ++k) {
    if (source(k) != source(k + half)) return "the second round is another loop";
    if (cut.boundary[k] != source(k)) return "the first round runs along copies";
    met.insert(source(k));
  }
  if (met.size() != half) return "the loop meets itself";
  return source(0) == mark ? "" : "the boundary does not begin at the mark";
}

std::string fault_in_projective_plane(const Mesh& mesh, int mark, std::uint64_t seed) {
  const CutMesh cut = cut_inside(mesh, {mark}, seed);
  const Mesh turned = turned_like(mesh, cut);
  std::string fault = turned.F.row(0) == mesh.F.row(0) ? "" : "face 0 is turned over";
  if (fault.empty()) fault = fault_in_faces(turned, cut);
  if (fault.empty()) fault = fault_in_disk(turned, cut);
  if (fault.empty()) fault = fault_in_arrangement(cut, {mark});
  if (fault.empty()) fault = fault_in_loop(cut, mark);
  const Connectivity connectivity = connectivity_of(mesh.F, vertex_count(mesh));
  for (int h = 0; h < cut.F.size() && fault.empty(); ++h) {
    const auto [i, j] = std::minmax(cut.source_vertex[halfedge_origin(cut.F, h)],
                                    cut.source_vertex[halfedge_target(cut.F, h)]);
    if (connectivity.edges[connectivity.edge_of[cut.source_halfedge(h)]] != std::array<int, 2>{i, j})
      fault = "a half-edge is of another edge";
  }
  if (fault.empty() && !same(cut, cut_inside(mesh, {mark}, seed))) fault = "a second cut is different";
  return fault;
}

TEST(Cut, ThroughAnyVertexOfAProjectivePlaneGivesADisk) {
  for (const int levels : {0, 1, 2}) {
    const Mesh mesh = test::projective_plane(levels);
    for (int v = 0; v < vertex_count(mesh); ++v)
      for (const std::uint64_t seed : {0, 1, 2}) EXPECT_EQ(fault_in_projective_plane(mesh, v, seed), "") << v;
  }
}

// At the tip of a limb every shortest one-sided loop goes up and down the limb: it has to open into a simple
// one.
TEST(Cut, ThroughTheTipOfALimbOfAProjectivePlaneGivesADisk) {
  Mesh mesh = test::projective_plane(1);
  for (int k = 0; k < 12; ++k) {
    const int tip = vertex_count(mesh);
    mesh = test::with_face_split(mesh, k == 0 ? 0 : face_count(mesh) - 1 - k % 2);
    mesh.V.row(tip) = Eigen::RowVector3d(0, 0, 3 + k);
    EXPECT_EQ(fault_in_projective_plane(mesh, tip, 0), "") << tip;
    EXPECT_EQ(fault_in_projective_plane(mesh, tip, 5), "") << tip;
  }
}

TEST(Cut, SeedsGiveOtherCutsOfAProjectivePlane) {
  const Mesh mesh = test::projective_plane(3);
  std::set<std::vector<int>> cuts;
  for (std::uint64_t seed = 0; seed < 20; ++seed) cuts.insert(cut_inside(mesh, {7}, seed).boundary);
  EXPECT_GT(cuts.size(), 5u);
}

RC_GTEST_PROP(Cut, OfAnyTriangulatedProjectivePlaneIsADisk, (std::uint32_t seed, std::uint64_t cut_seed)) {
  const Mesh mesh = test::random_projective_plane(seed, static_cast<int>(seed % 30));
  for (int v = 0; v < vertex_count(mesh); ++v) {
    RC_ASSERT(fault_in_projective_plane(mesh, v, 0) == "");
    RC_ASSERT(fault_in_projective_plane(mesh, v, cut_seed) == "");
  }
}

TEST(Cut, NoMarkOrTwoOnAProjectivePlaneAreRefused) {
  const Mesh mesh = test::projective_plane(1);
  const auto refusal = [&](const std::vector<int>& marks) -> std::string {
    try {
      cut_inside(mesh, marks);
      return {};
    } catch (const MeshError& error) {
      return error.what();
    }
  };
  EXPECT_EQ(refusal({}), "0 marked vertices on a projective plane; mark one");
  EXPECT_EQ(refusal({1, 2}), "2 marked vertices on a projective plane; mark one");
  EXPECT_EQ(refusal({100}), "the marked vertex 100 is out of range; the mesh has the vertices 0 to 20");
}

// ------------------------------------------------------------------------------------------------- lengths

TEST(Cut, EdgeLengthsArePositiveAndAlmostThoseInSpace) {
  Mesh mesh = test::icosphere(1);
  mesh.V.row(0) = mesh.V.row(mesh.F(0, 1));  // an edge of length zero
  const Connectivity connectivity = connectivity_of(mesh.F, vertex_count(mesh));
  const EdgeGraph graph = edge_length_graph(test::unjudged(mesh));
  ASSERT_EQ(graph.length.size(), connectivity.edges.size());
  EXPECT_EQ(graph.vertex_count(), vertex_count(mesh));
  for (std::size_t e = 0; e < graph.length.size(); ++e) {
    const auto [i, j] = connectivity.edges[e];
    EXPECT_GT(graph.length[e], 0);
    EXPECT_NEAR(graph.length[e], (mesh.V.row(i) - mesh.V.row(j)).norm(), 1e-5);
  }
}

// ------------------------------------------------------------------------------------------------ refusals

std::string refusal_of_cut(const Mesh& mesh, const std::vector<int>& marks, int inner_marks = 0) {
  try {
    cut_to_disk(test::unjudged(mesh), marks, inner_marks);
    return {};
  } catch (const MeshError& error) {
    return error.what();
  }
}

TEST(Cut, MarksOutOfRangeAreRefused) {
  const std::string range = " is out of range; the mesh has the vertices 0 to ";
  EXPECT_EQ(refusal_of_cut(test::octahedron(), {0, 6}), "the marked vertex 6" + range + "5");
  EXPECT_EQ(refusal_of_cut(test::octahedron(), {-1, 2, 3}), "the marked vertex -1" + range + "5");
  EXPECT_EQ(refusal_of_cut(test::grid_disk(1, 1), {0, 4}), "the marked vertex 4" + range + "3");
}

TEST(Cut, RepeatedMarksAreRefused) {
  const std::string twice = " is marked twice; mark different vertices";
  EXPECT_EQ(refusal_of_cut(test::octahedron(), {3, 3}), "the vertex 3" + twice);
  EXPECT_EQ(refusal_of_cut(test::octahedron(), {3, 1, 3}), "the vertex 3" + twice);
  EXPECT_EQ(refusal_of_cut(test::grid_disk(1, 1), {0, 1, 1}), "the vertex 1" + twice);
}

TEST(Cut, MarksWithoutFacesAreRefused) {
  Mesh mesh = test::octahedron();
  mesh.V.conservativeResize(7, 3);
  mesh.V.row(6).setZero();
  EXPECT_EQ(refusal_of_cut(mesh, {0, 6}),
            "the marked vertex 6 belongs to no face; mark a vertex of the surface");
}

TEST(Cut, MarksThatDoNotGoAroundTheBoundaryAreRefusedInTheOrderInWhichTheyDo) {
  const Mesh mesh = test::round_disk(3);  // its boundary is 19, 20, ..., 36
  EXPECT_EQ(refusal_of_cut(mesh, {19, 30, 25, 35}),
            "the boundary meets the marked vertices in the order 19,25,30,35, not 19,30,25,35; mark them in "
            "that order");
  EXPECT_EQ(refusal_of_cut(mesh, {35, 25, 30, 19, 22}),
            "the boundary meets the marked vertices in the order 35,19,22,25,30, not 35,25,30,19,22; mark "
            "them in that order");
}

TEST(Cut, MarksInsideADiskAreRefused) {
  const std::string inside = "the marked vertex 0 is inside the disk; mark a vertex on its boundary";
  EXPECT_EQ(refusal_of_cut(test::round_disk(2), {0}), inside);
  EXPECT_EQ(refusal_of_cut(test::round_disk(2), {7, 0, 9}), inside);
}

TEST(Cut, MarksOnTheBoundaryThatHaveToBeInsideAreRefused) {
  const std::string outside = " is on the boundary of the disk; mark a vertex inside";
  EXPECT_EQ(refusal_of_cut(test::round_disk(2), {9}, 1), "the marked vertex 9" + outside);
  EXPECT_EQ(refusal_of_cut(test::round_disk(2), {9, 0}, 1), "the marked vertex 9" + outside);
  EXPECT_EQ(refusal_of_cut(test::round_disk(2), {0, 1}, 1),
            "the marked vertex 1 is inside the disk; mark a vertex on its boundary");
}

TEST(Cut, MoreMarksInsideADiskThanOneAreRefused) {
  const std::string too_many = " are inside the disk; mark one inside, and at most one on the boundary";
  EXPECT_EQ(refusal_of_cut(test::round_disk(2), {0, 1}, 2), "2 of 2 marked vertices" + too_many);
  EXPECT_EQ(refusal_of_cut(test::round_disk(2), {0, 9, 10}, 1), "1 of 3 marked vertices" + too_many);
}

TEST(Cut, MarksThatNoPathJoinsToTheBoundaryAreRefused) {
  EXPECT_EQ(refusal_of_cut(test::united(test::octahedron(), test::round_disk(2)), {0}, 1),
            "no edge path leads from the marked vertex 0 to the boundary; mark another vertex");
}

TEST(Cut, OneMarkOrFourOnASphereAreRefused) {
  const std::string on_a_sphere = " marked vertices on a sphere; mark two or three";
  EXPECT_EQ(refusal_of_cut(test::octahedron(), {0}), "1" + on_a_sphere);
  EXPECT_EQ(refusal_of_cut(test::octahedron(), {0, 1, 2, 3}), "4" + on_a_sphere);
}

TEST(Cut, ASphereWithoutMarksStaysClosed) {
  const Mesh mesh = test::octahedron();
  const CutMesh cut = cut_to_disk(test::unjudged(mesh), {}, 0);
  EXPECT_EQ(cut.F, mesh.F);
  EXPECT_EQ(cut.vertex_count(), test::vertex_count(mesh));
  EXPECT_TRUE(cut.boundary.empty());
  EXPECT_TRUE(cut.marks.empty());
}

TEST(Cut, TheBoundaryOfADiskWithoutMarksBeginsAtItsFirstVertex) {
  const CutMesh cut = cut_to_disk(test::unjudged(test::round_disk(2)), {}, 0);
  EXPECT_EQ(cut.boundary.front(), *std::min_element(cut.boundary.begin(), cut.boundary.end()));
  EXPECT_EQ(cut.marks, std::vector<int>{cut.boundary.front()});
  EXPECT_EQ(cut.arrangement, std::vector<int>{0});
  EXPECT_EQ(cut.vertex_count(), test::vertex_count(test::round_disk(2)));
}

TEST(Cut, TheBoundaryOfADiskWithoutMarksBeginsAtNoTipOfAnEar) {
  Mesh mesh = test::round_disk(1);
  const int n = test::vertex_count(mesh);  // a triangle beyond the first edge of the boundary, its tip first
  mesh.V.conservativeResize(n + 1, 3);
  mesh.V.row(n) = 1.5 * (mesh.V.row(1) + mesh.V.row(2));
  mesh.F.conservativeResize(mesh.F.rows() + 1, 3);
  mesh.F.row(mesh.F.rows() - 1) << 2, 1, n;
  for (int& v : mesh.F.reshaped()) v = n - v;
  mesh.V = mesh.V.colwise().reverse().eval();
  const CutMesh cut = cut_to_disk(test::unjudged(mesh), {}, 0);
  EXPECT_EQ(std::count(cut.boundary.begin(), cut.boundary.end(), 0), 1);
  EXPECT_NE(cut.boundary.front(), 0);
}

TEST(Cut, AProjectivePlaneWithoutMarksIsRefused) {
  EXPECT_EQ(refusal_of_cut(test::projective_plane(1), {}),
            "0 marked vertices on a projective plane; mark one");
}

TEST(Cut, MarksOnSeparateSpheresAreRefused) {
  const Mesh two = test::united(test::octahedron(), test::tetrahedron());
  EXPECT_EQ(refusal_of_cut(two, {0, 7}), "no edge path joins the marked vertices 0 and 7; mark others");
  EXPECT_NE(refusal_of_cut(two, {0, 1, 7}), "");
}

}  // namespace
}  // namespace orbitutte::cut_test
