// SPDX-License-Identifier: MIT
// The command line: docs/file-formats.md and `orbitutte --help` say what it does; the library does it.
#include <CLI/CLI.hpp>
#include <exception>
#include <functional>
#include <memory>
#include <new>
#include <sstream>
#include <system_error>

#include "command_files.h"
#include "command_line.h"
#include "commands.h"
#include "orbitutte/errors.h"
#include "orbitutte/export/export.h"
#include "orbitutte/export/tiling.h"
#include "orbitutte/inspect/mesh_repair.h"
#include "orbitutte/io/mesh_io.h"
#include "standard_streams.h"
#include "usage.h"

namespace {

using namespace orbitutte::cli;

int complain(const std::string& message, ExitCode code) {
  tell("orbitutte: {}\n", message);
  return code;
}

// Runs a function that prints and returns an exit code. Every kind of failure has its exit code and one
// sentence on standard error.
int run(const std::function<int()>& command) {
  try {
    const int code = command();
    flush_standard_output();
    return code;
  } catch (const orbitutte::FileError& error) {
    return complain(error.what(), file_trouble);
  } catch (const std::bad_alloc&) {
    return complain("memory ran out", file_trouble);
  } catch (const orbitutte::ArgumentError& error) {
    return complain(error.what(), wrong_usage);
  } catch (const orbitutte::Error& error) {
    return complain(error.what(), unsuitable_mesh);
  } catch (const std::system_error& error) {  // fmt::print throws it
    const char* const place = std::ferror(stdout) ? "standard output cannot be written: " : "";
    return complain(place + error.code().message(), file_trouble);
  } catch (const std::exception& error) {
    return complain(error.what(), file_trouble);
  }
}

// A command while it is being defined. Its input and output files are checked before it runs.
template <typename Arguments>
class Command {
 public:
  Command(CLI::App& app, const std::string& name, const std::string& description)
      : command_(app.add_subcommand(name, description)) {}

  // Where the values of the options go.
  Arguments* operator->() const { return arguments_.get(); }

  template <typename Value>
  CLI::Option* option(const std::string& names, Value& value, const std::string& description) {
    return command_->add_option(names, value, description);
  }

  void flag(const std::string& names, bool& value, const std::string& description) {
    command_->add_flag(names, value, description);
  }

  CLI::Option* input(const std::string& names, std::string& path, const std::string& content,
                     const std::string& description) {
    inputs_.push_back({{content, ""}, &path});
    return command_->add_option(names, path, description);
  }

  // `file` has no path yet. Where there is a choice of endings, the description ends with them.
  CLI::Option* output(const std::string& names, std::string& path, const OutputFile& file,
                      const std::string& description) {
    outputs_.push_back({file, &path});
    return command_->add_option(names, path, with_endings(description, file.endings));
  }

  // The last step: `code` gets the exit code, and must outlive the application.
  void runs(int (*function)(const Arguments&), int& code) {
    command_->callback([command = *this, function, &code] {
      code = run([&] {
        require_sound_files(given(command.inputs_), given(command.outputs_));
        return function(*command.arguments_);
      });
    });
  }

 private:
  static std::string with_endings(const std::string& description, const std::vector<std::string>& endings) {
    return endings.size() < 2 ? description : description + ": " + orbitutte::listed_choices(endings);
  }

  // A file, and where its path will be once the command line is parsed.
  template <typename File>
  using Expected = std::pair<File, const std::string*>;

  template <typename File>
  static std::vector<File> given(const std::vector<Expected<File>>& expected) {
    std::vector<File> files;
    for (auto [file, path] : expected) {
      if (path->empty()) continue;
      file.path = *path;
      files.push_back(file);
    }
    return files;
  }

  CLI::App* command_;
  std::shared_ptr<Arguments> arguments_ = std::make_shared<Arguments>();
  std::vector<Expected<InputFile>> inputs_;
  std::vector<Expected<OutputFile>> outputs_;
};

const std::string mesh_formats = "OBJ, OFF, PLY, STL, VTK, GIfTI or FreeSurfer, plain or with .gz";

template <typename Arguments>
void read_mesh_of(Command<Arguments>& command) {
  command.input("mesh", command->mesh, "the mesh", "The mesh: " + mesh_formats)->required();
}

// The two files that `embed` writes.
template <typename Arguments>
void read_embedding_of(Command<Arguments>& command) {
  command.input("embedding", command->embedding, "the embedding", "The embedding (PLY)")->required();
  command.input("report", command->report, "the report", "The report of the embedding (JSON)")->required();
}

template <typename Arguments>
void read_embedding_and_mesh_of(Command<Arguments>& command) {
  read_embedding_of(command);
  command.input("mesh", command->mesh, "the mesh", "The mesh that was embedded")->required();
}

// Which vertices are marked, and by what the best are chosen.
template <typename Arguments>
void marks_of(Command<Arguments>& command) {
  command.option("--cones", command->cones,
                 "The marked vertices, counted from 0, in the order of the symbol, 'best' in place of those "
                 "that the program chooses, as in 12,best,best; 'best' for all of them, which is taken if "
                 "none are given; or 'extremities'");
  command
      .option("--objective", command->objective,
              "Choose for the least: sigma (the standard deviation of the logarithm of the scale), "
              "symmetric-dirichlet, or range (of the scale)")
      ->capture_default_str();
}

void add_embed(CLI::App& app, int& code) {
  Command<EmbedArguments> command(app, "embed", "Embed a mesh into an orbifold and certify the result");
  read_mesh_of(command);
  command.option(
      "--orbifold", command->orbifold,
      "Conway's symbol, such as 432, *532 or 2,2,12 ('orbitutte types' lists those of the sphere and the "
      "plane; larger or more orders, such as 7,3,2 or 2,2,2,2,2, are hyperbolic); 'best' (the default), the "
      "spherical one of least distortion; 1 or 'sphere', the whole sphere; * or 'hemisphere'; 'cones' or "
      "'*cones', cones of any angles, on the sphere, in the plane or in the hyperbolic plane, as the angles "
      "say; or 'polygon', a fixed boundary");
  marks_of(command);
  command.option(
      "--angles", command->angles,
      "Of 'cones' and '*cones': the angle of each marked vertex, in radians or multiples of pi, as in "
      "pi,1.5pi,0.75pi,0.75pi; or 'fitted', those of least distortion");
  command.option("--count", command->count,
                 "With --angles fitted: how many cones there are, those that --cones gives included");
  command.option(
      "--sigma", command->sigma,
      "With --angles fitted: as few cones as leave this standard deviation of the logarithm of the "
      "scale");
  command.option("--area", command->area,
                 "With --angles fitted: the area of the target, above 0 on the sphere, below 0 in the "
                 "hyperbolic plane; 0, the plane, is the default");
  command.flag("--orders", command->orders,
               "With --angles fitted: take angles of orbifolds alone, 2 pi/n, and pi/n at corners");
  command.option("--centre", command->centre,
                 "Of the whole sphere and the hemisphere: what comes to lie at the centre, area (of the "
                 "surface; the default) or vertices; sigma, for the least distortion of areas; or none");
  command.input("--points", command->points, "the points",
                "Of the whole sphere and the hemisphere: put up to three vertices at given points; a file of "
                "lines 'vertex x y z'");
  command.flag(
      "--quotient", command->quotient,
      "Write the quotient of the map by its group, a map to the whole sphere or a hemisphere; for NN, "
      "*NN, N*, 222 and *222");
  CLI::Option* const polygon =
      command.input("--polygon", command->polygon, "the polygon",
                    "The corners of the polygon: a file of lines 'vertex x y z', counterclockwise");
  command
      .option("--spread", command->spread,
              "How boundary vertices are spread along the sides of the polygon: arc-length or equidistant")
      ->capture_default_str()
      ->needs(polygon);
  command.output("-o,--output", command->output, {"-o", "the embedding", "", {".ply"}},
                 "Write the embedding (binary PLY) here");
  command.output("--report", command->report, {"--report", "the report", "", {".json"}},
                 "Write the report (JSON) here");
  command
      .option("--weights", command->weights,
              "cotan, delaunay, mean-value, uniform, or standard: delaunay if all faces are triangles, "
              "otherwise cotan")
      ->capture_default_str();
  command
      .option("--clamp", command->clamp,
              "This weight replaces every cotangent weight that is zero or negative")
      ->capture_default_str();
  command.input("--weights-file", command->weights_file, "the weights",
                "Read the weights from this file: lines 'i j w', every edge once");
  command.option("--cut-seed", command->cut_seed, "Another number gives another cut through the same cones")
      ->capture_default_str();
  command
      .option("--tolerance", command->tolerance,
              "Stop if the gradient and the last step are smaller than this")
      ->capture_default_str();
  command
      .option("--max-iterations", command->max_iterations, "Stop with exit code 4 after so many iterations")
      ->capture_default_str();
  command.option("--threads", command->threads, "Use so many threads; 0: one for every core")
      ->capture_default_str();
  command.flag("--floor", command->floor,
               "Also measure the distortion that the coarseness of the mesh costs: that of the map of the "
               "same surface "
               "subdivided twice, at the vertices of this mesh; embeds a mesh with 16 times as many faces");
  command.flag("--quiet", command->quiet, "Print no progress and no summary");
  command.flag("--json", command->json, "Print the report on standard output");
  command.runs(embed_command, code);
}

void add_choose(CLI::App& app, int& code) {
  Command<ChooseArguments> command(
      app, "choose",
      "List the spherical orbifolds that a mesh embeds into, each with its best cones, the best first");
  read_mesh_of(command);
  command.option("--orbifold", command->orbifold, "Only this orbifold, of any space: its symbol");
  marks_of(command);
  command.option("--weights", command->weights, "As of embed")->capture_default_str();
  command.option("--solved", command->solved, "Embed so many of the best, and certify them")
      ->capture_default_str();
  command.option("--threads", command->threads, "Use so many threads; 0: one for every core")
      ->capture_default_str();
  command.output("-o,--output", command->output, {"-o", "the table", "", {".json"}},
                 "Write the table (JSON) here");
  command.output(
      "--picture", command->picture, {"--picture", "the picture", "", {".png"}},
      "Draw the scale of the best map on the mesh, with its cones and the vertices among which the "
      "search began");
  command.flag("--json", command->json, "Print JSON");
  command.runs(choose_command, code);
}

void add_info(CLI::App& app, int& code) {
  Command<InfoArguments> command(
      app, "info", "Show topology, quality and every defect of a mesh, and what it can be embedded into");
  read_mesh_of(command);
  command.flag("--json", command->json, "Print JSON");
  command.runs(info_command, code);
}

void add_types(CLI::App& app, int& code) {
  Command<TypesArguments> command(app, "types", "List the families of orbifolds");
  command.flag("--json", command->json, "Print JSON");
  command.runs(types_command, code);
}

void add_verify(CLI::App& app, int& code) {
  Command<VerifyArguments> command(app, "verify", "Certify an embedding again, from its files alone");
  read_embedding_and_mesh_of(command);
  command.input("--weights-file", command->weights_file, "the weights",
                "The weights of the embedding, if they came from a file");
  command.flag("--theorem2", command->theorem2,
               "Also check the conditions of theorem 2; they change neither the verdict nor the exit code");
  command.flag("--json", command->json, "Print JSON");
  command.runs(verify_command, code);
}

void add_tile(CLI::App& app, int& code) {
  Command<TileArguments> command(
      app, "tile",
      "Weld all copies of an embedding into one closed mesh, or some into a patch of the plane or the "
      "hyperbolic plane");
  read_embedding_of(command);
  command
      .output("-o,--output", command->output, {"-o", "the tiling", "", orbitutte::tiling_endings()},
              "Write the tiling here")
      ->required();
  command
      .option("--copies", command->copies,
              "Where the group is infinite: weld so many copies, the nearest first")
      ->capture_default_str();
  command.runs(tile_command, code);
}

void add_export(CLI::App& app, int& code) {
  Command<ExportArguments> command(
      app, "export", "Write the mesh with its embedding as texture coordinates, for other programs");
  read_embedding_and_mesh_of(command);
  command
      .output("-o,--output", command->output, {"-o", "the model", "", orbitutte::model_endings()},
              "Write the model here")
      ->required();
  command.option(
      "--chart", command->chart,
      "How the sphere is laid into the texture: stereographic, equirectangular or octahedral; if it "
      "is not given, stereographic, but equirectangular for the whole sphere");
  command.runs(export_command, code);
}

// From where pictures show the mesh.
template <typename Arguments>
void view_of_mesh(Command<Arguments>& command) {
  command.option("--view", command->view,
                 "Where the viewer is: front, back, left, right, top, bottom or 'x,y,z'; the program chooses "
                 "if this is not given");
  command.option("--up", command->up,
                 "The direction that points up: x, y, z, -x, -y, -z or 'x,y,z'; y or z if this is not given");
}

void add_render(CLI::App& app, int& code) {
  Command<RenderArguments> command(app, "render", "Draw pictures of an embedding: PNG, and SVG for plots");
  read_embedding_and_mesh_of(command);
  command
      .output("-o,--output", command->output, {"-o", "the picture", "", {".png", ".svg"}},
              "Write the picture here, as .svg only plots")
      ->required();
  command
      .option("--panel", command->panel,
              "source, sphere, area, angle, checkerboard, histogram, convergence, or sheet: all of them")
      ->capture_default_str();
  view_of_mesh(command);
  command.option("--size", command->size, "Width and height in pixels, such as 1600x1200, or 900 for both");
  command.runs(render_command, code);
}

void add_report(CLI::App& app, int& code) {
  Command<ReportArguments> command(
      app, "report", "Write one HTML page with everything about an embedding, and an interactive view");
  read_embedding_and_mesh_of(command);
  command
      .output("-o,--output", command->output, {"-o", "the page", "", {".html", ".htm"}},
              "Write the page (HTML) here")
      ->required();
  command.runs(report_command, code);
}

void add_compare(CLI::App& app, int& code) {
  Command<CompareArguments> command(
      app, "compare",
      "Embed a mesh into several orbifolds, of the sphere and the plane, and compare the distortion");
  read_mesh_of(command);
  command
      .option("--cones", command->cones,
              "As of embed: vertices, which all symbols share, or 'extremities'; the program chooses none of "
              "them")
      ->capture_default_str();
  command
      .option("--orbifold", command->orbifolds,
              "The symbols to compare; if none is given, 432 and 442, or *432 and *442 for a disk")
      ->expected(1, -1);
  command.option("--weights", command->weights, "As of embed")->capture_default_str();
  command.output("-o,--output", command->output, {"-o", "the picture", "", {".png", ".svg"}},
                 "Draw all here, as .svg only the histogram");
  view_of_mesh(command);
  command.flag("--json", command->json, "Print JSON");
  command.runs(compare_command, code);
}

void add_repair(CLI::App& app, int& code) {
  Command<RepairArguments> command(
      app, "repair", "Weld, clean, cut apart and close a mesh, so that it can be embedded; says what it did");
  read_mesh_of(command);
  command
      .output("-o,--output", command->output, {"-o", "the mesh", "", orbitutte::mesh_endings()},
              "Write the repaired mesh here")
      ->required();
  command.output("--report", command->report, {"--report", "the report", "", {".json"}},
                 "Write what was done here, and for each vertex that of the input (-1 for new ones): .json");
  command
      .option("--weld", command->weld,
              "Vertices at most so far apart become one; 0 welds those at the same point")
      ->capture_default_str();
  command.option("--fill-holes", command->fill_holes,
                 "Fill all holes of at most so many edges; if this is not given, all but the longest");
  command.flag("--drop-flat", command->drop_flat, "Drop triangles without area, too, which opens holes");
  command
      .option("--without", command->without,
              fmt::format("Leave out these steps: {}",
                          fmt::join(orbitutte::choices_of<orbitutte::RepairStep>(), ", ")))
      ->expected(1, -1);
  command.flag("--json", command->json, "Print the report on standard output");
  command.runs(repair_command, code);
}

void add_map(CLI::App& app, int& code) {
  Command<MapArguments> command(
      app, "map", "Map one surface to another so that landmarks correspond, one to one, and certify it");
  command.input("a", command->a, "surface A", "Surface A: " + mesh_formats)->required();
  command.input("b", command->b, "surface B", "Surface B, of the same topology")->required();
  command.option(
      "--landmarks", command->landmarks,
      "Vertices that correspond, counted from 0: a file with two columns, of A and of B, or a list such as "
      "12:7,300:512,48:9; without it, a guess between two spheres");
  command.option("-o,--output", command->output,
                 "Write the files of the map into this folder, which is made if it is not there");
  command
      .option("--tile", command->tile,
              "The shape of the tile that both surfaces are mapped onto: shared, that for which the map is "
              "most even, or regular")
      ->capture_default_str();
  command.option("--tour", command->tour,
                 "The order in which cuts lead through the landmarks inside, counted from 0; the shortest is "
                 "taken if this is not given");
  command.option("--weights", command->weights, "As of embed")->capture_default_str();
  command.option("--clamp", command->clamp, "As of embed")->capture_default_str();
  command.option("--cut-seed-a", command->cut_seed_a, "Another number gives another cut of A, the same map")
      ->capture_default_str();
  command.option("--cut-seed-b", command->cut_seed_b, "The same of B")->capture_default_str();
  command
      .option("--tolerance", command->tolerance,
              "As of embed. The default is finer, because errors in shrunk limbs appear in full size on the "
              "other surface; hyperbolic tiles stop at 1e-9")
      ->capture_default_str();
  command.option("--max-iterations", command->max_iterations, "As of embed")->capture_default_str();
  command.option("--threads", command->threads, "Use so many threads; 0: one for every core")
      ->capture_default_str();
  command.flag("--quiet", command->quiet, "Print no progress and no summary");
  command.flag("--json", command->json, "Print map.json on standard output");
  command.runs(map_command, code);
}

void add_sample(CLI::App& app, int& code) {
  Command<SampleArguments> command(app, "sample", "Make a mesh to try things on");
  command
      .output("-o,--output", command->output, {"-o", "the mesh", "", orbitutte::mesh_endings()},
              "Write the mesh here")
      ->required();
  command
      .option("--shape", command->shape,
              "figure (a sphere with limbs), mask (a disk), or a projective plane: boy (Boy's surface), "
              "roman (Steiner's), crosscap, quotient (a centrally symmetric figure's)")
      ->capture_default_str();
  command.option("--faces", command->faces, "Make about so many faces, all triangles")->capture_default_str();
  command.runs(sample_command, code);
}

// Help and version on standard output, everything else on standard error.
int answer(const CLI::App& app, const CLI::ParseError& error) {
  if (error.get_exit_code() != static_cast<int>(CLI::ExitCodes::Success))
    return complain(usage_message(app, error), wrong_usage);
  std::ostringstream text, nothing;
  app.exit(error, text, nothing);
  fmt::print("{}", text.str());
  return succeeded;
}

}  // namespace

namespace orbitutte::cli {

void add_commands(CLI::App& app, int& code) {
  app.set_version_flag("--version", version_text());
  app.require_subcommand(1);
  add_embed(app, code);
  add_choose(app, code);
  add_info(app, code);
  add_types(app, code);
  add_verify(app, code);
  add_tile(app, code);
  add_export(app, code);
  add_render(app, code);
  add_report(app, code);
  add_compare(app, code);
  add_repair(app, code);
  add_map(app, code);
  add_sample(app, code);
}

int run_command_line(int argc, char** argv) {
  CLI::App app("orbitutte: spherical orbifold Tutte embeddings", "orbitutte");
  int code = succeeded;
  add_commands(app, code);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return run([&] { return answer(app, error); });
  }
  return code;
}

}  // namespace orbitutte::cli
