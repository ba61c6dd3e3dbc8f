// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include "orbitutte/version.h"
#include "reference.h"

namespace orbitutte::cli {
namespace {

// Text for roff: dashes that can be copied from the page, and no line that begins with a request.
std::string roff(const std::string& text) {
  std::string result;
  for (const char c : text) {
    if (c == '\\')
      result += "\\e";
    else if (c == '-')
      result += "\\-";
    else
      result += c;
  }
  return result.starts_with('.') || result.starts_with('\'') ? "\\&" + result : result;
}

std::string upper_case(std::string text) {
  for (char& c : text)
    if (c >= 'a' && c <= 'z') c = static_cast<char>(c - 'a' + 'A');
  return text;
}

// .B embed MESH --orbifold TEXT [OPTION ...]
std::string synopsis(const CommandReference& command) {
  std::string line = fmt::format("\\fB{}\\fR", command.name);
  for (const OptionReference& positional : command.positionals)
    line += fmt::format(" \\fI{}\\fR", roff(upper_case(positional.names.front())));
  for (const OptionReference& option : command.options)
    if (option.required)
      line += fmt::format(" \\fB{}\\fR \\fI{}\\fR", roff(option.names.front()), roff(option.value));
  return line + " [\\fIOPTION\\fR ...]\n";
}

std::string row(const OptionReference& option) {
  std::string names;
  for (const std::string& name : option.names)
    names += fmt::format("{}\\fB{}\\fR", names.empty() ? "" : ", ", roff(name));
  if (!option.value.empty()) names += fmt::format(" \\fI{}\\fR", roff(option.value));
  std::string text = option.description;
  if (option.required) text += " (required)";
  if (!option.standard.empty()) text += fmt::format(" (default: {})", option.standard);
  return fmt::format(".TP\n{}\n{}\n", names, roff(text));
}

std::string section(const CommandReference& command) {
  std::string text =
      fmt::format(".SS {}\n{}{}.\n", command.name, synopsis(command) + ".PP\n", roff(command.description));
  for (const OptionReference& positional : command.positionals)
    text += fmt::format(".TP\n\\fI{}\\fR\n{}\n", roff(upper_case(positional.names.front())),
                        roff(positional.description));
  for (const OptionReference& option : command.options)
    if (option.names.back() != "--help") text += row(option);  // the page's own section has it
  return text;
}

void replace(std::string& text, const std::string& mark, const std::string& by) {
  const std::size_t at = text.find(mark);
  if (at != std::string::npos) text.replace(at, mark.size(), by);
}

}  // namespace

std::string man_page(std::string text, const std::vector<CommandReference>& commands) {
  std::string sections;
  for (const CommandReference& command : commands) sections += section(command);
  replace(text, "@VERSION@", version);
  replace(text, "@COMMANDS@\n", sections);
  return text;
}

}  // namespace orbitutte::cli
