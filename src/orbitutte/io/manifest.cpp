// SPDX-License-Identifier: MIT
#include "orbitutte/io/manifest.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <optional>

#include "orbitutte/errors.h"
#include "orbitutte/io/csv.h"
#include "orbitutte/io/file.h"
#include "orbitutte/io/mesh_io.h"

namespace orbitutte {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view mesh_column = "mesh", name_column = "name";
constexpr std::size_t longest_name = 200;  // a file's name has up to 255 bytes, with the ending

using ColumnKind = ManifestColumn::Kind;

// The names of all columns, for messages.
std::string known_columns(const std::vector<ManifestColumn>& options) {
  std::vector<std::string> names = {std::string(mesh_column), std::string(name_column)};
  names.reserve(names.size() + options.size());
  for (const ManifestColumn& option : options) names.push_back(option.name);
  return fmt::format("{}", fmt::join(names, ", "));
}

// The columns in the order of the table. Those of mesh and name are values.
std::vector<ManifestColumn> columns_of(const CsvRow& header, const std::vector<ManifestColumn>& options) {
  std::vector<ManifestColumn> columns;
  columns.reserve(header.cells.size());
  for (const std::string& cell : header.cells) {
    const std::string name = cell.starts_with("--") ? cell.substr(2) : cell;
    const auto has_name = [&](const ManifestColumn& column) { return column.name == name; };
    if (std::any_of(columns.begin(), columns.end(), has_name))
      throw ArgumentError(fmt::format("line {}: two columns are named '{}'", header.line, name));
    const auto known = std::find_if(options.begin(), options.end(), has_name);
    if (known != options.end()) {
      columns.push_back(*known);
    } else if (name == mesh_column || name == name_column) {
      columns.push_back({name, name == mesh_column ? ColumnKind::file : ColumnKind::value});
    } else {
      throw ArgumentError(fmt::format("line {}: '{}' is no column of a manifest; its columns are {}",
                                      header.line, name, known_columns(options)));
    }
  }
  const auto is_mesh = [](const ManifestColumn& column) { return column.name == mesh_column; };
  if (!std::any_of(columns.begin(), columns.end(), is_mesh))
    throw ArgumentError(
        fmt::format("line {}: no column is named 'mesh'; the first row of a manifest names its "
                    "columns, as in mesh,orbifold,cones",
                    header.line));
  return columns;
}

std::string path_in(const std::string& folder, const std::string& path) {
  return folder.empty() || fs::path(path).is_absolute() ? path : (fs::path(folder) / path).string();
}

std::optional<bool> parse_flag(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(), [](unsigned char c) { return std::tolower(c); });
  if (text == "yes" || text == "true" || text == "1") return true;
  if (text == "no" || text == "false" || text == "0") return false;
  return std::nullopt;
}

void require_name_of_file(const std::string& name) {
  const auto is_odd = [](unsigned char c) { return c < 0x20 || c == '/' || c == 0x7f; };
  if (name.front() == '.' || name.front() == '-' || std::any_of(name.begin(), name.end(), is_odd))
    throw ArgumentError(
        fmt::format("'{}' cannot name files; leave out '/', and do not begin with '.' or '-'", name));
  if (name.size() > longest_name)
    throw ArgumentError(
        fmt::format("a name may have up to {} bytes, and this one has {}", longest_name, name.size()));
}

void read_cell(BatchJob& job, const ManifestColumn& column, const std::string& cell) {
  if (cell.empty()) return;
  if (column.kind == ColumnKind::flag) {
    const std::optional<bool> is_set = parse_flag(cell);
    if (!is_set) throw ArgumentError(fmt::format("'{}' is neither yes nor no", cell));
    if (*is_set) job.options.push_back("--" + column.name);
    return;
  }
  if (column.name == mesh_column) {
    job.mesh = cell;
  } else if (column.name == name_column) {
    require_name_of_file(cell);
    job.name = cell;
  } else {
    job.options.push_back(fmt::format("--{}={}", column.name, cell));
  }
}

BatchJob job_of(const CsvRow& row, const std::vector<ManifestColumn>& columns) {
  BatchJob job;
  job.line = row.line;
  for (std::size_t k = 0; k < columns.size(); ++k) try {
      read_cell(job, columns[k], row.cells[k]);
    } catch (const ArgumentError& error) {
      throw ArgumentError(fmt::format("column '{}': {}", columns[k].name, error.what()));
    }
  if (job.mesh.empty()) throw ArgumentError("column 'mesh': the cell is empty; give the path of the mesh");
  return job;
}

void require_cells(const CsvRow& row, std::size_t columns) {
  if (row.cells.size() > columns)
    throw ArgumentError(
        fmt::format("there are {} cells, and the table has {} columns; put cells with commas into quotes, as "
                    "in \"12,40,7\"",
                    row.cells.size(), columns));
  if (row.cells.size() < columns)
    throw ArgumentError(
        fmt::format("there are {} cells, and the table has {} columns", row.cells.size(), columns));
}

// The file's name without folder, `.gz` and ending.
std::string stem_of(const std::string& mesh) {
  const fs::path path = is_compressed(mesh) ? fs::path(mesh).stem() : fs::path(mesh).filename();
  std::string stem = path.stem().string();
  while (!stem.empty() && (stem.front() == '.' || stem.front() == '-')) stem.erase(0, 1);
  return stem.empty() ? "mesh" : stem.substr(0, longest_name);
}

}  // namespace

std::string place_of(const BatchJob& job, std::size_t number) {
  return job.line > 0 ? fmt::format("line {} (job {})", job.line, number) : fmt::format("job {}", number);
}

std::vector<BatchJob> parse_manifest(std::string_view text, const std::vector<ManifestColumn>& columns) {
  if (text.find('\0') != std::string_view::npos)
    throw ArgumentError("this is no text, or one with two bytes a character; save it as UTF-8");
  const std::vector<CsvRow> rows = read_csv(text);
  if (rows.empty())
    throw ArgumentError("the manifest is empty; its first row names its columns, as in mesh,orbifold,cones");
  const std::vector<ManifestColumn> order = columns_of(rows.front(), columns);
  std::vector<BatchJob> jobs;
  jobs.reserve(rows.size() - 1);
  for (std::size_t r = 1; r < rows.size(); ++r) try {
      require_cells(rows[r], order.size());
      jobs.push_back(job_of(rows[r], order));
    } catch (const ArgumentError& error) {
      throw ArgumentError(fmt::format("line {} (job {}), {}", rows[r].line, r - 1, error.what()));
    }
  if (jobs.empty())
    throw ArgumentError("the manifest has no jobs; give each a row below the names of the columns");
  name_jobs(jobs);
  return jobs;
}

BatchJob in_folder(BatchJob job, const std::vector<ManifestColumn>& columns, const std::string& folder) {
  job.mesh = path_in(folder, job.mesh);
  for (const ManifestColumn& column : columns) {
    if (column.kind != ColumnKind::file) continue;
    const std::string option = fmt::format("--{}=", column.name);
    for (std::string& given : job.options)
      if (given.starts_with(option))
        given.replace(option.size(), given.npos, path_in(folder, given.substr(option.size())));
  }
  return job;
}

std::vector<BatchJob> jobs_of_meshes(const std::vector<std::string>& meshes) {
  std::vector<BatchJob> jobs;
  jobs.reserve(meshes.size());
  for (const std::string& mesh : meshes) jobs.push_back({"", mesh, {}, 0});
  name_jobs(jobs);
  return jobs;
}

void name_jobs(std::vector<BatchJob>& jobs) {
  std::map<std::string, std::size_t> owner;
  for (std::size_t k = 0; k < jobs.size(); ++k) {
    if (jobs[k].name.empty()) continue;
    const auto [taken, is_new] = owner.try_emplace(jobs[k].name, k);
    if (!is_new)
      throw ArgumentError(
          fmt::format("{}, column 'name': {} has the name '{}' already; give each job one of its own",
                      place_of(jobs[k], k), place_of(jobs[taken->second], taken->second), jobs[k].name));
  }
  std::map<std::string, int> next_number;
  for (std::size_t k = 0; k < jobs.size(); ++k) {
    if (!jobs[k].name.empty()) continue;
    const std::string stem = stem_of(jobs[k].mesh);
    int& number = next_number.try_emplace(stem, 1).first->second;
    do {
      jobs[k].name = number == 1 ? stem : fmt::format("{}-{}", stem, number);
      ++number;
    } while (!owner.try_emplace(jobs[k].name, k).second);
  }
}

}  // namespace orbitutte
