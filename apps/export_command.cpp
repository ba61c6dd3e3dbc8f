// SPDX-License-Identifier: MIT
#include "command_arguments.h"
#include "commands.h"
#include "orbitutte/output/export.h"
#include "orbitutte/output/report.h"

namespace orbitutte::cli {

int export_command(const ExportArguments& arguments) {
  const TextureChart chart = parse_texture_chart(arguments.chart);
  Embedding embedding = read_embedding(arguments.embedding, read_report(arguments.report));
  const Mesh triangles = read_source(arguments.mesh, embedding).triangles;
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
