// SPDX-License-Identifier: MIT
// Values from a surface to a grid, and back.
#include <fmt/format.h>

#include <cmath>
#include <filesystem>

#include "command_arguments.h"
#include "command_files.h"
#include "commands.h"
#include "grid_values.h"
#include "orbitutte/inspect/recognition.h"
#include "orbitutte/io/file.h"
#include "orbitutte/io/mesh_io.h"
#include "orbitutte/report/embedding_file.h"
#include "orbitutte/report/report.h"
#include "orbitutte/resample/resample.h"
#include "run.h"
#include "standard_streams.h"

namespace orbitutte::cli {
namespace {

// "ico:7", and not the name of a file.
bool is_grid_name(const std::string& text) {
  const std::string kind = text.substr(0, text.find(':'));
  if (find_by_name<GridKind>(kind) && kind.size() < text.size()) return true;
  std::error_code error;
  return !std::filesystem::exists(text, error) && std::filesystem::path(text).extension().empty();
}

Grid grid_from(const std::string& text, const Embedding& embedding) {
  if (is_grid_name(text)) return make_grid(parse_grid(text), embedding);
  const Surface sphere = make_surface(read_mesh(text));
  if (embedding.space() != Space::sphere())
    throw ArgumentError(fmt::format("the grid '{}' is a sphere, but the map is onto {}, which is {}", text,
                                    embedding.target.signature, embedding.space().name()));
  return naming_file(text, [&] { return sphere_grid(sphere.V, sphere.triangles); });
}

// The table in the direction that is asked for.
struct Table {
  SparseTable weights;

  /// Of conservative ones: the areas of the surface that the grid's cells have.
  Eigen::VectorXd cell_areas;
};

enum class Direction { to_grid, to_surface };

Table make_table(const Surface& surface, const Embedding& embedding, const Grid& grid, ResampleKind kind,
                 Direction direction) {
  const bool back = direction == Direction::to_surface;
  if (kind != ResampleKind::conservative)
    return {back ? table_to_surface(embedding, grid, kind) : table_to_grid(embedding, grid, kind), {}};
  ConservativeTables tables = conservative_tables(embedding, grid, surface.vertex_areas());
  return {back ? std::move(tables.to_surface) : std::move(tables.to_grid), std::move(tables.cell_areas)};
}

// What is not given follows from the values.
ResampleKind kind_of(const ResampleArguments& arguments, const GridValues* values) {
  if (!arguments.kind.empty()) return parse_choice<ResampleKind>(arguments.kind, "--kind");
  return values && values->is_label ? ResampleKind::nearest : ResampleKind::linear;
}

int empty_rows(const SparseTable& table) {
  int count = 0;
  for (int r = 0; r < table.rows(); ++r) count += table.start[r] == table.start[r + 1];
  return count;
}

void tell_integrals(const Eigen::VectorXd& from_areas, const Eigen::MatrixXd& from,
                    const Eigen::VectorXd& to_areas, const Eigen::MatrixXd& to) {
  for (Eigen::Index map = 0; map < from.cols(); ++map)
    tell("map {}: the integral is {:.12g} before and {:.12g} after\n", map, from_areas.dot(from.col(map)),
         to_areas.dot(to.col(map)));
}

void require_output(const ResampleArguments& arguments, const Grid& grid) {
  const bool is_archive = ending_of(arguments.output) == ".npz";
  if (arguments.values.empty() && !is_archive)
    throw ArgumentError("without --values there is only the table to write: give -o the ending .npz");
  if (arguments.pad > 0 && arguments.back)
    throw ArgumentError("--pad is of images, and --back makes values of vertices; leave out one of both");
  if (ending_of(arguments.output) == ".png" && !grid.is_image())
    throw ArgumentError(
        fmt::format("-o is '{}', but the points of this grid are no image; write .npy", arguments.output));
  if (arguments.pad > 0) padded_shape(grid, arguments.pad);
}

// Labels stay labels where they are not asked to be numbers.
bool are_labels(const ResampleArguments& arguments, const GridValues& values) {
  return values.is_label && (!values.labels.empty() || arguments.kind.empty() || arguments.kind == "nearest");
}

}  // namespace

int resample_command(const ResampleArguments& arguments) {
  if (!is_grid_name(arguments.grid) && is_same_file(arguments.grid, arguments.output))
    throw ArgumentError(fmt::format(
        "-o is '{}', which is the sphere that the command reads; name another file", arguments.output));
  const Report report = read_report(arguments.report);
  Embedding embedding = read_embedding(arguments.embedding, report);
  warn(warnings_of_offsets(embedding));
  const Surface surface = read_source(mesh_input(arguments.mesh, arguments.format), report, embedding);
  const Stopwatch making_grid;
  const Grid grid = grid_from(arguments.grid, embedding);
  const double grid_seconds = making_grid.seconds();
  require_output(arguments, grid);
  GridValues values;
  if (!arguments.values.empty())
    values = arguments.back ? read_grid_values(arguments.values, grid)
                            : read_surface_values(arguments.values, surface.vertex_count());

  if (const auto missing = values.values.array().isNaN().count(); missing > 0)
    tell("orbitutte: warning: {} of {} values are NaN, and so is what they have a part in\n", missing,
         values.values.size());

  const Stopwatch making_table;
  const ResampleKind kind = kind_of(arguments, arguments.values.empty() ? nullptr : &values);
  const Table table =
      make_table(surface, embedding, grid, kind, arguments.back ? Direction::to_surface : Direction::to_grid);
  const double table_seconds = making_table.seconds();
  if (const int missing = empty_rows(table.weights); missing > 0)
    tell("orbitutte: warning: {} of {} {} get no value (NaN): no triangle lies there\n", missing,
         table.weights.rows(), arguments.back ? "vertices" : "points of the grid");

  const Stopwatch applying;
  GridValues result = values;
  result.is_label = !arguments.values.empty() && are_labels(arguments, values);
  if (!arguments.values.empty())
    result.values =
        result.is_label ? apply_to_labels(table.weights, values.values) : apply(table.weights, values.values);
  const double apply_seconds = applying.seconds();
  const ResampledOutput output = {grid, table.weights, table.cell_areas, result, arguments.pad};
  if (arguments.back) {
    write_surface_values(arguments.output, output);
  } else {
    write_grid_values(arguments.output, output);
  }
  tell("{}: {} {}, {}; grid {:.2f} s, table {:.2f} s, values {:.3f} s\n", arguments.output,
       table.weights.rows(), arguments.back ? "vertices" : "points", name_of(kind), grid_seconds,
       table_seconds, apply_seconds);
  if (kind == ResampleKind::conservative && !result.is_label && result.values.size() > 0) {
    const Eigen::VectorXd areas = surface.vertex_areas();
    tell_integrals(arguments.back ? table.cell_areas : areas, values.values,
                   arguments.back ? areas : table.cell_areas, result.values);
  }
  return succeeded;
}

}  // namespace orbitutte::cli
