// SPDX-License-Identifier: MIT
#include "usage.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <filesystem>
#include <functional>

namespace orbitutte::cli {
namespace {

// The length of the shortest way from one word to the other by letters that are put in, left out, replaced or
// exchanged with their neighbours, no letter touched twice (optimal string alignment).
int edit_distance(const std::string& a, const std::string& b) {
  const std::size_t columns = b.size() + 1;
  std::vector<int> table((a.size() + 1) * columns);  // of the first i and j letters
  const auto at = [&](std::size_t i, std::size_t j) -> int& { return table[i * columns + j]; };
  for (std::size_t i = 0; i <= a.size(); ++i) {
    for (std::size_t j = 0; j <= b.size(); ++j) {
      if (i == 0 || j == 0) {
        at(i, j) = static_cast<int>(i + j);
        continue;
      }
      const int replaced = at(i - 1, j - 1) + (a[i - 1] != b[j - 1]);
      at(i, j) = std::min({replaced, at(i - 1, j) + 1, at(i, j - 1) + 1});
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1])
        at(i, j) = std::min(at(i, j), at(i - 2, j - 2) + 1);
    }
  }
  return table.back();
}

std::string without_dashes(const std::string& word) {
  return word.substr(std::min(word.find_first_not_of('-'), word.size()));
}

bool is_option(const std::string& word) { return word.size() > 1 && word.front() == '-'; }

std::vector<const CLI::App*> commands_of(const CLI::App& app) {
  return app.get_subcommands(std::function<bool(const CLI::App*)>());
}

std::vector<std::string> command_names(const CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::App* command : commands_of(app)) names.push_back(command->get_name());
  return names;
}

std::vector<std::string> option_names(const CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::Option* option : app.get_options()) {
    for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
    for (const std::string& name : option->get_snames()) names.push_back("-" + name);
  }
  return names;
}

std::string did_you_mean(const std::string& word, const std::vector<std::string>& candidates) {
  const std::optional<std::string> meant = nearest(word, candidates);
  return meant ? fmt::format("; did you mean '{}'?", *meant) : "";
}

std::string list_of_commands(const CLI::App& app) {
  std::string text = "The commands:\n";
  for (const CLI::App* command : commands_of(app))
    text += fmt::format("  {:<9} {}\n", command->get_name(), command->get_description());
  return text + fmt::format("'{} COMMAND --help' shows the options of one.", app.get_name());
}

// The first of the words that nothing has taken. Options come first, since a word after an unknown option is
// its value.
std::string first_unknown(const std::vector<std::string>& words) {
  const auto option = std::find_if(words.begin(), words.end(), is_option);
  return option != words.end() ? *option : words.front();
}

// " has no option '--orbifld'; did you mean '--orbifold'?", to follow the owner's name.
std::string has_no_option(const std::string& word, const CLI::App& owner) {
  const std::string name = word.substr(0, word.find('='));
  return fmt::format(" has no option '{}'{}", name, did_you_mean(name, option_names(owner)));
}

// A shell puts the names of files in place of a star: if there is one where a symbol should be, what helps.
std::string quotes_needed(const CLI::App& command) {
  const CLI::Option* symbol = command.get_option_no_throw("--orbifold");
  if (!symbol || symbol->empty() || !std::filesystem::exists(symbol->results().front())) return "";
  return fmt::format(
      "; '{}' is a file, not a symbol: put a symbol with a star in quotes, as in --orbifold '*'",
      symbol->results().front());
}

std::string about_unknown(const std::string& word, const CLI::App& command) {
  if (is_option(word)) return command.get_name() + has_no_option(word, command);
  return fmt::format("{}: '{}' is one argument too many{}", command.get_name(), word, quotes_needed(command));
}

std::string about_unknown_before_command(const std::string& word, const CLI::App& app) {
  if (is_option(word)) return "the program" + has_no_option(word, app);
  return fmt::format("there is no command '{}'{}", word, did_you_mean(word, command_names(app)));
}

}  // namespace

std::optional<std::string> nearest(const std::string& word, const std::vector<std::string>& candidates) {
  const std::string letters = without_dashes(word);
  if (letters.empty()) return std::nullopt;
  std::optional<std::string> best;
  int smallest = std::max(1, static_cast<int>(letters.size()) / 3) + 1;
  for (const std::string& candidate : candidates) {
    const std::string name = without_dashes(candidate);
    const int distance = name.starts_with(letters) ? 0 : edit_distance(letters, name);
    if (distance >= smallest || distance >= static_cast<int>(name.size())) continue;
    smallest = distance;
    best = candidate;
  }
  return best;
}

std::string usage_message(const CLI::App& app, const CLI::ParseError& error) {
  const std::vector<CLI::App*> chosen = app.get_subcommands();
  if (const std::vector<std::string> unknown = app.remaining(); !unknown.empty())
    return fmt::format("{}\n{}", about_unknown_before_command(unknown.front(), app), list_of_commands(app));
  if (chosen.empty()) return fmt::format("a command is missing\n{}", list_of_commands(app));
  const CLI::App& command = *chosen.front();
  const std::vector<std::string> unknown = command.remaining();
  const std::string problem = unknown.empty() ? fmt::format("{}: {}", command.get_name(), error.what())
                                              : about_unknown(first_unknown(unknown), command);
  return fmt::format("{}\n'{} {} --help' shows the options.", problem, app.get_name(), command.get_name());
}

}  // namespace orbitutte::cli
