// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include "commands.h"
#include "orbitutte/mesh/file.h"
#include "orbitutte/mesh/mesh_io.h"
#include "orbitutte/output/page.h"
#include "orbitutte/output/report.h"

namespace orbitutte::cli {

int report_command(const ReportArguments& arguments) {
  constexpr int written = 0;
  const Embedding embedding = read_embedding(arguments.embedding, read_report(arguments.report));
  const Mesh mesh = to_triangle_mesh(read_mesh(arguments.mesh));
  const std::string report = read_file(arguments.report);
  write_file(arguments.output, report_page({mesh, embedding, report}));
  if (!has_interactive_view())
    fmt::print(stderr, "{}: without the interactive view, since this binary was built without Node.js\n",
               arguments.output);
  return written;
}

}  // namespace orbitutte::cli
