// SPDX-License-Identifier: MIT
// The man page and the shells' completions, from the definition of the command line: no option is written
// down twice.
#pragma once

#include <string>
#include <vector>

namespace orbitutte::cli {

struct OptionReference {
  /// With their dashes, short ones first; of a positional its bare name.
  std::vector<std::string> names;
  /// What kind of value it takes, e.g. TEXT; empty for a flag.
  std::string value;
  /// The value unless it is given; empty where there is none to name.
  std::string standard;
  std::string description;
  bool required = false;
  /// The words that can be completed; empty where any text or file will do.
  std::vector<std::string> choices;
};

struct CommandReference {
  std::string name, description;
  std::vector<OptionReference> positionals, options;
};

/// The program's commands, in their order. Throws std::logic_error where a word to be completed is not one
/// that the option's description names.
std::vector<CommandReference> command_line_reference();

/// Replaces @COMMANDS@ (roff) and @VERSION@ in the text of the page.
std::string man_page(std::string text, const std::vector<CommandReference>& commands);

std::string bash_completion(const std::vector<CommandReference>& commands);
std::string zsh_completion(const std::vector<CommandReference>& commands);
std::string fish_completion(const std::vector<CommandReference>& commands);

}  // namespace orbitutte::cli
