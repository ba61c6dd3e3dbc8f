// SPDX-License-Identifier: MIT
// The command line: docs/file-formats.md and `orbitutte --help` say what it does; the library does it.
#include <CLI/CLI.hpp>
#include <memory>
#include <sstream>

#include "command_files.h"
#include "command_line.h"
#include "commands.h"
#include "embed_columns.h"
#include "orbitutte/errors.h"
#include "orbitutte/export/export.h"
#include "orbitutte/export/tiling.h"
#include "orbitutte/inspect/mesh_repair.h"
#include "orbitutte/io/manifest.h"
#include "orbitutte/io/mesh_io.h"
#include "run.h"
#include "standard_streams.h"
#include "usage.h"

namespace {

using namespace orbitutte::cli;

// A command while it is being defined. Its input and output files are checked before it runs.
template <typename Arguments>
class Command {
 public:
  Command(CLI::App& app, const std::string& name, const std::string& description)
      : command_(app.add_subcommand(name, description)) {}

  std::vector<const CLI::Option*> options() const {
    const CLI::App* const command = command_;
    return command->get_options();
  }

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
    return command_->add_option(names, path, with_endings(description, file));
  }

  // Runs before the command itself.
  void prepares(void (*function)(const CLI::App&, Arguments&)) { prepare_ = function; }

  // The last step: `code` gets the exit code, and must outlive the application.
  void runs(int (*function)(const Arguments&), int& code) {
    command_->callback([command = *this, function, &code] {
      code = run_guarded([&] {
        require_sound_files(given(command.inputs_), given(command.outputs_));
        if (command.prepare_) command.prepare_(*command.command_, *command.arguments_);
        return function(*command.arguments_);
      });
    });
  }

 private:
  static std::string with_endings(const std::string& description, const OutputFile& file) {
    return file.endings.size() < 2 ? description : description + ": " + file.listed_endings();
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
  void (*prepare_)(const CLI::App&, Arguments&) = nullptr;
  std::shared_ptr<Arguments> arguments_ = std::make_shared<Arguments>();
  std::vector<Expected<InputFile>> inputs_;
  std::vector<Expected<OutputFile>> outputs_;
};

const std::string mesh_formats = "OBJ, OFF, PLY, STL, VTK, VTP, glTF, GIfTI or FreeSurfer, plain or with .gz";

// The format of the mesh.
template <typename Arguments>
void format_of(Command<Arguments>& command) {
  command.option(
      "--format", command->format,
      fmt::format("The format of the mesh, if the name does not end in it, as that of standard input: {}",
                  fmt::join(orbitutte::choices_of<orbitutte::MeshFormat>(), ", ")));
}

template <typename Arguments>
void read_mesh_of(Command<Arguments>& command) {
  command
      .input("mesh", command->mesh, "the mesh",
             fmt::format("The mesh: {}; '-' is standard input", mesh_formats))
      ->required();
  format_of(command);
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
  command.input("mesh", command->mesh, "the mesh", "The mesh that was embedded; '-' is standard input")
      ->required();
  format_of(command);
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

// What `embed` and every job of `batch` may be asked for.
template <typename Arguments>
void wishes_of(Command<Arguments>& command) {
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
  command.flag("--repair", command->repair,
               "First do what 'orbitutte repair' does, and say what that was; vertices keep their numbers");
  command.flag("--floor", command->floor,
               "Also measure the distortion that the coarseness of the mesh costs: that of the map of the "
               "same surface "
               "subdivided twice, at the vertices of this mesh; embeds a mesh with 16 times as many faces");
}

Command<EmbedArguments> embed_definition(CLI::App& app) {
  Command<EmbedArguments> command(app, "embed", "Embed a mesh into an orbifold and certify the result");
  read_mesh_of(command);
  wishes_of(command);
  command.output("-o,--output", command->output, {"-o", "the embedding", "", {".ply"}},
                 "Write the embedding (binary PLY) here");
  command.output("--report", command->report, {"--report", "the report", "", {".json"}},
                 "Write the report (JSON) here");
  command.option("--threads", command->threads, "Use so many threads; 0: one for every core")
      ->capture_default_str();
  command.flag("--quiet", command->quiet, "Print no progress and no summary");
  command.flag("--json", command->json, "Print the report on standard output");
  return command;
}

void add_embed(CLI::App& app, int& code) { embed_definition(app).runs(embed_command, code); }

// The options of `embed` that were given, as on the command line.
void keep_wishes(const CLI::App& app, BatchArguments& arguments) {
  for (const orbitutte::ManifestColumn& column : embed_columns()) {
    const CLI::Option* const option = app.get_option_no_throw("--" + column.name);
    if (!option || option->count() == 0) continue;
    const bool is_flag = column.kind == orbitutte::ManifestColumn::Kind::flag;
    arguments.common.push_back(option->get_name() + (is_flag ? "" : "=" + option->results().back()));
  }
}

void add_batch(CLI::App& app, int& code) {
  Command<BatchArguments> command(
      app, "batch",
      "Embed many meshes, each in a process of its own; started again, it goes on "
      "where it was ended");
  command
      .option(
          "manifest", command->inputs,
          "A table (.csv) with a row for each job: mesh, orbifold, cones and further options of embed; or "
          "meshes, or patterns in quotes such as 'meshes/*.off'")
      ->required();
  command
      .option("-o,--output", command->output,
              "Write NAME.ply and NAME.json of each job, jobs.jsonl, summary.csv and summary.html into this "
              "folder, which is made if it is not there")
      ->required();
  command.option("--jobs", command->jobs, "Run so many at once, each with one thread; 0: one for every core")
      ->capture_default_str();
  command.option("--time-limit", command->time_limit, "End a job after so many seconds; 0: never")
      ->capture_default_str();
  command.option("--memory-limit", command->memory_limit,
                 "End a job that has more memory than this in use, such as 800M or 2G");
  command.option("--shard", command->shard,
                 "Run only the part I of N, such as 0/10 .. 9/10; parts may run on several machines at once");
  command.option("--job", command->job,
                 "Run this job alone, counted from 0, and print its record, which jobs.jsonl does not get");
  command.flag("--again", command->again,
               "Also run jobs again that a crash, a limit or trouble with a file has ended");
  command.flag("--summary", command->summary,
               "Run nothing; write summary.csv and summary.html of what is done");
  command.flag("--list", command->list,
               "Run nothing; print a line of JSON for each job, and whether it is done");
  command.flag("--quiet", command->quiet, "Print no progress and no summary");
  format_of(command);
  wishes_of(command);
  command.prepares(keep_wishes);
  command.runs(batch_command, code);
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

// What `export` writes: models, and the sphere alone.
std::vector<std::string> written_models() {
  std::vector<std::string> endings = orbitutte::model_endings();
  endings.insert(endings.end(), {".gii", ".sphere", ".reg"});
  return endings;
}

void add_export(CLI::App& app, int& code) {
  Command<ExportArguments> command(
      app, "export", "Write the mesh with its embedding as texture coordinates, for other programs");
  read_embedding_and_mesh_of(command);
  command
      .output("-o,--output", command->output, {"-o", "the model", "", written_models(), true},
              "Write the model here; .gii, .sphere and .reg are the sphere alone, as a surface")
      ->required();
  command.option(
      "--chart", command->chart,
      "How the sphere is laid into the texture: stereographic, equirectangular or octahedral; if it "
      "is not given, stereographic, but equirectangular for the whole sphere");
  command.option("--radius", command->radius, "Of the sphere that is written as a surface")
      ->capture_default_str();
  command.runs(export_command, code);
}

void add_measure(CLI::App& app, int& code) {
  Command<MeasureArguments> command(
      app, "measure",
      "Measure how an embedding deforms the surface, at every vertex, as programs for the cortex do");
  read_embedding_and_mesh_of(command);
  command.output("-o,--output", command->output,
                 {"-o", "the file of measures", "", {".gii", ".curv", ".csv", ".txt", ".npy"}, true},
                 "Write the measures here (into .curv one of them; .gii also as .shape.gii or .func.gii)");
  command
      .option("--measure", command->measure,
              "area (of the faces around a vertex), J (area ratio of triangles), R (their elongation), edge "
              "(lengths), or all; logarithms of base 2")
      ->capture_default_str();
  command.flag("--faces", command->faces, "Measure faces in place of vertices; for .csv, .txt and .npy");
  command.option(
      "--radius", command->radius,
      "Of the sphere to which the surface is compared, such as 100; if it is not given, the one with "
      "the area of the surface");
  command.flag("--quiet", command->quiet, "Print no table");
  command.flag("--json", command->json, "Print JSON");
  command.runs(measure_command, code);
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
  CLI::Option* const values = command.input(
      "--values", command->values, "the file of values",
      "Colour the surface by values at its vertices: .shape.gii, .func.gii, .label.gii, .annot, FreeSurfer's "
      ".curv, .thickness and the like, .csv, .txt or .npy");
  command.option("--map", command->map, "Which map of that file: its name, or its number from 0")
      ->capture_default_str()
      ->needs(values);
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
      .output("-o,--output", command->output, {"-o", "the mesh", "", orbitutte::mesh_endings(), true},
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

// What the command map makes besides the files of the map.
void products_of_map(Command<MapArguments>& command) {
  command.output("--picture", command->picture, {"--picture", "the picture", "", {".png"}},
                 "Draw a sheet here: B's colours and a checkerboard carried to A, and the distortion (.png)");
  view_of_mesh(command);
  command.output("--page", command->page, {"--page", "the page", "", {".html", ".htm"}},
                 "Write a page here that shows both surfaces, linked: point at one, see the other (.html)");
  command.output(
      "--morph", command->morph,
      {"--morph", "the morph", "", {".glb", ".obj", ".off", ".ply", ".stl", ".vtk"}},
      "Write A turning into B here: .glb with a morph target, or meshes, as many as --frames says");
  command.option("--frames", command->frames,
                 "Write the morph as so many meshes, NAME_00.ply, NAME_01.ply, ... for --morph NAME.ply");
  command.output(
      "--colours", command->colours, {"--colours", "the mesh with colours", "", {".ply", ".obj"}},
      "Write A in the colours of B's vertices here, or coloured by where they lie on B: .ply or .obj");
  command.input(
      "--texture", command->texture, "the texture of B",
      "Carry this picture, B's texture (PNG or JPEG; B is an OBJ with 'vt'), to A, into the folder: "
      "texture.png, textured_a.obj");
  command.option("--texture-size", command->texture_size,
                 "Pixels of the texture on A, such as 2048 or 2048x1024; that of B's if this is not given");
  command.flag("--new-chart", command->new_chart,
               "Make new texture coordinates for A, even if it has some of its own");
  command.input(
      "--values", command->values, "the values of B",
      "Carry numbers of B's vertices, a line each, to those of A, into the folder: values_on_a.txt");
  command.input("--labels", command->labels, "the labels of B",
                "Carry whole numbers, a line each, that of the nearest corner: labels_on_a.txt");
  command.input("--curves", command->curves, "the curves of B",
                "Carry curves, a line of vertices of B for each, where neighbours share a triangle: "
                "curves_on_a.obj");
}

// What would change the map says nothing where it is read.
void require_search_or_map(const CLI::App& command, MapArguments& arguments) {
  if (arguments.from.empty()) return;
  for (const char* const option : {"--landmarks", "--tile", "--tour", "--weights", "--clamp", "--cut-seed-a",
                                   "--cut-seed-b", "--tolerance", "--max-iterations"})
    if (command.count(option) > 0)
      throw orbitutte::ArgumentError(
          fmt::format("{} seeks a map and --from reads one; give one of them", option));
}

void add_map(CLI::App& app, int& code) {
  Command<MapArguments> command(
      app, "map", "Map one surface to another so that landmarks correspond, one to one, and certify it");
  command
      .input("a", command->a, "surface A", fmt::format("Surface A: {}; '-' is standard input", mesh_formats))
      ->required();
  command.input("b", command->b, "surface B", "Surface B, of the same topology")->required();
  command.option("--format", command->format, "As of embed, of the surface that comes from standard input");
  command.option(
      "--landmarks", command->landmarks,
      "Vertices that correspond, counted from 0: a file with two columns, of A and of B, or a list such as "
      "12:7,300:512,48:9; without it, a guess between two spheres");
  command.option("-o,--output", command->output,
                 "Write the files of the map into this folder, which is made if it is not there");
  command.option(
      "--from", command->from,
      "Read the map from this folder, where -o wrote it before, and seek none; what is carried goes "
      "there, too, unless -o names another folder");
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
  products_of_map(command);
  command.prepares(require_search_or_map);
  command.runs(map_command, code);
}

void add_resample(CLI::App& app, int& code) {
  Command<ResampleArguments> command(
      app, "resample", "Take values from a surface to a regular grid of the sphere or the plane, or back");
  read_embedding_and_mesh_of(command);
  command.input(
      "--values", command->values, "the file of values",
      "The values at the vertices, or, with --back, at the points of the grid: .npy, .npz, .txt, .csv, "
      "GIfTI or FreeSurfer's, with --back also .png; without it, only the table is written");
  command
      .option("--grid", command->grid,
              "The grid: ico:7 (an icosphere of level 7), healpix:64, healpix-nested:64, "
              "equirectangular:512x256, octahedral:256, cube:128; a sphere's file, for its vertices; of "
              "orbifolds of the plane periodic:256 (the torus that covers it) or tile:256")
      ->required();
  command.option(
      "--kind", command->kind,
      "linear; nearest; conservative, which keeps the integral over the surface; or least-squares, "
      "values of which --back makes those of the surface again as nearly as can be; if it is not "
      "given, conservative for labels of a table (.label.gii, .annot), nearest for other whole numbers, "
      "linear for the rest");
  command.flag("--back", command->back, "From the grid to the vertices");
  command
      .option("--pad", command->pad, "Give images a margin of so many pixels, whose values the symmetry has")
      ->capture_default_str();
  command
      .output(
          "-o,--output", command->output,
          {"-o",
           "the file of values",
           "",
           {".npy", ".npz", ".txt", ".csv", ".gii", ".png", ".curv", ".annot"},
           true},
          "Write the values here: .npy, .npz (with the table of weights), .txt, .csv, .shape.gii, .func.gii, "
          ".label.gii or, of images, .png")
      ->required();
  command.runs(resample_command, code);
}

void add_sample(CLI::App& app, int& code) {
  Command<SampleArguments> command(app, "sample", "Make a mesh to try things on");
  command
      .output("-o,--output", command->output, {"-o", "the mesh", "", orbitutte::mesh_endings(), true},
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

std::vector<orbitutte::ManifestColumn> embed_columns() {
  using Kind = orbitutte::ManifestColumn::Kind;
  constexpr std::string_view not_of_jobs[] = {"help",  "output", "report", "threads",
                                              "quiet", "json",   "format"};
  constexpr std::string_view files[] = {"points", "polygon", "weights-file"};
  const auto is_in = [](const auto& names, const std::string& name) {
    return std::find(std::begin(names), std::end(names), name) != std::end(names);
  };
  CLI::App app;
  const Command<EmbedArguments> command = embed_definition(app);
  std::vector<orbitutte::ManifestColumn> columns;
  for (const CLI::Option* option : command.options()) {
    if (option->get_lnames().empty()) continue;
    const std::string name = option->get_lnames().front();
    const Kind kind = is_in(files, name)             ? Kind::file
                      : option->get_type_size() == 0 ? Kind::flag
                                                     : Kind::value;
    if (!is_in(not_of_jobs, name)) columns.push_back({name, kind});
  }
  return columns;
}

EmbedArguments parse_embed(const std::string& mesh, const std::vector<std::string>& options) {
  CLI::App app;
  const Command<EmbedArguments> command = embed_definition(app);
  std::vector<std::string> words(options.rbegin(), options.rend());  // CLI11 takes the last one first
  words.insert(words.end(), {mesh, "embed"});
  try {
    app.parse(words);
  } catch (const CLI::ParseError& error) {
    throw orbitutte::ArgumentError(error.what());
  }
  return *command.operator->();
}

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
  add_measure(app, code);
  add_render(app, code);
  add_report(app, code);
  add_compare(app, code);
  add_repair(app, code);
  add_map(app, code);
  add_resample(app, code);
  add_batch(app, code);
  add_sample(app, code);
}

int run_command_line(int argc, char** argv) {
  CLI::App app("orbitutte: spherical orbifold Tutte embeddings", "orbitutte");
  int code = succeeded;
  add_commands(app, code);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return run_guarded([&] { return answer(app, error); });
  }
  return code;
}

}  // namespace orbitutte::cli
