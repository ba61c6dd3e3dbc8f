// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include "command_arguments.h"
#include "commands.h"
#include "orbitutte/io/file.h"
#include "orbitutte/page/page.h"
#include "orbitutte/report/embedding_file.h"
#include "orbitutte/report/report.h"
#include "page_pictures.h"
#include "standard_streams.h"

namespace orbitutte::cli {

int report_command(const ReportArguments& arguments) {
  constexpr int written = 0;
  const Report claims = read_report(arguments.report);
  Embedding embedding = read_embedding(arguments.embedding, claims);
  warn(warnings_of_offsets(embedding));
  const Surface surface = read_source(arguments.mesh, embedding);
  const std::string report = read_file(arguments.report);
  PageOptions options;
  if (!has_interactive_view()) options.pictures = page_pictures(surface, embedding, claims);
  write_file(arguments.output, report_page({surface, embedding, report}, options));
  tell("{}: page of {}\n", arguments.output, arguments.embedding);
  if (!has_interactive_view())
    tell("{} has no interactive view, because this program was built without Node.js\n", arguments.output);
  return written;
}

}  // namespace orbitutte::cli
