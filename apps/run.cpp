// SPDX-License-Identifier: MIT
#include "run.h"

#include <fmt/format.h>
#include <sys/resource.h>
#include <unistd.h>

#include <exception>
#include <new>
#include <system_error>
#include <utility>

#include "orbitutte/errors.h"
#include "orbitutte/inspect/recognition.h"
#include "orbitutte/io/file.h"
#include "orbitutte/io/mesh_io.h"
#include "standard_streams.h"

namespace orbitutte::cli {

int complain(const std::string& message, ExitCode code) {
  tell("orbitutte: {}\n", message);
  return code;
}

int run_guarded(const std::function<int()>& command) {
  try {
    const int code = command();
    flush_standard_output();
    return code;
  } catch (const FileError& error) {
    return complain(error.what(), file_trouble);
  } catch (const std::bad_alloc&) {
    return complain(memory_ran_out, file_trouble);
  } catch (const ArgumentError& error) {
    return complain(error.what(), wrong_usage);
  } catch (const Error& error) {
    return complain(error.what(), unsuitable_mesh);
  } catch (const std::system_error& error) {  // fmt::print throws it
    const char* const place = std::ferror(stdout) ? "standard output cannot be written: " : "";
    return complain(place + error.code().message(), file_trouble);
  } catch (const std::exception& error) {
    return complain(error.what(), file_trouble);
  }
}

long long peak_memory_bytes() {
  rusage usage = {};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<long long>(usage.ru_maxrss) * 1024;
}

ProgressLine::ProgressLine(bool quiet) : shown_(!quiet && isatty(STDERR_FILENO)) {}

void ProgressLine::show(const Progress& progress) const {
  if (!shown_) return;
  if (progress.stage == "optimize" && progress.energy > 0) {
    tell("\r\033[Koptimize: iteration {}, energy {:.9g}, gradient {:.1e}", progress.iteration,
         progress.energy, progress.gradient_norm);
  } else {
    tell("\r\033[K{} ...", progress.stage);
  }
}

void ProgressLine::clear() const {
  if (shown_) tell("\r\033[K");
}

Input read_input(const std::string& path, RunRecord& run) {
  const Stopwatch reading;
  mesh_format(path);  // refuses what has no known ending before it is read
  const std::string bytes = read_file(path);
  run.mesh_path = path;
  run.input_sha256 = sha256(bytes);
  PolygonMesh mesh = parse_mesh_file(path, bytes);
  std::vector<std::string> warnings = std::move(mesh.warnings);
  run.read_seconds = reading.seconds();
  const Stopwatch judging;
  try {
    Surface surface = make_surface(std::move(mesh));
    run.validate_seconds = judging.seconds();
    return {std::make_shared<const Surface>(std::move(surface)), std::move(warnings)};
  } catch (const MeshError& error) {
    throw MeshError(fmt::format("{}: {}", path, error.what()));
  }
}

}  // namespace orbitutte::cli
