// SPDX-License-Identifier: MIT
// usage: orbitutte_reference TEXT_OF_THE_PAGE FOLDER     Run by the build: writes the man page and the
// completions into FOLDER.
#include <fmt/format.h>

#include <exception>

#include "orbitutte/io/file.h"
#include "reference.h"

int main(int argc, char** argv) {
  using namespace orbitutte;
  if (argc != 3) return 2;
  try {
    const std::string folder = argv[2];
    const std::vector<cli::CommandReference> commands = cli::command_line_reference();
    write_file(folder + "/orbitutte.1", cli::man_page(read_file(argv[1]), commands));
    write_file(folder + "/orbitutte.bash", cli::bash_completion(commands));
    write_file(folder + "/_orbitutte", cli::zsh_completion(commands));
    write_file(folder + "/orbitutte.fish", cli::fish_completion(commands));
    return 0;
  } catch (const std::exception& error) {
    fmt::print(stderr, "orbitutte_reference: {}\n", error.what());
    return 1;
  }
}
