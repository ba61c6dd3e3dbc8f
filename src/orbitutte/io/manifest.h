// SPDX-License-Identifier: MIT
// The list of jobs of a batch: a table with a row for each mesh that is to be embedded (docs/batches.md).
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace orbitutte {

/// An embedding that a batch makes.
struct BatchJob {
  /// Of its files, without ending; no other job has it.
  std::string name;
  std::string mesh;

  /// As on the command line of `embed`: "--orbifold=432", "--quotient".
  std::vector<std::string> options;

  /// Of the manifest, counted from 1; 0 if there is none.
  int line = 0;
};

/// An option of `embed` that may be a column.
struct ManifestColumn {
  enum class Kind { value, flag, file };

  /// Without dashes.
  std::string name;
  Kind kind = Kind::value;
};

/// The jobs of a table whose first row names the columns: `mesh`, which it must have, `name`, and options of
/// `embed`. An option whose cell is empty is not given; cells of flags are yes or no. Where `name` is not
/// given, name_jobs finds one. Throws ArgumentError naming the line, the job, counted from 0, and the column.
std::vector<BatchJob> parse_manifest(std::string_view text, const std::vector<ManifestColumn>& columns);

/// The job with its paths, those of the mesh and of options that are files, relative to a folder.
BatchJob in_folder(BatchJob job, const std::vector<ManifestColumn>& columns, const std::string& folder);

/// A job without options for each mesh.
std::vector<BatchJob> jobs_of_meshes(const std::vector<std::string>& meshes);

/// Names the jobs that have no name after their mesh files, without folder and ending. If that name is taken
/// already, the job gets the first of NAME-2, NAME-3 ... that is not; so a further row at the end of a
/// manifest changes no name before it, unless it gives that very name. Throws ArgumentError naming both lines
/// if two jobs were given the same name.
void name_jobs(std::vector<BatchJob>& jobs);

/// "line 4 (job 2)": where the job stands.
std::string place_of(const BatchJob& job, std::size_t number);

}  // namespace orbitutte
