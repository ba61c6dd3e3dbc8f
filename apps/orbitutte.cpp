// SPDX-License-Identifier: MIT
// The command line: docs/file-formats.md and `orbitutte --help` say what it does; the library does it.
#include <CLI/CLI.hpp>
#include <exception>
#include <new>

#include "command_line.h"
#include "commands.h"
#include "orbitutte/memory.h"
#include "orbitutte/types.h"

namespace {

using namespace orbitutte::cli;

int complain(const char* message, ExitCode code) {
  fmt::print(stderr, "orbitutte: {}\n", message);
  return code;
}

// One sentence on standard error and the exit code of each kind of failure.
template <typename Command>
int run(const Command& command) {
  try {
    return command();
  } catch (const orbitutte::FileError& error) {
    return complain(error.what(), file_trouble);
  } catch (const std::bad_alloc&) {
    return complain("memory ran out", file_trouble);
  } catch (const orbitutte::ArgumentError& error) {
    return complain(error.what(), wrong_usage);
  } catch (const orbitutte::Error& error) {
    return complain(error.what(), unsuitable_mesh);
  }
}

void add_embed(CLI::App& app, int& code) {
  auto* command =
      app.add_subcommand("embed", "Embed a mesh into a spherical orbifold and certify the result");
  auto arguments = std::make_shared<EmbedArguments>();
  command->add_option("mesh", arguments->mesh, "The mesh: OBJ, OFF, PLY or STL")->required();
  command
      ->add_option("--orbifold", arguments->orbifold,
                   "Conway's symbol, e.g. 432, *532, 2,2,12; or 'polygon', a fixed boundary")
      ->required();
  command->add_option(
      "--cones", arguments->cones,
      "The marked vertices, 0-based, in the order of the symbol, or 'auto'; not for a polygon");
  auto* polygon =
      command->add_option("--polygon", arguments->polygon,
                          "The corners of the polygon: a file of lines 'vertex x y z', counterclockwise");
  command
      ->add_option("--spread", arguments->spread,
                   "How boundary vertices are spread along the polygon's sides: arc-length or equidistant")
      ->capture_default_str()
      ->needs(polygon);
  command->add_option("-o,--output", arguments->output, "Write the embedding (binary PLY) here");
  command->add_option("--report", arguments->report, "Write the report (JSON) here");
  command
      ->add_option("--weights", arguments->weights,
                   "cotan, delaunay, mean-value, uniform, or standard: delaunay, and cotan where faces are "
                   "no triangles")
      ->capture_default_str();
  command->add_option("--clamp", arguments->clamp, "What cotangent weights that are not positive become")
      ->capture_default_str();
  command->add_option("--weights-file", arguments->weights_file, "Lines 'i j w', every edge once");
  command->add_option("--cut-seed", arguments->cut_seed, "Another cut through the same cones")
      ->capture_default_str();
  command->add_option("--tolerance", arguments->tolerance, "On the gradient and on the last step")
      ->capture_default_str();
  command->add_option("--max-iterations", arguments->max_iterations, "Then give up with exit code 4")
      ->capture_default_str();
  command->add_option("--threads", arguments->threads, "0: all cores")->capture_default_str();
  command->add_flag("--quiet", arguments->quiet, "No progress and no summary");
  command->add_flag("--json", arguments->json, "The report on standard output");
  command->callback([arguments, &code] { code = run([&] { return embed_command(*arguments); }); });
}

void add_info(CLI::App& app, int& code) {
  auto* command = app.add_subcommand(
      "info", "Topology, quality, every defect found, and what the mesh can be embedded into");
  auto arguments = std::make_shared<InfoArguments>();
  command->add_option("mesh", arguments->mesh, "The mesh: OBJ, OFF, PLY or STL")->required();
  command->add_flag("--json", arguments->json, "As JSON");
  command->callback([arguments, &code] { code = run([&] { return info_command(*arguments); }); });
}

void add_types(CLI::App& app, int& code) {
  auto* command = app.add_subcommand("types", "The families of orbifolds");
  auto json = std::make_shared<bool>(false);
  command->add_flag("--json", *json, "As JSON");
  command->callback([json, &code] { code = run([&] { return types_command(*json); }); });
}

void add_verify(CLI::App& app, int& code) {
  auto* command = app.add_subcommand("verify", "The certificate again, from the files alone");
  auto arguments = std::make_shared<VerifyArguments>();
  command->add_option("embedding", arguments->embedding, "The embedding (PLY)")->required();
  command->add_option("report", arguments->report, "Its report (JSON)")->required();
  command->add_option("mesh", arguments->mesh, "The input mesh")->required();
  command->add_option("--weights-file", arguments->weights_file,
                      "The weights that the embedding was computed with, where they came from a file");
  command->add_flag("--theorem2", arguments->theorem2,
                    "Also the conditions of theorem 2; they change neither the verdict nor the exit code");
  command->add_flag("--json", arguments->json, "As JSON");
  command->callback([arguments, &code] { code = run([&] { return verify_command(*arguments); }); });
}

void add_tile(CLI::App& app, int& code) {
  auto* command = app.add_subcommand("tile", "All copies of an embedding, welded into one closed mesh");
  auto arguments = std::make_shared<TileArguments>();
  command->add_option("embedding", arguments->embedding, "The embedding (PLY)")->required();
  command->add_option("report", arguments->report, "Its report (JSON)")->required();
  command->add_option("-o,--output", arguments->output, "The tiling: .ply, .obj, .glb or .stl")->required();
  command->callback([arguments, &code] { code = run([&] { return tile_command(*arguments); }); });
}

void add_export(CLI::App& app, int& code) {
  auto* command =
      app.add_subcommand("export", "The mesh with its embedding as texture coordinates, for other programs");
  auto arguments = std::make_shared<ExportArguments>();
  command->add_option("embedding", arguments->embedding, "The embedding (PLY)")->required();
  command->add_option("report", arguments->report, "Its report (JSON)")->required();
  command->add_option("mesh", arguments->mesh, "The input mesh")->required();
  command->add_option("-o,--output", arguments->output, "The model: .obj, .glb, .ply or .vtp")->required();
  command
      ->add_option("--chart", arguments->chart,
                   "Of the sphere into the texture: stereographic, equirectangular or octahedral")
      ->capture_default_str();
  command->callback([arguments, &code] { code = run([&] { return export_command(*arguments); }); });
}

void add_render(CLI::App& app, int& code) {
  auto* command = app.add_subcommand("render", "Pictures of an embedding: PNG, and SVG for the plots");
  auto arguments = std::make_shared<RenderArguments>();
  command->add_option("embedding", arguments->embedding, "The embedding (PLY)")->required();
  command->add_option("report", arguments->report, "Its report (JSON)")->required();
  command->add_option("mesh", arguments->mesh, "The input mesh")->required();
  command->add_option("-o,--output", arguments->output, "The picture: .png or .svg")->required();
  command
      ->add_option("--panel", arguments->panel,
                   "source, sphere, area, angle, checkerboard, histogram, convergence, or sheet: all of them")
      ->capture_default_str();
  command->add_option("--view", arguments->view,
                      "front, back, left, right, top, bottom or 'x,y,z' towards the viewer; default: chosen");
  command->add_option("--up", arguments->up,
                      "What points up: x, y, z, -x, -y, -z or 'x,y,z'; default: y or z");
  command->add_option("--size", arguments->size, "Pixels, e.g. 1600x1200 or 900");
  command->callback([arguments, &code] { code = run([&] { return render_command(*arguments); }); });
}

void add_report(CLI::App& app, int& code) {
  auto* command = app.add_subcommand(
      "report", "One HTML page with everything about an embedding, and an interactive view");
  auto arguments = std::make_shared<ReportArguments>();
  command->add_option("embedding", arguments->embedding, "The embedding (PLY)")->required();
  command->add_option("report", arguments->report, "Its report (JSON)")->required();
  command->add_option("mesh", arguments->mesh, "The input mesh")->required();
  command->add_option("-o,--output", arguments->output, "The page (HTML)")->required();
  command->callback([arguments, &code] { code = run([&] { return report_command(*arguments); }); });
}

void add_compare(CLI::App& app, int& code) {
  auto* command = app.add_subcommand(
      "compare",
      "Embeddings of one mesh into several orbifolds, of the sphere and the plane: their distortion side by side");
  auto arguments = std::make_shared<CompareArguments>();
  command->add_option("mesh", arguments->mesh, "The mesh: OBJ, OFF, PLY or STL")->required();
  command
      ->add_option("--cones", arguments->cones,
                   "The marked vertices, in the order of all symbols, or 'auto'")
      ->capture_default_str();
  command
      ->add_option("--orbifold", arguments->orbifolds,
                   "The symbols to compare; 432 and 442, of disks *432 and *442, unless given")
      ->expected(1, -1);
  command->add_option("--weights", arguments->weights, "As of embed")->capture_default_str();
  command->add_option("-o,--output", arguments->output,
                      "Draw both here: .png (mesh and histogram), .svg (histogram)");
  command->add_flag("--json", arguments->json, "As JSON");
  command->callback([arguments, &code] { code = run([&] { return compare_command(*arguments); }); });
}

void add_sample(CLI::App& app, int& code) {
  auto* command = app.add_subcommand("sample", "Generate a mesh to try things on");
  auto arguments = std::make_shared<SampleArguments>();
  command->add_option("-o,--output", arguments->output, "The mesh: .obj, .off, .ply or .stl")->required();
  command
      ->add_option("--shape", arguments->shape,
                   "figure (a sphere with limbs), mask (a disk), or a projective plane: boy (Boy's surface), "
                   "roman (Steiner's), crosscap, quotient (a centrally symmetric figure's)")
      ->capture_default_str();
  command->add_option("--faces", arguments->faces, "About so many triangles")->capture_default_str();
  command->callback([arguments, &code] { code = run([&] { return sample_command(*arguments); }); });
}

}  // namespace

namespace orbitutte::cli {

void add_commands(CLI::App& app, int& code) {
  app.set_version_flag("--version", version_text());
  app.require_subcommand(1);
  add_embed(app, code);
  add_info(app, code);
  add_types(app, code);
  add_verify(app, code);
  add_tile(app, code);
  add_export(app, code);
  add_render(app, code);
  add_report(app, code);
  add_compare(app, code);
  add_sample(app, code);
}

int run_command_line(int argc, char** argv) {
  CLI::App app("orbitutte: spherical orbifold Tutte embeddings", "orbitutte");
  int code = 0;
  add_commands(app, code);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : wrong_usage;
  } catch (const std::exception& error) {
    return complain(error.what(), file_trouble);
  }
  return code;
}

}  // namespace orbitutte::cli
