// SPDX-License-Identifier: MIT
#include "command_arguments.h"
#include "commands.h"
#include "orbitutte/export/cut_triangles.h"
#include "orbitutte/export/export.h"
#include "orbitutte/export/sphere_surface.h"
#include "orbitutte/inspect/recognition.h"
#include "orbitutte/io/mesh_io.h"
#include "orbitutte/report/embedding_file.h"
#include "orbitutte/report/report.h"
#include "standard_streams.h"

namespace orbitutte::cli {

namespace {

bool is_brain_surface(MeshFormat format) {
  return format == MeshFormat::gifti || format == MeshFormat::freesurfer;
}

// The sphere alone.
int export_sphere(const ExportArguments& arguments, const Embedding& embedding, const Report& report) {
  require_cut_from(read_embedded(mesh_input(arguments.mesh, arguments.format), report), embedding);
  const PolygonMesh sphere = sphere_surface(embedding, arguments.radius);
  write_mesh(arguments.output, sphere);
  tell("{}: the sphere of radius {}, {} vertices, {} faces\n", arguments.output, arguments.radius,
       sphere.vertex_count(), sphere.face_count());
  return succeeded;
}

}  // namespace

int export_command(const ExportArguments& arguments) {
  std::optional<TextureChart> asked_for;
  if (!arguments.chart.empty()) asked_for = parse_choice<TextureChart>(arguments.chart, "--chart");
  const Report report = read_report(arguments.report);
  const Embedding embedding = read_embedding(arguments.embedding, report);
  warn(warnings_of_offsets(embedding));
  if (is_brain_surface(mesh_format(arguments.output))) return export_sphere(arguments, embedding, report);
  const TextureChart chart = asked_for.value_or(suitable_chart(embedding));
  const ExportedModel model =
      exported_model(read_embedded(mesh_input(arguments.mesh, arguments.format), report), embedding, chart);
  write_model(arguments.output, model);
  tell(
      "{}: {} vertices, {} texture coordinates, {} faces; largest area distortion of the {} chart "
      "{:.3g}\n",
      arguments.output, model.surface.V.rows(), model.texture.uv.rows(), model.surface.faces().count(),
      name_of(chart), model.texture.max_area_distortion);
  if (model.texture.torn_faces > 0)
    tell("orbitutte: warning: {} across the outer edge of the chart; choose another chart\n",
         counted(model.texture.torn_faces, "face"));
  return 0;
}

}  // namespace orbitutte::cli
