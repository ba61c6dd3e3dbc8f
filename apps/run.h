// SPDX-License-Identifier: MIT
// What long commands share: reading what they record, clocks, and a line of progress.
#pragma once

#include <chrono>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "commands.h"
#include "orbitutte/io/mesh_io.h"
#include "orbitutte/mesh/surface.h"
#include "orbitutte/progress.h"
#include "orbitutte/report/report.h"

namespace orbitutte::cli {

/// What the program says if memory ran out.
inline constexpr const char* memory_ran_out = "memory ran out";

/// Says a sentence on standard error, and returns the code.
int complain(const std::string& message, ExitCode code);

/// Runs a function that prints and returns an exit code. Every kind of failure has its exit code and one
/// sentence on standard error.
int run_guarded(const std::function<int()>& command);

class Stopwatch {
 public:
  double seconds() const {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
  }

 private:
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

long long peak_memory_bytes();

/// One line that is written again and again, on a terminal only.
class ProgressLine {
 public:
  explicit ProgressLine(bool quiet);
  ~ProgressLine() { clear(); }
  ProgressLine(const ProgressLine&) = delete;
  ProgressLine& operator=(const ProgressLine&) = delete;

  void show(const Progress& progress) const;
  void clear() const;

 private:
  bool shown_;
};

/// Of a repair that left less than half of the faces. Throws MeshError if it left none.
std::optional<std::string> warning_of_lost_faces(const std::string& path, int before, int left);

struct Input {
  std::shared_ptr<const Surface> surface;
  /// Of the reader.
  std::vector<std::string> warnings;

  /// If the mesh was repaired: what became of each vertex (RepairInPlace).
  std::optional<std::vector<int>> image = {};
};

/// Reads the mesh, and records what the report says about its file. Messages begin with the path.
Input read_input(const MeshInput& input, RunRecord& run);

/// The same, and repairs the mesh.
Input read_and_repair(const MeshInput& input, RunRecord& run);

/// Tells what each step of a repair did, or that there was nothing to do.
void tell_steps(const std::vector<RepairRecord>& records);

}  // namespace orbitutte::cli
