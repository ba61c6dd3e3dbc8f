// SPDX-License-Identifier: MIT
// The names of what there is to choose and to report: one table for each enum, beside the enum. Messages, the
// command line, Python and the report all read it.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace orbitutte {

/// A row of the table of an enum.
template <typename Enum>
struct NamedValue {
  Enum value;
  const char* name;

  /// May a user ask for the value by its name?
  bool is_choice = true;
};

/// The table of an enum: an array `rows` of NamedValue. Every enum that has names specialises it.
template <typename Enum>
struct NameTable;

/// The name of a value.
template <typename Enum>
std::string name_of(Enum value) {
  for (const NamedValue<Enum>& row : NameTable<Enum>::rows)
    if (row.value == value) return row.name;
  return {};
}

/// The value that has this name; nothing if none has.
template <typename Enum>
std::optional<Enum> find_by_name(std::string_view name) {
  for (const NamedValue<Enum>& row : NameTable<Enum>::rows)
    if (row.name == name) return row.value;
  return std::nullopt;
}

/// The names that a user may ask for, in the order of the table.
template <typename Enum>
std::vector<std::string> choices_of() {
  std::vector<std::string> names;
  for (const NamedValue<Enum>& row : NameTable<Enum>::rows)
    if (row.is_choice) names.emplace_back(row.name);
  return names;
}

/// "1 face", "12 faces".
std::string counted(long long count, std::string_view noun);

/// "a, b or c".
std::string listed_choices(const std::vector<std::string>& names);

/// Throws the ArgumentError "`what` is '`name`'; it may be a, b or c".
[[noreturn]] void refuse_choice(std::string_view name, std::string_view what,
                                const std::vector<std::string>& names);

/// The value that a user asks for by its name. `what` is what the message calls it, such as "--weights".
/// Throws an ArgumentError that lists all choices.
template <typename Enum>
Enum parse_choice(std::string_view name, std::string_view what) {
  for (const NamedValue<Enum>& row : NameTable<Enum>::rows)
    if (row.is_choice && row.name == name) return row.value;
  refuse_choice(name, what, choices_of<Enum>());
}

}  // namespace orbitutte
