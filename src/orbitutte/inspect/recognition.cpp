// SPDX-License-Identifier: MIT
#include "orbitutte/inspect/recognition.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <atomic>
#include <limits>
#include <stdexcept>
#include <utility>

#include "orbitutte/inspect/inspection.h"
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
double size_of(const Points& V) {
  Eigen::RowVector3d lowest = V.row(0), highest = lowest;
  for (const auto& position : V.rowwise()) {
    lowest = lowest.cwiseMin(position);
    highest = highest.cwiseMax(position);
  }
  return (highest - lowest).maxCoeff();
}

// Has every edge one face, or two that run along it in opposite directions? Of more than two half-edges of an
// edge, one is not the opposite one of its own opposite one.
bool is_oriented_manifold(const Triangles& F, const std::vector<int>& opposite) {
  return all_of(static_cast<int>(opposite.size()), [&](int h) {
    const int other = opposite[h];
    return other < 0 || (opposite[other] == h && halfedge_origin(F, other) != halfedge_origin(F, h));
  });
}

// Of every vertex, does a face use it?
std::vector<char> used_by_faces(const Triangles& F, int vertex_count) {
  std::vector<char> used(vertex_count, 0);
  for (Eigen::Index h = 0; h < F.size(); ++h) used[F.data()[h]] = 1;
  return used;
}

// Can every face be reached from the first across edges?
bool is_connected_across_edges(const std::vector<int>& opposite) {
  const std::size_t count = opposite.size() / 3;
  std::vector<char> is_reached(count, 0);
  std::vector<int> reached(count + 1);  // a place more, for what is written before it is known to be new
  std::size_t found = 1;                // the first face
  is_reached[0] = 1;
  for (std::size_t k = 0; k < found; ++k) {
    for (int h = 3 * reached[k]; h < 3 * reached[k] + 3; ++h) {
      if (opposite[h] < 0) continue;
      const int face = opposite[h] / 3;
      reached[found] = face;
      found += !is_reached[face];
      is_reached[face] = 1;
    }
  }
  return found == count;
}

// The boundary curves, each followed from fan to fan.
int count_boundary_curves(const Triangles& F, const std::vector<int>& opposite) {
  const std::vector<int> boundary =
      parallel_select(static_cast<int>(opposite.size()), [&](int h) { return opposite[h] < 0; });
  if (boundary.empty()) return 0;
  std::vector<char> seen(F.size(), 0);
  int curves = 0;
  for (const int first : boundary) {
    if (seen[first]) continue;
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
  // Most are told without a division.
  if (const double square = unit * unit; unit > 1e-60 && unit < 1e60)
    if (ab.cross(bc).squaredNorm() > 1e-20 * (square * square)) return false;
  ab /= unit;
  bc /= unit;
  return !(ab.cross(bc).norm() > 8 * std::numeric_limits<double>::epsilon());
}

namespace {

// What a few linear sweeps tell about a sphere or disk without a defect: everything but vertices and faces.
// Nothing if the mesh is something else. Faces glued along their edges, and connected so, are a surface with
// b boundary curves and V - E + F + b <= 2 if every fan of faces has a vertex of its own; equal to 2 on a
// sphere or disk. If fans share a vertex, there are fewer vertices: so where the sum is 2, none do.
std::optional<Surface> judge_quickly(const Mesh& mesh) {
  const int n = static_cast<int>(mesh.V.rows()), m = static_cast<int>(mesh.F.rows());
  if (m == 0) return std::nullopt;
  if (!all_of(m, [&](int f) { return names_a_triangle(mesh, f); })) return std::nullopt;
  if (!all_of(n, [&](int v) { return is_in_range(mesh.V.row(v)); }) || size_of(mesh.V) < smallest_size)
    return std::nullopt;

  Surface result;
  result.connectivity = connectivity_of(mesh.F, n);
  const std::vector<int>& opposite = result.connectivity.opposite;
  bool is_connected = false;
  std::vector<char> used;
  parallel_for(2, [&](int task) {
    if (task == 0) is_connected = is_connected_across_edges(opposite);
    if (task == 1) used = used_by_faces(mesh.F, n);
  });
  if (!is_connected || !is_oriented_manifold(mesh.F, opposite)) return std::nullopt;

  result.unreferenced_vertices = static_cast<int>(std::count(used.begin(), used.end(), 0));
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
