// SPDX-License-Identifier: MIT
// The file to which a batch appends a record for each job as it ends.
#pragma once

#include <chrono>
#include <string>
#include <vector>

#include "orbitutte/report/batch_record.h"

namespace orbitutte::cli {

/// The file, open and locked.
class JobLog {
 public:
  /// Makes the file if it is not there, and cuts off the part of a line that a killed process left at its
  /// end. Throws FileError if the file cannot be written, or another process has it open as a JobLog.
  explicit JobLog(const std::string& path);
  JobLog(const JobLog&) = delete;
  JobLog& operator=(const JobLog&) = delete;
  ~JobLog();

  /// Adds a line in one piece. It outlives this process at once, and a power cut if the file was brought to
  /// the disk, which this does ten times a second at most: to wait for the disk takes as long as a small job.
  /// Throws FileError.
  void append(const JobRecord& record);

  /// Brings the file to the disk. Throws FileError.
  void sync();

 private:
  std::string path_;
  int descriptor_;
  std::chrono::steady_clock::time_point synced_ = {};
};

/// Is a process at work on this file?
bool is_locked(const std::string& path);

/// The names of the logs in a folder, sorted: jobs.jsonl, and jobs-I-of-N.jsonl of parts.
std::vector<std::string> logs_in(const std::string& folder);

/// Removes what processes that were killed have left half-written in a folder.
void remove_leftovers(const std::string& folder);

}  // namespace orbitutte::cli
