// SPDX-License-Identifier: MIT
#include "source_mesh.h"

#include <fmt/format.h>

#include <algorithm>

#include "orbitutte/export/cut_triangles.h"
#include "orbitutte/inspect/inspection.h"
#include "orbitutte/mesh/triangulation.h"

namespace orbitutte::python {
namespace {

std::variant<Mesh, PolygonMesh> triangles_where_possible(PolygonMesh mesh) {
  if (is_triangle_mesh(mesh)) return to_triangle_mesh(std::move(mesh));
  return mesh;
}

Mesh divide(const PolygonMesh& mesh) {
  require_embeddable(inspect(mesh));
  return {mesh.V, on_vertices(triangulate(mesh), mesh.corners)};
}

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
  const FaceView cut = embedding.input_faces();
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

SourceMesh::SourceMesh(PolygonMesh mesh)
    : warnings_(std::move(mesh.warnings)), input_(triangles_where_possible(std::move(mesh))) {}

const Points& SourceMesh::positions() const {
  return std::visit([](const auto& mesh) -> const Points& { return mesh.V; }, input_);
}

int SourceMesh::face_count() const {
  if (const Mesh* mesh = std::get_if<Mesh>(&input_)) return static_cast<int>(mesh->F.rows());
  return std::get<PolygonMesh>(input_).face_count();
}

PolygonMesh SourceMesh::polygons() const {
  if (const Mesh* mesh = std::get_if<Mesh>(&input_)) return to_polygon_mesh(*mesh);
  return std::get<PolygonMesh>(input_);
}

const Mesh& SourceMesh::triangles() const {
  if (const Mesh* mesh = std::get_if<Mesh>(&input_)) return *mesh;
  std::call_once(divided_, [&] { divided_mesh_ = divide(std::get<PolygonMesh>(input_)); });
  return divided_mesh_;
}

Connectivity SourceMesh::connectivity() const {
  if (const Mesh* mesh = std::get_if<Mesh>(&input_))
    return connect(mesh->F, static_cast<int>(mesh->V.rows()));
  const PolygonMesh& mesh = std::get<PolygonMesh>(input_);
  require_embeddable(inspect(mesh));
  return connect(mesh, triangulate(mesh));
}

Embedding SourceMesh::belonging(Embedding embedding) const {
  if (const Mesh* mesh = std::get_if<Mesh>(&input_)) {
    require_same_faces(mesh->V, FaceView(mesh->F), embedding);
    return embedding;
  }
  const PolygonMesh& mesh = std::get<PolygonMesh>(input_);
  require_same_faces(mesh.V, {mesh.corners, mesh.face_start}, embedding);
  require_embeddable(inspect(mesh));
  embedding.faces = cut_triangles(mesh, triangulate(mesh), embedding);
  return embedding;
}

}  // namespace orbitutte::python
