// SPDX-License-Identifier: MIT
// The man page and the shells' completions, made from the definition of the command line, so that no option
// is written down twice.
#pragma once

#include <string>
#include <vector>

namespace orbitutte::cli {

struct OptionReference {
  /// With their dashes, short ones first; for a positional, its bare name.
  std::vector<std::string> names;
  /// What kind of value it takes, e.g. TEXT; empty for a flag.
  std::string value;
  /// The value if none is given; empty if there is none to name.
  std::string standard;
  std::string description;
  bool required = false;
  /// The words that can be completed; empty if any text or file will do.
  std::vector<std::string> choices;
};

struct CommandReference {
  std::string name, description;
  std::vector<OptionReference> positionals, options;
};

/// The program's commands, in their order. Throws std::logic_error if an option's description does not name
/// a word that completes it.
std::vector<CommandReference> command_line_reference();

/// Replaces @COMMANDS@ (roff) and @VERSION@ in the text of the page.
std::string man_page(std::string text, const std::vector<CommandReference>& commands);

std::string bash_completion(const std::vector<CommandReference>& commands);
std::string zsh_completion(const std::vector<CommandReference>& commands);
std::string fish_completion(const std::vector<CommandReference>& commands);

}  // namespace orbitutte::cli
