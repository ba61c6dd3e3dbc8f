// SPDX-License-Identifier: MIT
// Values from a surface to a grid, and back.
#include <fmt/format.h>

#include <cmath>
#include <filesystem>
#include <functional>
#include <numeric>

#include "command_arguments.h"
#include "command_files.h"
#include "commands.h"
#include "grid_values.h"
#include "orbitutte/inspect/recognition.h"
#include "orbitutte/io/file.h"
#include "orbitutte/io/mesh_io.h"
#include "orbitutte/io/png.h"
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

enum class Direction { to_grid, to_surface };

// The table in the direction that is asked for.
struct Table {
  Direction direction;

  /// None of least squares to the grid, for which there are the linear ones, both ways.
  SparseTable weights = {}, linear = {}, linear_back = {};

  /// Of conservative ones: the areas of the surface that vertices and cells of the grid have.
  Eigen::VectorXd vertex_areas = {}, cell_areas = {};

  bool is_back() const { return direction == Direction::to_surface; }
  TableAreas areas() const {
    return is_back() ? TableAreas{vertex_areas, cell_areas} : TableAreas{cell_areas, vertex_areas};
  }
};

Table make_table(const Surface& surface, const Embedding& embedding, const Grid& grid, ResampleKind kind,
                 Direction direction) {
  Table table = {direction};
  if (kind == ResampleKind::conservative) {
    table.vertex_areas = surface.vertex_areas();
    ConservativeTables tables = conservative_tables(embedding, grid, table.vertex_areas);
    table.weights = table.is_back() ? std::move(tables.to_surface) : std::move(tables.to_grid);
    table.cell_areas = std::move(tables.cell_areas);
  } else if (table.is_back()) {
    table.weights = table_to_surface(embedding, grid, kind);
  } else if (kind == ResampleKind::least_squares) {
    table.linear = table_to_grid(embedding, grid, ResampleKind::linear);
    table.linear_back = table_to_surface(embedding, grid, ResampleKind::linear);
  } else {
    table.weights = table_to_grid(embedding, grid, kind);
  }
  return table;
}

// Values in the direction of the table.
Eigen::MatrixXd resampled(const Table& table, const GridValues& values) {
  if (values.is_label && table.cell_areas.size() > 0)
    return labels_keeping_areas(table.weights, values.values, table.areas());
  if (values.is_label) return apply_to_labels(table.weights, values.values);
  if (table.linear.rows() > 0) return least_squares_values(table.linear_back, table.linear, values.values);
  return apply(table.weights, values.values);
}

// What is not given follows from the values: labels of a table keep their areas; whole numbers may be
// anything.
ResampleKind kind_of(const ResampleArguments& arguments, const GridValues* values) {
  if (!arguments.kind.empty()) return parse_choice<ResampleKind>(arguments.kind, "--kind");
  if (!values || !values->is_label) return ResampleKind::linear;
  return values->labels.empty() ? ResampleKind::nearest : ResampleKind::conservative;
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

// A picture of the grid, with its margin, that may be read again.
void require_picture_size(const Grid& grid, int margin) {
  const std::vector<int> shape = padded_shape(grid, margin);
  const int width = shape.back();
  const long long height = std::accumulate(shape.begin(), shape.end() - 1, 1LL, std::multiplies<>());
  if (width > longest_picture_side || height > longest_picture_side)
    throw ArgumentError(
        fmt::format("a PNG has at most {0} x {0} pixels, and this one would have {1} x {2}; write .npy",
                    longest_picture_side, width, height));
}

// Least squares are of numbers alone.
void require_values(const ResampleArguments& arguments, ResampleKind kind, const GridValues& values) {
  if (kind != ResampleKind::least_squares || arguments.back) return;
  if (arguments.values.empty())
    throw ArgumentError("least-squares has no table that could be written: give --values, or take linear");
  if (!values.labels.empty())
    throw ArgumentError("--values has labels, which least-squares cannot add; take nearest");
}

void require_output(const ResampleArguments& arguments, const Grid& grid) {
  const bool is_archive = ending_of(arguments.output) == ".npz";
  const std::string inner = ending_of(without_gz(arguments.output));
  if (is_compressed(arguments.output) && (inner == ".npz" || inner == ".png"))
    throw ArgumentError(fmt::format("-o is '{}', but such files are compressed by themselves; leave out .gz",
                                    arguments.output));
  if (arguments.values.empty() && !is_archive)
    throw ArgumentError("without --values there is only the table to write: give -o the ending .npz");
  if (arguments.pad > 0 && arguments.back)
    throw ArgumentError("--pad is of images, and --back makes values of vertices; leave out one of both");
  if (ending_of(arguments.output) == ".png" && !grid.is_image())
    throw ArgumentError(
        fmt::format("-o is '{}', but the points of this grid are no image; write .npy", arguments.output));
  if (ending_of(arguments.output) == ".png") require_picture_size(grid, arguments.pad);
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
  require_values(arguments, kind, values);
  const Table table =
      make_table(surface, embedding, grid, kind, arguments.back ? Direction::to_surface : Direction::to_grid);
  const double table_seconds = making_table.seconds();
  const int rows = arguments.back ? surface.vertex_count() : grid.count();
  if (const int missing = empty_rows(table.weights) + empty_rows(table.linear); missing > 0)
    tell("orbitutte: warning: {} of {} {} get no value (NaN): no triangle lies there\n", missing, rows,
         arguments.back ? "vertices" : "points of the grid");

  const Stopwatch applying;
  GridValues result = values;
  result.is_label = !arguments.values.empty() && are_labels(arguments, values);
  if (!arguments.values.empty()) result.values = resampled(table, result);
  const double apply_seconds = applying.seconds();
  const ResampledOutput output = {grid, table.weights, table.cell_areas, result, arguments.pad};
  if (arguments.back) {
    write_surface_values(arguments.output, output);
  } else {
    write_grid_values(arguments.output, output);
  }
  tell("{}: {} {}, {}; grid {:.2f} s, table {:.2f} s, values {:.3f} s\n", arguments.output, rows,
       arguments.back ? "vertices" : "points", name_of(kind), grid_seconds, table_seconds, apply_seconds);
  if (kind == ResampleKind::conservative && !result.is_label && result.values.size() > 0) {
    tell_integrals(table.areas().columns, values.values, table.areas().rows, result.values);
  }
  return succeeded;
}

}  // namespace orbitutte::cli
