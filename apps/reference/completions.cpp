// SPDX-License-Identifier: MIT
#include <fmt/format.h>
#include <fmt/ranges.h>

#include "reference.h"

namespace orbitutte::cli {
namespace {

std::string joined(const std::vector<std::string>& words, const char* separator) {
  return fmt::format("{}", fmt::join(words, separator));
}

// In single quotes, for all three shells.
std::string quoted(const std::string& text) {
  std::string result = "'";
  for (const char c : text) result += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return result + "'";
}

// A star after a backslash, so that zsh and fish do not look for files.
std::string without_patterns(const std::vector<std::string>& words) {
  std::string result;
  for (const char c : joined(words, " ")) result += c == '*' ? std::string("\\*") : std::string(1, c);
  return result;
}

std::vector<std::string> names_of(const std::vector<CommandReference>& commands) {
  std::vector<std::string> names;
  names.reserve(commands.size());
  for (const CommandReference& command : commands) names.push_back(command.name);
  return names;
}

std::vector<std::string> names_of(const std::vector<OptionReference>& options) {
  std::vector<std::string> names;
  for (const OptionReference& option : options)
    names.insert(names.end(), option.names.begin(), option.names.end());
  return names;
}

// zsh's _arguments: '(-o --output)'{-o,--output}'[description]:TEXT:_files'
std::string zsh_option(const OptionReference& option) {
  std::string description;
  for (const char c : option.description) {
    if (c == '[' || c == ']' || c == ':' || c == '\\') description += '\\';
    description += c;
  }
  std::string action;
  if (!option.choices.empty())
    action = fmt::format(":{}:({})", option.value, without_patterns(option.choices));
  else if (!option.value.empty())
    action = fmt::format(":{}:_files", option.value);
  const std::string alternatives =
      option.names.size() == 1 ? option.names.front() : "'{" + joined(option.names, ",") + "}'";
  return fmt::format("'({}){}{}", joined(option.names, " "), alternatives,
                     quoted("[" + description + "]" + action).substr(1));
}

// fish's complete: -s o -l output -r -d 'description'
std::string fish_option(const OptionReference& option) {
  std::string line;
  for (const std::string& name : option.names)
    line += name.starts_with("--") ? " -l " + name.substr(2) : " -s " + name.substr(1);
  if (!option.choices.empty())
    line += fmt::format(" -x -a {}", quoted(without_patterns(option.choices)));
  else if (!option.value.empty())
    line += " -r";
  return line + " -d " + quoted(option.description);
}

}  // namespace

std::string bash_completion(const std::vector<CommandReference>& commands) {
  std::string options, choices;
  for (const CommandReference& command : commands) {
    options += fmt::format("      {}) words='{}' ;;\n", command.name, joined(names_of(command.options), " "));
    for (const OptionReference& option : command.options)
      if (!option.choices.empty())
        choices += fmt::format("    {}:{}) words='{}' ;;\n", command.name, option.names.back(),
                               joined(option.choices, " "));
  }
  return fmt::format(R"(# bash completion for orbitutte; generated from its command line
_orbitutte() {{
  local word=${{COMP_WORDS[COMP_CWORD]}} previous=${{COMP_WORDS[COMP_CWORD - 1]}} words=
  COMPREPLY=()
  if [ "$COMP_CWORD" -eq 1 ]; then
    mapfile -t COMPREPLY < <(compgen -W '{} -h --help --version' -- "$word")
    return
  fi
  # bash takes --option=value for three words
  if [ "$word" = = ]; then
    word=
  elif [ "$previous" = = ]; then
    previous=${{COMP_WORDS[COMP_CWORD - 2]}}
  fi
  case ${{COMP_WORDS[1]}}:$previous in
{}  esac
  if [ -z "$words" ] && [[ $word == -* ]]; then
    case ${{COMP_WORDS[1]}} in
{}    esac
  fi
  # without words of its own it leaves the field to the names of files
  [ -z "$words" ] || mapfile -t COMPREPLY < <(compgen -W "$words" -- "$word")
  # a star that no quote protects would be a pattern of file names
  [[ $word == [\'\"]* ]] || COMPREPLY=("${{COMPREPLY[@]//\*/\\*}}")
}}
complete -o bashdefault -o default -F _orbitutte orbitutte
)",
                     joined(names_of(commands), " "), choices, options);
}

std::string zsh_completion(const std::vector<CommandReference>& commands) {
  std::string names, cases;
  for (const CommandReference& command : commands) {
    std::string name_and_description = command.name + ":";
    for (const char c : command.description)
      name_and_description += c == ':' ? std::string("\\:") : std::string(1, c);
    names += fmt::format("      {}\n", quoted(name_and_description));
    cases += fmt::format("        {})\n          _arguments -s \\\n", command.name);
    for (const OptionReference& option : command.options)
      cases += fmt::format("            {} \\\n", zsh_option(option));
    cases += "            '*:file:_files'\n          ;;\n";
  }
  return fmt::format(R"(#compdef orbitutte
# zsh completion for orbitutte; generated from its command line
_orbitutte() {{
  local state line
  local -a commands
  _arguments -C '(- *)'{{-h,--help}}'[Print a help message]' '(- *)--version[Version and licence]' '1: :->command' '*:: :->arguments'
  case $state in
    command)
      commands=(
{}      )
      _describe command commands
      ;;
    arguments)
      case $words[1] in
{}      esac
      ;;
  esac
}}
_orbitutte "$@"
)",
                     names, cases);
}

std::string fish_completion(const std::vector<CommandReference>& commands) {
  std::string text = "# fish completion for orbitutte; generated from its command line\n";
  text += "complete -c orbitutte -n __fish_use_subcommand -s h -l help -d 'Print a help message'\n";
  text += "complete -c orbitutte -n __fish_use_subcommand -l version -d 'Version and licence'\n";
  for (const CommandReference& command : commands)
    text += fmt::format("complete -c orbitutte -n __fish_use_subcommand -f -a {} -d {}\n", command.name,
                        quoted(command.description));
  for (const CommandReference& command : commands)
    for (const OptionReference& option : command.options)
      text += fmt::format("complete -c orbitutte -n '__fish_seen_subcommand_from {}'{}\n", command.name,
                          fish_option(option));
  return text;
}

}  // namespace orbitutte::cli
