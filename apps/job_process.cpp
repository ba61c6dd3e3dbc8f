// SPDX-License-Identifier: MIT
#include "job_process.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>
#ifdef __linux__
#include <sys/prctl.h>
#endif

#include <algorithm>
#include <array>
#include <cerrno>
#include <cmath>
#include <csignal>
#include <cstdio>
#include <fstream>
#include <system_error>
#include <utility>

#include "orbitutte/errors.h"

namespace orbitutte::cli {
namespace {

using Clock = std::chrono::steady_clock;

constexpr std::size_t longest_messages = 1 << 16;
constexpr double room_for_libraries = 2e9;
constexpr double memory_pause = 0.05;  // seconds between two looks at the memory of a process

[[noreturn]] void refuse_process() {
  throw FileError(
      fmt::format("no further process can be started: {}", std::generic_category().message(errno)));
}

void limit(int resource, double value) {
  const rlimit both = {static_cast<rlim_t>(value), static_cast<rlim_t>(value)};
  ::setrlimit(static_cast<decltype(RLIMIT_AS)>(resource), &both);
}

// How large a process is, in bytes; zeros where /proc does not say.
struct ProcessSize {
  double address_space = 0, resident = 0;
};

ProcessSize size_of(const std::string& process) {
  std::ifstream file(fmt::format("/proc/{}/statm", process));
  ProcessSize pages;
  if (!(file >> pages.address_space >> pages.resident)) return {};
  const auto bytes = static_cast<double>(::sysconf(_SC_PAGESIZE));
  return {pages.address_space * bytes, pages.resident * bytes};
}

// These stand behind those that the parent enforces. Address space is much more than memory: gigabytes are
// reserved already, and where none is left OpenBLAS 0.3.21 waits for it forever, or ends the process by
// SIGINT.
void take_limits(const JobLimits& limits) {
  limit(RLIMIT_CORE, 0);
  if (limits.bytes) limit(RLIMIT_AS, size_of("self").address_space + 2 * *limits.bytes + room_for_libraries);
  if (limits.seconds) limit(RLIMIT_CPU, std::ceil(*limits.seconds) + 1);
}

// Ends with the process that forked this one.
void end_with(pid_t parent) {
#ifdef __linux__
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
#endif
  if (::getppid() != parent) ::_exit(1);
}

// Standard error goes into the pipe. All files of the parent are closed, and with them its lock.
void take_streams(int pipe) {
  const int nothing = ::open("/dev/null", O_RDWR);
  ::dup2(nothing, STDIN_FILENO);
  ::dup2(nothing, STDOUT_FILENO);
  ::dup2(pipe, STDERR_FILENO);
#ifdef __linux__
  ::close_range(STDERR_FILENO + 1, ~0U, 0);
#else
  for (int file = STDERR_FILENO + 1; file < static_cast<int>(::sysconf(_SC_OPEN_MAX)); ++file) ::close(file);
#endif
}

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

}  // namespace

JobProcess::JobProcess(const std::function<int()>& work, const JobLimits& limits)
    : start_(Clock::now()), limits_(limits) {
  std::array<int, 2> ends = {};
  if (::pipe(ends.data()) != 0) refuse_process();
  ::fcntl(ends[0], F_SETFL, O_NONBLOCK);
  std::fflush(nullptr);  // what is not written yet would be written twice
  const pid_t parent = ::getpid();
  process_ = ::fork();
  if (process_ == 0) {
    end_with(parent);
    take_streams(ends[1]);
    take_limits(limits);
    const int code = work();
    std::fflush(nullptr);
    ::_exit(code);
  }
  const int reason = errno;
  ::close(ends[1]);
  descriptor_ = ends[0];
  if (process_ > 0) return;
  ::close(std::exchange(descriptor_, -1));
  errno = reason;
  refuse_process();
}

JobProcess::JobProcess(JobProcess&& other) noexcept
    : process_(std::exchange(other.process_, -1)),
      descriptor_(std::exchange(other.descriptor_, -1)),
      start_(other.start_),
      limits_(other.limits_),
      end_(std::move(other.end_)) {}

JobProcess& JobProcess::operator=(JobProcess&& other) noexcept {
  std::swap(process_, other.process_);
  std::swap(descriptor_, other.descriptor_);
  std::swap(start_, other.start_);
  std::swap(limits_, other.limits_);
  std::swap(end_, other.end_);
  return *this;
}

JobProcess::~JobProcess() {
  if (process_ > 0) {
    ::kill(process_, SIGKILL);
    while (::waitpid(process_, nullptr, 0) < 0 && errno == EINTR) continue;
  }
  if (descriptor_ >= 0) ::close(descriptor_);
}

std::optional<double> JobProcess::seconds_to_check() const {
  std::optional<double> left;
  if (limits_.seconds) left = std::max(0.0, *limits_.seconds - seconds_since(start_));
  if (limits_.bytes) left = std::min(left.value_or(memory_pause), memory_pause);
  return left;
}

void JobProcess::enforce_limits() {
  if (limits_.seconds && seconds_since(start_) >= *limits_.seconds) end_.is_out_of_time = true;
  if (limits_.bytes && size_of(std::to_string(process_)).resident > *limits_.bytes)
    end_.is_out_of_memory = true;
  if (!end_.is_out_of_time && !end_.is_out_of_memory) return;
  limits_ = {};
  ::kill(process_, SIGKILL);
}

std::optional<ProcessEnd> JobProcess::advance() {
  std::array<char, 4096> piece;
  const ssize_t count = ::read(descriptor_, piece.data(), piece.size());
  if (count < 0 && (errno == EINTR || errno == EAGAIN)) return std::nullopt;
  if (count > 0) {
    const std::size_t room = longest_messages - std::min(end_.messages.size(), longest_messages);
    end_.messages.append(piece.data(), std::min(static_cast<std::size_t>(count), room));
    return std::nullopt;
  }
  int status = 0;
  rusage usage = {};
  while (::wait4(process_, &status, 0, &usage) < 0 && errno == EINTR) continue;
  process_ = -1;
  if (WIFEXITED(status)) end_.exit_code = WEXITSTATUS(status);
  if (WIFSIGNALED(status)) end_.signal = WTERMSIG(status);
  // It may have ended by itself at the last moment.
  end_.is_out_of_time = end_.signal && (end_.is_out_of_time || *end_.signal == SIGXCPU);
  end_.is_out_of_memory = end_.signal && end_.is_out_of_memory;
  end_.seconds = seconds_since(start_);
  end_.peak_memory_bytes = static_cast<long long>(usage.ru_maxrss) * 1024;
  return end_;
}

void wait_for_any(const std::vector<JobProcess*>& processes) {
  std::vector<pollfd> waiting;
  waiting.reserve(processes.size());
  std::optional<double> pause;
  for (JobProcess* process : processes) {
    waiting.push_back({process->descriptor(), POLLIN, 0});
    const std::optional<double> seconds = process->seconds_to_check();
    if (seconds) pause = std::min(pause.value_or(*seconds), *seconds);
  }
  const int timeout = pause ? static_cast<int>(std::min(1000 * *pause + 1, 1e6)) : -1;
  ::poll(waiting.data(), static_cast<nfds_t>(waiting.size()), timeout);
  for (JobProcess* process : processes) process->enforce_limits();
}

}  // namespace orbitutte::cli
