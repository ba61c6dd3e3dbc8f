// SPDX-License-Identifier: MIT
#include "command_line.h"
#include "orbitutte/memory.h"

int main(int argc, char** argv) {
  orbitutte::keep_freed_memory();
  return orbitutte::cli::run_command_line(argc, argv);
}
