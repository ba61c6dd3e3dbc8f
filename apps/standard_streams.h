// SPDX-License-Identifier: MIT
// Standard output carries results, which must arrive. Standard error carries messages, which need not.
#pragma once

#include <fmt/format.h>

#include <cstdio>
#include <string>
#include <utility>
#include <vector>

namespace orbitutte::cli {

/// Keeps files that the program opens from getting the numbers of streams that the caller has closed.
/// Writing to such a stream fails. Call this at the beginning of main.
void occupy_closed_streams();

/// Throws FileError with the system's reason unless all that was printed to standard output has arrived.
void flush_standard_output();

/// Writes text to standard error. A message that nobody can read is no reason to fail.
void tell_text(const std::string& text);

/// The same with arguments.
template <typename... Arguments>
void tell(fmt::format_string<Arguments...> text, Arguments&&... arguments) {
  tell_text(fmt::format(text, std::forward<Arguments>(arguments)...));
}

/// Tells the warnings, a line each.
void warn(const std::vector<std::string>& sentences);

}  // namespace orbitutte::cli
