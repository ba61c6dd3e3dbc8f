// SPDX-License-Identifier: MIT
#include "reference.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <map>
#include <stdexcept>

#include "../command_line.h"
#include "../commands.h"
#include "orbitutte/io/mesh_io.h"
#include "orbitutte/orbifold/signature.h"

namespace orbitutte::cli {
namespace {

// The words that shells offer after an option. The program itself judges values, and says in an option's
// description what they may be.
const std::map<std::string, std::vector<std::string>> words_of_options = {
    {"--cones", {"best", "extremities"}},
    {"--objective", choices_of<Objective>()},
    {"--weights", choices_of<WeightKind>()},
    {"--format", choices_of<MeshFormat>()},
    {"--spread", choices_of<Spread>()},
    {"--chart", choices_of<TextureChart>()},
    {"--panel", choices_of<Panel>()},
    {"--view", {"front", "back", "left", "right", "top", "bottom"}},
    {"--up", {"x", "y", "z", "-x", "-y", "-z"}},
    {"--shape", choices_of<SampleShape>()}};

// The symbols of the table of families. If a family has a symbol for every order N, those of small orders.
std::vector<std::string> symbols() {
  constexpr int largest_listed = 6;
  std::vector<std::string> result;
  for (const FamilyDescription& family : families()) {
    if (family.family.find('N') == std::string::npos) {
      result.push_back(family.family);
      continue;
    }
    for (int n = 2; n <= largest_listed; ++n) {
      std::string symbol = family.family;
      std::replace(symbol.begin(), symbol.end(), 'N', static_cast<char>('0' + n));
      result.push_back(symbol);
    }
  }
  return result;
}

std::vector<std::string> targets() {
  std::vector<std::string> result = symbols();
  result.push_back(polygon_signature);
  result.push_back("best");
  return result;
}

std::vector<std::string> words_of(const OptionReference& option) {
  if (option.names.back() == "--orbifold") return targets();
  const auto found = words_of_options.find(option.names.back());
  if (found == words_of_options.end()) return {};
  if (option.description.starts_with("As of ")) return found->second;
  for (const std::string& word : found->second)
    if (option.description.find(word) == std::string::npos)
      throw std::logic_error(fmt::format("{} is completed with '{}', but its description does not name that",
                                         option.names.back(), word));
  return found->second;
}

OptionReference reference_of(const CLI::Option& option) {
  OptionReference reference;
  for (const std::string& name : option.get_snames()) reference.names.push_back("-" + name);
  for (const std::string& name : option.get_lnames()) reference.names.push_back("--" + name);
  if (option.get_positional()) reference.names = {option.get_single_name()};
  if (option.get_type_size() != 0) reference.value = option.get_type_name();
  reference.standard = option.get_default_str();
  reference.description = option.get_description();
  reference.required = option.get_required();
  reference.choices = words_of(reference);
  return reference;
}

CommandReference reference_of(const CLI::App& command) {
  CommandReference reference = {command.get_name(), command.get_description(), {}, {}};
  for (const CLI::Option* option : command.get_options())
    (option->get_positional() ? reference.positionals : reference.options).push_back(reference_of(*option));
  return reference;
}

}  // namespace

std::vector<CommandReference> command_line_reference() {
  int code = 0;
  CLI::App app;
  add_commands(app, code);
  std::vector<CommandReference> commands;
  for (const CLI::App* command : app.get_subcommands(std::function<bool(CLI::App*)>()))
    commands.push_back(reference_of(*command));
  return commands;
}

}  // namespace orbitutte::cli
