// SPDX-License-Identifier: MIT
#include "commands.h"
#include "orbitutte/export/export.h"
#include "orbitutte/inspect/recognition.h"
#include "orbitutte/io/mesh_io.h"
#include "orbitutte/report/embedding_file.h"
#include "orbitutte/report/report.h"
#include "standard_streams.h"

namespace orbitutte::cli {

int export_command(const ExportArguments& arguments) {
  std::optional<TextureChart> asked_for;
  if (!arguments.chart.empty()) asked_for = parse_choice<TextureChart>(arguments.chart, "--chart");
  const Embedding embedding = read_embedding(arguments.embedding, read_report(arguments.report));
  const TextureChart chart = asked_for.value_or(suitable_chart(embedding));
  warn(warnings_of_offsets(embedding));
  const ExportedModel model = exported_model(make_surface(read_mesh(arguments.mesh)), embedding, chart);
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
