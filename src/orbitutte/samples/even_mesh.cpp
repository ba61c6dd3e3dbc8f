// SPDX-License-Identifier: MIT
#include "orbitutte/samples/even_mesh.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <vector>

#include "orbitutte/mesh/connectivity.h"
#include "orbitutte/parallel.h"

namespace orbitutte {
namespace {

constexpr int fewest_relaxed_faces = 600;      // with fewer, vertices slide off thin parts
constexpr int most_grown_faces = 10'000;       // a larger mesh is divided instead
constexpr int most_flipped_faces = 1'000'000;  // in a larger mesh, triangles have taken their shapes
constexpr double growth = 0.15;  // the share of the edges that are split at a time, the longest first
constexpr int flip_passes = 30;
constexpr int growing_rounds = 3;   // of relaxation after every growth
constexpr int final_rounds = 40;    // after the last growth
constexpr int dividing_rounds = 2;  // after every division

int face_count(const Mesh& mesh) { return static_cast<int>(mesh.F.rows()); }
int vertex_count(const Mesh& mesh) { return static_cast<int>(mesh.V.rows()); }

Connectivity mesh_connectivity(const Mesh& mesh) { return connectivity_of(mesh.F, vertex_count(mesh)); }

// One half-edge of every edge, the one with the lower index.
std::vector<int> halfedge_of_edges(const Connectivity& connectivity) {
  std::vector<int> result(connectivity.edges.size());
  for (int h = static_cast<int>(connectivity.edge_of.size()) - 1; h >= 0; --h)
    result[connectivity.edge_of[h]] = h;
  return result;
}

std::vector<char> boundary_vertices(const Mesh& mesh, const Connectivity& connectivity) {
  std::vector<char> result(mesh.V.rows(), 0);
  for (int h = 0; h < static_cast<int>(connectivity.opposite.size()); ++h) {
    if (connectivity.opposite[h] < 0) result[halfedge_origin(mesh.F, h)] = 1;
  }
  return result;
}

// Takes Newton steps along the gradient to the zero set: in the plane through p with this normal, or in space
// if the normal is 0.
Vector3 drawn(const SmoothSurface& surface, Vector3 p, const Vector3& normal = Vector3::Zero()) {
  constexpr int steps = 12;
  constexpr double tolerance = 1e-9;
  for (int step = 0; step < steps; ++step) {
    const FieldSample at = surface.field(p);
    const Vector3 gradient = at.gradient - at.gradient.dot(normal) * normal;
    if (std::abs(at.value) < tolerance || gradient.squaredNorm() == 0) break;
    p -= at.value / gradient.squaredNorm() * gradient;
  }
  return p;
}

Vector3 drawn_to_rim(const SmoothSurface& surface, const Vector3& p) {
  return drawn(surface, p - p.dot(surface.rim_normal) * surface.rim_normal, surface.rim_normal);
}

Vector3 drawn_midpoint(const Mesh& mesh, const SmoothSurface& surface, int v, int w, bool on_rim) {
  const Vector3 middle = (mesh.V.row(v) + mesh.V.row(w)) / 2;
  return on_rim ? drawn_to_rim(surface, middle) : drawn(surface, middle);
}

// Twice the area times the normal of a triangle.
Vector3 area_vector(const Mesh& mesh, int a, int b, int c) {
  const Vector3 u = mesh.V.row(b) - mesh.V.row(a), v = mesh.V.row(c) - mesh.V.row(a);
  return u.cross(v);
}

Vector3 normal_at(const SmoothSurface& surface, const Vector3& p) {
  return surface.field(p).gradient.normalized();
}

Points normals(const Points& V, const SmoothSurface& surface) {
  Points result(V.rows(), 3);
  for (Eigen::Index v = 0; v < V.rows(); ++v) result.row(v) = normal_at(surface, V.row(v));
  return result;
}

// ---- growing

// Splits the edge of half-edge h at vertex m in one of its faces. The new face gets the number `new_face`.
void split_face(Triangles& F, int h, int m, int new_face) {
  const int b = halfedge_target(F, h), o = halfedge_origin(F, previous_halfedge(h));
  F.data()[next_halfedge(h)] = m;
  F.row(new_face) << m, b, o;
}

std::vector<int> edges_by_length(const Mesh& mesh, const Connectivity& connectivity) {
  std::vector<double> length;
  std::vector<int> order;
  for (const auto& [i, j] : connectivity.edges) {
    order.push_back(static_cast<int>(order.size()));
    length.push_back((mesh.V.row(i) - mesh.V.row(j)).norm());
  }
  std::stable_sort(order.begin(), order.end(), [&](int d, int e) { return length[d] > length[e]; });
  return order;
}

// Splits the longest edges, at most one of every face, until there are `faces` faces or a share of the edges
// is split.
void split_long_edges(Mesh& mesh, const SmoothSurface& surface, int faces) {
  const Connectivity connectivity = mesh_connectivity(mesh);
  const std::vector<int> halfedge = halfedge_of_edges(connectivity);
  std::vector<char> is_split(mesh.F.rows(), 0);
  int m = vertex_count(mesh), f = face_count(mesh);
  int splits = 1 + static_cast<int>(growth * connectivity.edges.size());
  mesh.V.conservativeResize(m + splits, 3);
  mesh.F.conservativeResize(f + 2 * splits, 3);
  for (const int e : edges_by_length(mesh, connectivity)) {
    const int h = halfedge[e], g = connectivity.opposite[h], more = g < 0 ? 1 : 2;
    if (splits == 0 || f >= faces) break;
    if (f + more > faces || is_split[h / 3] || (g >= 0 && is_split[g / 3])) continue;
    const auto [i, j] = connectivity.edges[e];
    mesh.V.row(m) = drawn_midpoint(mesh, surface, i, j, g < 0);
    for (const int side : {h, g}) {
      if (side < 0) continue;
      is_split[side / 3] = 1;
      split_face(mesh.F, side, m, f++);
    }
    ++m, --splits;
  }
  mesh.V.conservativeResize(m, 3);
  mesh.F.conservativeResize(f, 3);
}

// ---- flipping

double cotangent(const Mesh& mesh, int i, int j, int o) {
  const Vector3 a = mesh.V.row(i) - mesh.V.row(o), b = mesh.V.row(j) - mesh.V.row(o);
  return a.dot(b) / a.cross(b).norm();
}

bool has_edge(const Connectivity& connectivity, int v, int w) {
  const std::array<int, 2> edge = {std::min(v, w), std::max(v, w)};
  return std::binary_search(connectivity.edges.begin(), connectivity.edges.end(), edge);
}

// Does a triangle turn its back to the surface, or nearly so?
bool lies_wrong(const Mesh& mesh, const SmoothSurface& surface, int a, int b, int c) {
  constexpr double least_cosine = 0.3;
  Vector3 expected = Vector3::Zero();
  for (const int v : {a, b, c}) expected += normal_at(surface, mesh.V.row(v));
  return area_vector(mesh, a, b, c).normalized().dot(expected.normalized()) < least_cosine;
}

// Flips every edge whose opposite angles add up to more than pi, but no two at the same vertex. Returns the
// number of flips.
int flip_edges(Mesh& mesh, const SmoothSurface& surface) {
  constexpr double rounding = 1e-9;
  const Connectivity connectivity = mesh_connectivity(mesh);
  std::vector<char> at_flip(mesh.V.rows(), 0);
  int flips = 0;
  for (int h = 0; h < static_cast<int>(mesh.F.size()); ++h) {
    const int g = connectivity.opposite[h];
    if (g < h) continue;
    const int a = halfedge_origin(mesh.F, h), b = halfedge_target(mesh.F, h);
    const int o = halfedge_origin(mesh.F, previous_halfedge(h)),
              q = halfedge_origin(mesh.F, previous_halfedge(g));
    if (at_flip[a] || at_flip[b] || at_flip[o] || at_flip[q]) continue;
    if (cotangent(mesh, a, b, o) + cotangent(mesh, a, b, q) >= -rounding || has_edge(connectivity, o, q))
      continue;
    if (lies_wrong(mesh, surface, a, q, o) || lies_wrong(mesh, surface, q, b, o)) continue;
    mesh.F.row(h / 3) << a, q, o;
    mesh.F.row(g / 3) << q, b, o;
    at_flip[a] = at_flip[b] = at_flip[o] = at_flip[q] = 1;
    ++flips;
  }
  return flips;
}

void flip_to_delaunay(Mesh& mesh, const SmoothSurface& surface) {
  for (int pass = 0; pass < flip_passes; ++pass) {
    if (flip_edges(mesh, surface) == 0) return;
  }
}

// ---- relaxing

// The area-weighted mean of the centroids of a vertex's triangles; for a boundary vertex, the middle of its
// two neighbours on the boundary.
Points centres(const Mesh& mesh, const Connectivity& connectivity, const std::vector<char>& on_rim) {
  Points sum = Points::Zero(mesh.V.rows(), 3);
  Eigen::VectorXd weight = Eigen::VectorXd::Zero(mesh.V.rows());
  const auto put = [&](int v, double w, const Vector3& p) {
    sum.row(v) += w * p;
    weight[v] += w;
  };
  for (int f = 0; f < face_count(mesh); ++f) {
    const int a = mesh.F(f, 0), b = mesh.F(f, 1), c = mesh.F(f, 2);
    const double area = area_vector(mesh, a, b, c).norm();
    const Vector3 centroid = (mesh.V.row(a) + mesh.V.row(b) + mesh.V.row(c)) / 3;
    for (const int v : {a, b, c}) {
      if (!on_rim[v]) put(v, area, centroid);
    }
  }
  for (int h = 0; h < static_cast<int>(mesh.F.size()); ++h) {
    if (connectivity.opposite[h] >= 0) continue;
    const int v = halfedge_origin(mesh.F, h), w = halfedge_target(mesh.F, h);
    put(v, 1, mesh.V.row(w));
    put(w, 1, mesh.V.row(v));
  }
  return sum.array().colwise() / weight.array();
}

// The positions of the vertices after each has moved towards the centre of its triangles. They move only
// along the surface: otherwise limbs would shrink.
Points centred(const Mesh& mesh, const SmoothSurface& surface, const Connectivity& connectivity) {
  const std::vector<char> on_rim = boundary_vertices(mesh, connectivity);
  Points result = centres(mesh, connectivity, on_rim);
  parallel_ranges(vertex_count(mesh), [&](int begin, int end) {
    for (int v = begin; v < end; ++v) {
      const Vector3 p = mesh.V.row(v), n = normal_at(surface, p), move = result.row(v).transpose() - p;
      const Vector3 moved = p + move - n.dot(move) * n;
      result.row(v) = on_rim[v] ? drawn_to_rim(surface, moved) : drawn(surface, moved);
    }
  });
  return result;
}

// Does a triangle turn its back to the surface, or nearly so?
bool lies_wrong(const Mesh& mesh, const Points& normal, int f) {
  constexpr double least_cosine = 0.2;
  const int a = mesh.F(f, 0), b = mesh.F(f, 1), c = mesh.F(f, 2);
  const Vector3 expected = (normal.row(a) + normal.row(b) + normal.row(c)).normalized();
  const Vector3 area = area_vector(mesh, a, b, c);
  return area.dot(expected) < least_cosine * area.norm();
}

// Moves all vertices to their centres, except those of triangles that would turn their back to the surface.
void relax(Mesh& mesh, const SmoothSurface& surface) {
  const Mesh before = mesh;
  const Points normal_before = normals(mesh.V, surface);
  mesh.V = centred(mesh, surface, mesh_connectivity(mesh));
  Points normal = normals(mesh.V, surface);
  for (bool put_back = true; put_back;) {
    put_back = false;
    for (int f = 0; f < face_count(mesh); ++f) {
      if (!lies_wrong(mesh, normal, f) || lies_wrong(before, normal_before, f)) continue;
      for (const int v : {mesh.F(f, 0), mesh.F(f, 1), mesh.F(f, 2)}) {
        mesh.V.row(v) = before.V.row(v);
        normal.row(v) = normal_before.row(v);
      }
      put_back = true;
    }
  }
}

void relax_and_flip(Mesh& mesh, const SmoothSurface& surface, int rounds) {
  for (int round = 0; round < rounds; ++round) {
    flip_to_delaunay(mesh, surface);
    relax(mesh, surface);
  }
  flip_to_delaunay(mesh, surface);
}

// ---- dividing

// How many faces to grow before the divisions. Closed triangle meshes have an even number of faces.
int grown_faces(const Mesh& mesh, int faces, int divisions) {
  const auto& opposite = mesh_connectivity(mesh).opposite;
  const bool closed = std::find(opposite.begin(), opposite.end(), -1) == opposite.end();
  const int unit = closed ? 2 : 1;
  const double wanted = std::ldexp(faces, -2 * divisions) / unit;
  return unit * static_cast<int>(divisions == 0 ? std::ceil(wanted) : std::round(wanted));
}

// Divides every triangle into four at the midpoints of its edges.
Mesh divided(const Mesh& mesh, const SmoothSurface& surface) {
  const Connectivity connectivity = mesh_connectivity(mesh);
  const std::vector<int> halfedge = halfedge_of_edges(connectivity);
  const int n = vertex_count(mesh), edges = static_cast<int>(connectivity.edges.size());
  Mesh result;
  result.V.resize(n + edges, 3);
  result.V.topRows(n) = mesh.V;
  parallel_ranges(edges, [&](int begin, int end) {
    for (int e = begin; e < end; ++e) {
      const auto [i, j] = connectivity.edges[e];
      result.V.row(n + e) = drawn_midpoint(mesh, surface, i, j, connectivity.opposite[halfedge[e]] < 0);
    }
  });
  result.F.resize(4 * mesh.F.rows(), 3);
  for (int f = 0; f < face_count(mesh); ++f) {
    const int a = mesh.F(f, 0), b = mesh.F(f, 1), c = mesh.F(f, 2);
    const int ab = n + connectivity.edge_of[3 * f], bc = n + connectivity.edge_of[3 * f + 1],
              ca = n + connectivity.edge_of[3 * f + 2];
    result.F.row(4 * f) << a, ab, ca;
    result.F.row(4 * f + 1) << b, bc, ab;
    result.F.row(4 * f + 2) << c, ca, bc;
    result.F.row(4 * f + 3) << ab, bc, ca;
  }
  return result;
}

}  // namespace

Mesh even_mesh(Mesh mesh, const SmoothSurface& surface, int faces) {
  int divisions = 0;
  for (double share = faces; share > most_grown_faces; share /= 4) ++divisions;
  const int grown = grown_faces(mesh, faces, divisions);

  for (Eigen::Index v = 0; v < mesh.V.rows(); ++v) mesh.V.row(v) = drawn(surface, mesh.V.row(v));
  while (face_count(mesh) < grown) {
    split_long_edges(mesh, surface, grown);
    relax_and_flip(mesh, surface, face_count(mesh) < fewest_relaxed_faces ? 0 : growing_rounds);
  }
  relax_and_flip(mesh, surface, final_rounds);
  for (int division = 0; division < divisions; ++division) {
    mesh = divided(mesh, surface);
    if (face_count(mesh) <= most_flipped_faces) flip_to_delaunay(mesh, surface);
    const Connectivity connectivity = mesh_connectivity(mesh);
    for (int round = 0; round < dividing_rounds; ++round) mesh.V = centred(mesh, surface, connectivity);
  }
  return mesh;
}

}  // namespace orbitutte
