// SPDX-License-Identifier: MIT
#include "commands.h"
#include "orbitutte/mesh/inspection.h"
#include "orbitutte/mesh/mesh_io.h"
#include "orbitutte/mesh/triangulation.h"
#include "orbitutte/output/export.h"
#include "orbitutte/output/report.h"

namespace orbitutte::cli {

namespace {

// Both in the same triangles, where the mesh has polygons; where the embedding is none of the mesh,
// exported_model tells.
Mesh in_triangles(PolygonMesh mesh, Embedding& embedding) {
  if (is_triangle_mesh(mesh)) return to_triangle_mesh(std::move(mesh));
  const Triangulation triangulation = triangulate(mesh);
  if (embedding.polygons.start == mesh.face_start)
    embedding.faces = on_vertices(triangulation, embedding.polygons.corners);
  return {std::move(mesh.V), on_vertices(triangulation, mesh.corners)};
}

}  // namespace

int export_command(const ExportArguments& arguments) {
  const TextureChart chart = parse_texture_chart(arguments.chart);
  Embedding embedding = read_embedding(arguments.embedding, read_report(arguments.report));
  PolygonMesh mesh = read_mesh(arguments.mesh);
  require_embeddable(inspect(mesh));
  const Mesh triangles = in_triangles(std::move(mesh), embedding);
  const ExportedModel model = exported_model(triangles, embedding, chart);
  write_model(arguments.output, model);
  fmt::print(stderr,
             "{}: {} vertices, {} texture coordinates, {} triangles; largest area distortion of the {} chart "
             "{:.3g}\n",
             arguments.output, model.mesh.V.rows(), model.texture.uv.rows(), model.mesh.F.rows(), name(chart),
             model.texture.max_area_distortion);
  if (model.texture.torn_faces > 0)
    fmt::print(
        stderr,
        "orbitutte: warning: {} triangles lie across the outer edge of the chart; choose another chart\n",
        model.texture.torn_faces);
  return 0;
}

}  // namespace orbitutte::cli
