// SPDX-License-Identifier: MIT
#include "source_mesh.h"

#include "orbitutte/mesh/inspection.h"
#include "orbitutte/mesh/triangulation.h"
#include "orbitutte/output/embedding_file.h"

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

}  // namespace

SourceMesh::SourceMesh(PolygonMesh mesh) : input_(triangles_where_possible(std::move(mesh))) {}

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

Embedding SourceMesh::divided(Embedding embedding) const {
  const PolygonMesh* mesh = std::get_if<PolygonMesh>(&input_);
  if (!mesh || embedding.polygons.start != mesh->face_start) return embedding;
  require_embeddable(inspect(*mesh));
  embedding.faces = cut_triangles(*mesh, triangulate(*mesh), embedding);
  return embedding;
}

}  // namespace orbitutte::python
