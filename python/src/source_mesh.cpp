// SPDX-License-Identifier: MIT
#include "source_mesh.h"

#include <fmt/format.h>

#include <algorithm>

#include "orbitutte/export/cut_triangles.h"
#include "orbitutte/inspect/recognition.h"
#include "orbitutte/mesh/triangulation.h"

namespace orbitutte::python {
namespace {

// The same corners, or the same the other way round from the first on.
bool is_same_face(std::span<const int> face, std::span<const int> cut,
                  const std::vector<int>& source_vertex) {
  const std::size_t n = face.size();
  if (cut.size() != n) return false;
  const auto agree = [&](const auto& index) {
    for (std::size_t k = 0; k < n; ++k)
      if (source_vertex[cut[k]] != face[index(k)]) return false;
    return true;
  };
  return agree([](std::size_t k) { return k; }) || agree([&](std::size_t k) { return (n - k) % n; });
}

void require_same_faces(const Points& V, const FaceView& faces, const Embedding& embedding) {
  const FaceView cut = embedding.faces();
  if (cut.count() != faces.count())
    throw MeshError(
        fmt::format("the embedding has {} faces, and the mesh has {}: it is the embedding of another mesh",
                    cut.count(), faces.count()));
  const int largest = embedding.source_vertex.empty()
                          ? -1
                          : *std::max_element(embedding.source_vertex.begin(), embedding.source_vertex.end());
  if (largest >= V.rows())
    throw MeshError(
        fmt::format("the embedding has the input vertex {}, and the mesh {} vertices: it is the embedding of "
                    "another mesh",
                    largest, V.rows()));
  for (int f = 0; f < faces.count(); ++f)
    if (!is_same_face(faces[f], cut[f], embedding.source_vertex))
      throw MeshError(fmt::format(
          "face {} of the mesh is not that of the embedding: it is the embedding of another mesh", f));
}

}  // namespace

template <typename AnyMesh>
SourceMesh::Input SourceMesh::judged(AnyMesh mesh) {
  try {
    return std::make_shared<const Surface>(make_surface(std::move(mesh)));
  } catch (const MeshError&) {
    return mesh;  // as it was
  }
}

SourceMesh::Input SourceMesh::judged_triangles_or_polygons(PolygonMesh mesh) {
  if (is_triangle_mesh(mesh)) return judged(to_triangle_mesh(std::move(mesh)));
  return judged(std::move(mesh));
}

SourceMesh::SourceMesh(Mesh mesh) : input_(judged(std::move(mesh))) {}

SourceMesh::SourceMesh(PolygonMesh mesh)
    : warnings_(std::move(mesh.warnings)), input_(judged_triangles_or_polygons(std::move(mesh))) {}

SourceMesh::Arrays SourceMesh::arrays() const {
  if (const Mesh* mesh = std::get_if<Mesh>(&input_)) return {&mesh->V, &mesh->F, nullptr, nullptr};
  if (const PolygonMesh* mesh = std::get_if<PolygonMesh>(&input_))
    return {&mesh->V, nullptr, &mesh->corners, &mesh->face_start};
  const Surface& surface = *std::get<SharedSurface>(input_);
  if (!surface.has_polygons()) return {&surface.V, &surface.triangles, nullptr, nullptr};
  return {&surface.V, nullptr, &surface.polygons.corners, &surface.polygons.start};
}

PolygonMesh SourceMesh::polygons() const {
  const auto [V, F, corners, start] = arrays();
  return F ? to_polygon_mesh({*V, *F}) : PolygonMesh{*V, *corners, *start};
}

std::shared_ptr<const Surface> SourceMesh::surface() const {
  if (const SharedSurface* surface = std::get_if<SharedSurface>(&input_)) return *surface;
  if (const Mesh* mesh = std::get_if<Mesh>(&input_))
    return std::make_shared<const Surface>(make_surface(*mesh));  // throws
  return std::make_shared<const Surface>(make_surface(std::get<PolygonMesh>(input_)));
}

std::pair<std::shared_ptr<SourceMesh>, std::vector<int>> SourceMesh::repaired() const {
  RepairInPlace repaired = repair_in_place(polygons());
  if (repaired.mesh.face_count() == 0)
    throw MeshError("no face is left after the repair; look at info(V, F)");
  auto mesh = std::make_shared<SourceMesh>(std::move(repaired.mesh));
  mesh->repair_ = std::move(repaired.summary);
  return {std::move(mesh), std::move(repaired.image)};
}

Embedding SourceMesh::belonging(Embedding embedding) const {
  const Arrays given = arrays();
  require_same_faces(*given.V, given.faces(), embedding);
  if (!given.F) embedding.triangles = cut_triangles(*surface(), embedding);
  return embedding;
}

}  // namespace orbitutte::python
