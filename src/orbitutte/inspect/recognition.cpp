// SPDX-License-Identifier: MIT
#include "orbitutte/inspect/recognition.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <atomic>
#include <limits>
#include <stdexcept>
#include <utility>

#include "orbitutte/inspect/inspection.h"
#include "orbitutte/mesh/disjoint_sets.h"
#include "orbitutte/mesh/triangulation.h"
#include "orbitutte/parallel.h"

namespace orbitutte {
namespace {

// Does test(i) hold for all i of 0 .. count - 1?
template <typename Test>
bool all_of(int count, const Test& test) {
  std::atomic<bool> holds = true;
  parallel_ranges(count, [&](int begin, int end) {
    for (int i = begin; i < end && holds; ++i)
      if (!test(i)) holds = false;
  });
  return holds;
}

// Three different vertices of the mesh.
bool names_a_triangle(const Mesh& mesh, int f) {
  const int n = static_cast<int>(mesh.V.rows()), *v = mesh.F.data() + 3 * f;
  return v[0] >= 0 && v[1] >= 0 && v[2] >= 0 && v[0] < n && v[1] < n && v[2] < n && v[0] != v[1] &&
         v[1] != v[2] && v[2] != v[0];
}

// Finite, too.
bool is_in_range(const Vector3& position) { return (position.array().abs() <= largest_coordinate).all(); }

// The longest side of the box around the points.
double size_of(const Points& V) { return (V.colwise().maxCoeff() - V.colwise().minCoeff()).maxCoeff(); }

// Is the edge of half-edge h on the boundary, or between two faces that run along it in opposite directions?
bool is_manifold(const Triangles& F, const Connectivity& connectivity, int h) {
  const int other = connectivity.opposite[h];
  return other < 0 ||
         (connectivity.opposite[other] == h && halfedge_origin(F, other) == halfedge_target(F, h));
}

struct Fans {
  std::vector<int> corners;  // of every vertex
  std::vector<int>
      outgoing;  // a half-edge that leaves it, on the boundary where there is one; -1: in no face
};

Fans fans_of(const Triangles& F, const std::vector<int>& opposite, int vertex_count) {
  Fans fans = {std::vector<int>(vertex_count, 0), std::vector<int>(vertex_count, -1)};
  for (int h = 0; h < static_cast<int>(F.size()); ++h) {
    const int v = halfedge_origin(F, h);
    ++fans.corners[v];
    if (fans.outgoing[v] < 0 || opposite[h] < 0) fans.outgoing[v] = h;
  }
  return fans;
}

// Do the faces at v make up one fan? Walks clockwise from the boundary, or once around.
bool is_one_fan(const Fans& fans, const std::vector<int>& opposite, int v) {
  const int first = fans.outgoing[v];
  if (first < 0) return true;
  int corners = 0, h = first;
  do {
    ++corners;
    h = opposite[previous_halfedge(h)];
  } while (h >= 0 && h != first && corners <= fans.corners[v]);
  return corners == fans.corners[v];
}

bool is_connected(const Connectivity& connectivity, const std::vector<int>& corners) {
  DisjointSets sets(static_cast<int>(corners.size()));
  for (const auto& [i, j] : connectivity.edges) sets.unite(i, j);
  int root = -1;
  for (int v = 0; v < static_cast<int>(corners.size()); ++v) {
    if (corners[v] == 0) continue;
    if (root < 0) root = sets.find(v);
    if (sets.find(v) != root) return false;
  }
  return true;
}

// The boundary curves of a surface all of whose vertices have one fan.
int count_boundary_curves(const Triangles& F, const std::vector<int>& opposite) {
  std::vector<char> seen(F.size(), 0);
  int curves = 0;
  for (int first = 0; first < static_cast<int>(F.size()); ++first) {
    if (opposite[first] >= 0 || seen[first]) continue;
    ++curves;
    for (int h = first; !seen[h];) {
      seen[h] = 1;
      h = next_halfedge(h);
      while (opposite[h] >= 0) h = next_halfedge(opposite[h]);
    }
  }
  return curves;
}

// What an inspection without defects tells about a surface. Vertices and faces are still missing.
Surface judged(const Inspection& inspection) {
  Surface surface;
  surface.topology = inspection.topology;
  surface.unreferenced_vertices = inspection.unreferenced_vertices;
  surface.zero_area_faces = inspection.zero_area_faces;
  return surface;
}

}  // namespace

bool is_degenerate_triangle(const Vector3& a, const Vector3& b, const Vector3& c) {
  Vector3 ab = b - a, bc = c - b;
  const double unit = std::max(
      {ab.lpNorm<Eigen::Infinity>(), bc.lpNorm<Eigen::Infinity>(), (a - c).lpNorm<Eigen::Infinity>()});
  ab /= unit;
  bc /= unit;
  return !(ab.cross(bc).norm() > 8 * std::numeric_limits<double>::epsilon());
}

namespace {

// What a few linear sweeps tell about a sphere or disk without a defect: everything but vertices and faces.
// Nothing if the mesh is something else.
std::optional<Surface> judge_quickly(const Mesh& mesh) {
  const int n = static_cast<int>(mesh.V.rows()), m = static_cast<int>(mesh.F.rows());
  if (m == 0) return std::nullopt;
  if (!all_of(m, [&](int f) { return names_a_triangle(mesh, f); })) return std::nullopt;
  if (!all_of(n, [&](int v) { return is_in_range(mesh.V.row(v)); }) || size_of(mesh.V) < smallest_size)
    return std::nullopt;

  Surface result;
  result.connectivity = connectivity_of(mesh.F, n);
  const std::vector<int>& opposite = result.connectivity.opposite;
  if (!all_of(3 * m, [&](int h) { return is_manifold(mesh.F, result.connectivity, h); })) return std::nullopt;
  const Fans fans = fans_of(mesh.F, opposite, n);
  if (!all_of(n, [&](int v) { return is_one_fan(fans, opposite, v); })) return std::nullopt;
  if (!is_connected(result.connectivity, fans.corners)) return std::nullopt;

  result.unreferenced_vertices = static_cast<int>(std::count(fans.corners.begin(), fans.corners.end(), 0));
  // Two faces of a connected manifold have the same vertices only if there are no other faces.
  if (m == 2 && n - result.unreferenced_vertices == 3) return std::nullopt;
  const long euler =
      n - result.unreferenced_vertices - static_cast<long>(result.connectivity.edges.size()) + m;
  const int curves = count_boundary_curves(mesh.F, opposite);
  if (euler + curves != 2 || curves > 1) return std::nullopt;
  result.topology = curves == 0 ? Topology::sphere : Topology::disk;
  result.zero_area_faces = static_cast<int>(parallel_sum(m, [&](int f) {
    return is_degenerate_triangle(mesh.V.row(mesh.F(f, 0)), mesh.V.row(mesh.F(f, 1)),
                                  mesh.V.row(mesh.F(f, 2)))
               ? 1.0
               : 0.0;
  }));
  if (result.zero_area_faces == m) return std::nullopt;
  return result;
}

// The same of any surface; throws MeshError.
Surface judge(const Mesh& mesh) {
  if (std::optional<Surface> surface = judge_quickly(mesh)) return std::move(*surface);
  const Inspection inspection = inspect(mesh);
  require_embeddable(inspection);
  if (inspection.topology != Topology::projective_plane)
    throw std::logic_error("a mesh without defects was not recognised");
  Surface surface = judged(inspection);
  surface.connectivity = connectivity_of(mesh.F, inspection.vertices);
  return surface;
}

void take(Mesh&& mesh, Surface& surface) {
  surface.V = std::move(mesh.V);
  surface.triangles = std::move(mesh.F);
}

}  // namespace

std::optional<Surface> recognize_sphere_or_disk(Mesh&& mesh) {
  std::optional<Surface> surface = judge_quickly(mesh);
  if (surface) take(std::move(mesh), *surface);
  return surface;
}

bool is_sound_sphere(const Mesh& mesh) {
  const std::optional<Surface> surface = judge_quickly(mesh);
  return surface && surface->topology == Topology::sphere && surface->unreferenced_vertices == 0;
}

Surface make_surface(Mesh&& mesh) {
  Surface surface = judge(mesh);
  take(std::move(mesh), surface);
  return surface;
}

Surface make_surface(const Mesh& mesh) { return make_surface(Mesh(mesh)); }

Surface make_surface(PolygonMesh&& mesh) {
  if (is_triangle_mesh(mesh)) {
    Points colours = std::move(mesh.colours);
    Surface surface = make_surface(to_triangle_mesh(std::move(mesh)));
    surface.colours = std::move(colours);
    return surface;
  }
  const Inspection inspection = inspect(mesh);
  require_embeddable(inspection);
  Surface surface = judged(inspection);
  surface.division = triangulate(mesh);
  surface.triangles = triangles_on_vertices(surface.division, mesh.corners);
  surface.connectivity = connectivity_of(mesh, surface.division);
  surface.polygons = {std::move(mesh.corners), std::move(mesh.face_start)};
  surface.V = std::move(mesh.V);
  surface.colours = std::move(mesh.colours);
  return surface;
}

Surface make_surface(const PolygonMesh& mesh) { return make_surface(PolygonMesh(mesh)); }

}  // namespace orbitutte
