// SPDX-License-Identifier: MIT
// The command line as CLI11 knows it: what the program parses, and what its man page and completions are
// written from.
#pragma once

namespace CLI {  // NOLINT(readability-identifier-naming): the name is CLI11's
class App;
}

namespace orbitutte::cli {

/// Adds every command with its options. The one that runs when `app` parses leaves its exit code in `code`,
/// which must outlive `app`.
void add_commands(CLI::App& app, int& code);

/// Parses, runs, and returns the exit code.
int run_command_line(int argc, char** argv);

}  // namespace orbitutte::cli
