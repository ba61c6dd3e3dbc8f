// SPDX-License-Identifier: MIT
#include "standard_streams.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <system_error>

#include "orbitutte/errors.h"

namespace orbitutte::cli {

void occupy_closed_streams() {
  // Opens the stream in the wrong direction, so that reading from it or writing to it fails as if it were
  // closed. open() takes the lowest free number, and the lower ones are taken already.
  for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO})
    if (::fcntl(stream, F_GETFD) < 0 && errno == EBADF)
      ::open("/dev/null", stream == STDIN_FILENO ? O_WRONLY : O_RDONLY);
}

void flush_standard_output() {
  if (std::fflush(stdout) == 0 && !std::ferror(stdout)) return;
  throw FileError(
      fmt::format("standard output cannot be written: {}", std::generic_category().message(errno)));
}

void tell_text(const std::string& text) {
  std::fputs(text.c_str(), stderr);
  std::fflush(stderr);
}

void warn(const std::vector<std::string>& sentences) {
  for (const std::string& sentence : sentences) tell("orbitutte: warning: {}\n", sentence);
}

}  // namespace orbitutte::cli
