// SPDX-License-Identifier: MIT
#include "orbitutte/names.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "orbitutte/errors.h"

namespace orbitutte {

std::string counted(long long count, std::string_view noun) {
  return fmt::format("{} {}{}", count, noun, count == 1 ? "" : "s");
}

std::string listed_choices(const std::vector<std::string>& names) {
  if (names.size() < 2) return fmt::format("{}", fmt::join(names, ""));
  return fmt::format("{} or {}", fmt::join(names.begin(), names.end() - 1, ", "), names.back());
}

void refuse_choice(std::string_view name, std::string_view what, const std::vector<std::string>& names) {
  throw ArgumentError(fmt::format("{} is '{}'; it may be {}", what, name, listed_choices(names)));
}

}  // namespace orbitutte
