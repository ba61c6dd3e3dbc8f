// SPDX-License-Identifier: MIT
#include "command_line.h"
#include "orbitutte/memory.h"
#include "standard_streams.h"

int main(int argc, char** argv) {
  orbitutte::cli::occupy_closed_streams();
  orbitutte::use_huge_pages();
  return orbitutte::cli::run_command_line(argc, argv);
}
