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

namespace {

// Reads the mesh, and records what the report says about its file.
PolygonMesh read_recorded(const MeshInput& input, RunRecord& run) {
  const Stopwatch reading;
  const std::string bytes = read_bytes(input);
  run.mesh_path = input.path;
  run.input_sha256 = sha256(bytes);
  PolygonMesh mesh = parse_mesh_input(input, bytes);
  run.read_seconds = reading.seconds();
  return mesh;
}

// Messages begin with `name`.
std::shared_ptr<const Surface> judged(PolygonMesh mesh, const std::string& name) {
  return naming_file(name, [&] { return std::make_shared<const Surface>(make_surface(std::move(mesh))); });
}

}  // namespace

Input read_input(const MeshInput& input, RunRecord& run) {
  PolygonMesh mesh = read_recorded(input, run);
  std::vector<std::string> warnings = std::move(mesh.warnings);
  const Stopwatch judging;
  std::shared_ptr<const Surface> surface = judged(std::move(mesh), input.path);
  run.validate_seconds = judging.seconds();
  return {std::move(surface), std::move(warnings)};
}

std::optional<std::string> warning_of_lost_faces(const std::string& path, int before, int left) {
  if (left == 0)
    throw MeshError(
        fmt::format("{}: no face is left after the repair; look at the mesh with `orbitutte info`", path));
  if (2 * left >= before) return std::nullopt;
  return fmt::format(
      "the repair left {} of {} faces; if vertices that belong together are apart, "
      "'orbitutte repair --weld DISTANCE' joins them",
      left, before);
}

Input read_and_repair(const MeshInput& input, RunRecord& run) {
  PolygonMesh mesh = read_recorded(input, run);
  std::vector<std::string> warnings = std::move(mesh.warnings);
  const Stopwatch judging;
  RepairInPlace repaired = repair_in_place(mesh);
  if (auto warning = warning_of_lost_faces(input.path, mesh.face_count(), repaired.mesh.face_count()))
    warnings.push_back(std::move(*warning));
  run.repair = std::move(repaired.summary);
  std::shared_ptr<const Surface> surface =
      judged(std::move(repaired.mesh), fmt::format("{}, repaired", input.path));
  run.validate_seconds = judging.seconds();
  return {std::move(surface), std::move(warnings), std::move(repaired.image)};
}

void tell_steps(const std::vector<RepairRecord>& records) {
  if (records.empty()) tell("orbitutte: nothing had to be repaired\n");
  for (const RepairRecord& record : records) tell("{}: {}\n", name_of(record.step), record.message);
}

}  // namespace orbitutte::cli
