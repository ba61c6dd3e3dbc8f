// SPDX-License-Identifier: MIT
#include "job_log.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <filesystem>
#include <system_error>

#include "orbitutte/errors.h"
#include "orbitutte/io/file.h"

namespace orbitutte::cli {
namespace {

namespace fs = std::filesystem;

constexpr auto pause_between_syncs = std::chrono::milliseconds(100);
constexpr mode_t mode_of_logs = 0666;  // the user's umask takes away from it

[[noreturn]] void refuse_log(const std::string& path, std::string_view problem) {
  throw FileError(fmt::format("{}: {}: {}", path, problem, std::generic_category().message(errno)));
}

// How long the file is up to its last line break.
std::size_t length_of_lines(const std::string& path) {
  const std::string text = read_file(path);
  const std::size_t last = text.rfind('\n');
  return last == std::string::npos ? 0 : last + 1;
}

bool is_in_between(const std::string& name, std::string_view begin, std::string_view end) {
  return name.size() >= begin.size() + end.size() && name.starts_with(begin) && name.ends_with(end);
}

// The paths in a folder whose names begin and end so, sorted.
std::vector<std::string> paths_between(const std::string& folder, std::string_view begin,
                                       std::string_view end) {
  std::vector<std::string> paths;
  std::error_code error;
  for (fs::directory_iterator entry(folder, error), last; !error && entry != last; entry.increment(error))
    if (is_in_between(entry->path().filename().string(), begin, end)) paths.push_back(entry->path().string());
  std::sort(paths.begin(), paths.end());
  return paths;
}

}  // namespace

JobLog::JobLog(const std::string& path)
    : path_(path), descriptor_(::open(path.c_str(), O_RDWR | O_CREAT | O_APPEND | O_CLOEXEC, mode_of_logs)) {
  if (descriptor_ < 0) refuse_log(path, "cannot be written");
  if (::flock(descriptor_, LOCK_EX | LOCK_NB) != 0) {
    ::close(descriptor_);
    throw FileError(
        fmt::format("{}: another batch is at work on it; wait for its end, or name another folder", path));
  }
  if (::ftruncate(descriptor_, static_cast<off_t>(length_of_lines(path))) == 0) return;
  ::close(descriptor_);
  refuse_log(path, "cannot be written");
}

JobLog::~JobLog() { ::close(descriptor_); }

void JobLog::append(const JobRecord& record) {
  const std::string line = record_line(record);
  const ssize_t written = ::write(descriptor_, line.data(), line.size());
  if (written >= 0 && static_cast<std::size_t>(written) < line.size()) errno = ENOSPC;
  if (written != static_cast<ssize_t>(line.size())) refuse_log(path_, "cannot be written");
  if (std::chrono::steady_clock::now() - synced_ >= pause_between_syncs) sync();
}

void JobLog::sync() {
  if (::fsync(descriptor_) != 0) refuse_log(path_, "cannot be written");
  synced_ = std::chrono::steady_clock::now();
}

bool is_locked(const std::string& path) {
  const int descriptor = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
  if (descriptor < 0) return false;
  const bool is_free = ::flock(descriptor, LOCK_EX | LOCK_NB) == 0;
  ::close(descriptor);
  return !is_free;
}

std::vector<std::string> logs_in(const std::string& folder) {
  std::vector<std::string> logs = paths_between(folder, "jobs-", ".jsonl");
  const std::string whole = (fs::path(folder) / "jobs.jsonl").string();
  if (std::error_code error; fs::exists(whole, error)) logs.push_back(whole);
  return logs;
}

void remove_leftovers(const std::string& folder) {
  std::error_code error;
  for (const std::string& path : paths_between(folder, ".orbitutte-", ".tmp")) fs::remove(path, error);
}

}  // namespace orbitutte::cli
