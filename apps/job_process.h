// SPDX-License-Identifier: MIT
// Work in processes of its own, so that a crash or a limit ends nothing else.
#pragma once

#include <chrono>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace orbitutte::cli {

/// Of one process; nothing is unlimited.
struct JobLimits {
  /// By the clock on the wall.
  std::optional<double> seconds;

  /// Of memory that is in use at once.
  std::optional<double> bytes;
};

/// How a process ended.
struct ProcessEnd {
  /// One of both.
  std::optional<int> exit_code, signal;
  bool is_out_of_time = false, is_out_of_memory = false;
  double seconds = 0;
  long long peak_memory_bytes = 0;

  /// What it wrote to standard error; of a long text, the beginning.
  std::string messages;
};

/// A copy of this process that does one thing.
class JobProcess {
 public:
  /// Forks. The new process gets the limits, reads nothing, prints nothing, ends with what `work` returns,
  /// and does not outlive this one (Linux). This process must not have started threads that `work` needs.
  /// Throws FileError if the system allows no further process.
  JobProcess(const std::function<int()>& work, const JobLimits& limits);
  JobProcess(const JobProcess&) = delete;
  JobProcess& operator=(const JobProcess&) = delete;
  JobProcess(JobProcess&& other) noexcept;
  JobProcess& operator=(JobProcess&& other) noexcept;
  /// Ends the process if it still runs.
  ~JobProcess();

  /// Can be read, or is at its end, if something has happened.
  int descriptor() const { return descriptor_; }

  /// How many seconds may pass before enforce_limits is due; nothing if it never is.
  std::optional<double> seconds_to_check() const;

  /// Ends the process if its time is up, or if it has more memory than it may have.
  void enforce_limits();

  /// Reads what is there to be read. How the process ended, if it has.
  std::optional<ProcessEnd> advance();

 private:
  int process_ = -1, descriptor_ = -1;
  std::chrono::steady_clock::time_point start_;
  JobLimits limits_;
  ProcessEnd end_;
};

/// Waits until one of the processes has written something, has ended or is out of time, which ends it.
void wait_for_any(const std::vector<JobProcess*>& processes);

}  // namespace orbitutte::cli
