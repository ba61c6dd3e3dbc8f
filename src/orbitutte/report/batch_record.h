// SPDX-License-Identifier: MIT
// What became of the jobs of a batch: a line of JSON each, and a table of all (docs/batches.md).
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "orbitutte/names.h"

namespace orbitutte {

enum class JobOutcome {
  certified,
  /// Written, as the next one, without a certificate.
  not_converged,
  not_certified,
  unsuitable_mesh,
  wrong_usage,
  file_trouble,
  out_of_memory,
  out_of_time,
  /// A signal ended the process.
  crashed
};

template <>
struct NameTable<JobOutcome> {
  static constexpr NamedValue<JobOutcome> rows[] = {{JobOutcome::certified, "certified"},
                                                    {JobOutcome::not_converged, "not_converged"},
                                                    {JobOutcome::not_certified, "not_certified"},
                                                    {JobOutcome::unsuitable_mesh, "unsuitable_mesh"},
                                                    {JobOutcome::wrong_usage, "wrong_usage"},
                                                    {JobOutcome::file_trouble, "file_trouble"},
                                                    {JobOutcome::out_of_memory, "out_of_memory"},
                                                    {JobOutcome::out_of_time, "out_of_time"},
                                                    {JobOutcome::crashed, "crashed"}};
};

/// May it end otherwise if it is run again? So it is unless the mesh and the options alone decide.
bool is_worth_another_try(JobOutcome outcome);

/// Were the embedding and its report written?
bool is_embedded(JobOutcome outcome);

/// What a job's report says, as far as tables show it.
struct JobNumbers {
  std::string orbifold;
  std::vector<int> cones;
  int vertices = 0, faces = 0;
  double sigma = 0, within_4 = 0, below_64 = 0;
};

struct JobRecord {
  /// Its place in the manifest, counted from 0.
  std::size_t job = 0;
  std::string name, mesh;

  /// As on the command line of `embed`.
  std::vector<std::string> options;
  JobOutcome outcome = JobOutcome::certified;

  /// Of its last process: the exit code, or the signal that ended it.
  std::optional<int> exit_code, signal;
  int attempts = 1;

  /// Of its last process, by the clock on the wall.
  double seconds = 0;
  long long peak_memory_bytes = 0;

  /// The first sentence on what went wrong.
  std::string message;
  std::vector<std::string> warnings;

  /// If it was embedded.
  std::optional<JobNumbers> numbers;
};

/// The numbers of a report. Throws MeshError if a key is missing.
JobNumbers numbers_of_report(std::string_view report);

/// One line of JSON with its line break.
std::string record_line(const JobRecord& record);

/// The records of lines, in their order. A last line without a line break is what a process that was killed
/// left behind, and is ignored. Throws MeshError naming the line that is no record.
std::vector<JobRecord> parse_records(std::string_view lines);

/// A row for each job, as CSV.
std::string summary_csv(const std::vector<JobRecord>& records);

}  // namespace orbitutte
