// SPDX-License-Identifier: MIT
// The man page and the shells' completions, from the definition of the command line: no option is written
// down twice.
#pragma once

#include <string>
#include <vector>

namespace orbitutte::cli {

struct OptionReference {
  std::vector<std::string> names;  ///< with their dashes, short ones first; of a positional its bare name
  std::string value;               ///< what kind of value it takes, e.g. TEXT; empty for a flag
  std::string standard;            ///< the value unless it is given; empty where there is none to name
  std::string description;
  bool required = false;
  std::vector<std::string>
      choices;  ///< the words that can be completed; empty where any text or file will do
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
