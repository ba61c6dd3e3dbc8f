// SPDX-License-Identifier: MIT
// verify, tile and sample: from files to files.
#include <fmt/format.h>

#include "command_arguments.h"
#include "commands.h"
#include "orbitutte/export/tiling.h"
#include "orbitutte/inspect/recognition.h"
#include "orbitutte/io/mesh_io.h"
#include "orbitutte/options.h"
#include "orbitutte/report/embedding_file.h"
#include "orbitutte/report/report.h"
#include "orbitutte/report/verification.h"
#include "orbitutte/samples/sample.h"
#include "orbitutte/version.h"
#include "standard_streams.h"

namespace orbitutte::cli {
namespace {

void print_rows(const std::vector<Check>& checks) {
  for (const Check& check : checks)
    fmt::print("{} {:<26} {}\n", check.passed ? "ok    " : "FAILED", check.name,
               check.passed ? fmt::format("{:.6g} (bound {:.6g})", check.value, check.bound) : check.detail);
}

void print_theorem2(const Theorem2& theorem2) {
  if (theorem2.status == Theorem2::Status::measured) {
    print_rows(theorem2.checks());
    fmt::print("theorem 2: its conditions {}; they are sufficient, and no part of the certificate\n",
               theorem2.holds() ? "hold" : "do not hold");
  } else {
    if (theorem2.max_edge_length > 0) print_rows(theorem2.checks());
    fmt::print("theorem 2: {}: {}\n", name_of(theorem2.status), theorem2.detail);
  }
}

void print_text(const Verdict& verdict) {
  print_rows(verdict.checks);
  fmt::print("{}\n", verdict.bijective ? "certified: bijective" : "not certified");
  if (verdict.theorem2) print_theorem2(*verdict.theorem2);
}

// The licence under which the binary may be passed on: docs/licences.md.
std::string licence_text(Backend backend, InertiaMethod inertia) {
  const bool gpl = backend == Backend::cholmod, mumps = inertia == InertiaMethod::mumps;
  std::string text = gpl ? "sources MIT; this binary GPL-3.0-or-later: CHOLMOD's supernodal module is "
                           "GPL-2.0-or-later, and other libraries are Apache-2.0"
                         : "MIT (with Eigen, MPL-2.0)";
  if (mumps) text += "; MUMPS CeCILL-C";
  if (gpl && mumps) text += ", doubtful beside the GPL: not to be passed on";
  return text;
}

}  // namespace

int verify_command(const VerifyArguments& arguments) {
  const Report report = read_report(arguments.report);
  const Embedding embedding = read_embedding(arguments.embedding, report);
  VerificationOptions options;
  options.weights_file = arguments.weights_file;
  options.theorem2 = arguments.theorem2;
  const Verdict verdict =
      verify(read_embedded(mesh_input(arguments.mesh, arguments.format), report), embedding, report, options);
  if (arguments.json) {
    fmt::print("{}", verdict_json(verdict));
  } else {
    print_text(verdict);
  }
  if (!verdict.sound) return not_certified;
  return verdict.converged ? succeeded : not_converged;
}

int tile_command(const TileArguments& arguments) {
  const Embedding embedding = read_embedding(arguments.embedding, read_report(arguments.report));
  warn(warnings_of_offsets(embedding));
  const Tiling tiling = weld_copies(embedding, arguments.copies);
  write_tiling(arguments.output, tiling);
  if (!tiling.left_out.empty())
    tell(
        "orbitutte: warning: {} of the input left out, beginning with face {}: all vertices lie on one "
        "mirror, "
        "where a face coincides with its mirror image\n",
        counted(std::ssize(tiling.left_out), "face"), tiling.left_out.front());
  tell("{}: {} copies, {} vertices, {} faces\n", arguments.output, tiling.copy_count(), tiling.mesh.V.rows(),
       tiling.faces().count());
  return succeeded;
}

int sample_command(const SampleArguments& arguments) {
  SampleOptions options;
  options.shape = parse_choice<SampleShape>(arguments.shape, "--shape");
  options.faces = arguments.faces;
  if (passes_through_itself(options.shape) && mesh_format(arguments.output) == MeshFormat::stl)
    throw ArgumentError(
        fmt::format("STL tells vertices apart by their positions alone, and {} passes through itself, where "
                    "different vertices may meet; write .obj, .off or .ply",
                    arguments.shape));
  const Mesh mesh = sample_mesh(options);
  write_mesh(arguments.output, mesh);
  tell("{}: {} vertices, {} faces\n", arguments.output, mesh.V.rows(), mesh.F.rows());
  return succeeded;
}

std::string version_text() {
  const Backend backend = available_backends().front();
  const InertiaMethod inertia = available_inertia_methods().front();
  return fmt::format("orbitutte {} ({})\nlinear algebra: {}, BLAS: {}; inertia: {}\nlicence: {}", version,
                     commit, name_of(backend), blas_description(), name_of(inertia),
                     licence_text(backend, inertia));
}

}  // namespace orbitutte::cli
