// SPDX-License-Identifier: MIT
// The message about a wrong command line: which word is wrong, and what may be meant.
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace CLI {  // NOLINT(readability-identifier-naming): the name is CLI11's
class App;
class ParseError;
}  // namespace CLI

namespace orbitutte::cli {

/// The candidate that a misspelt word most likely means: one that begins with it, or else the one with the
/// fewest letters that are wrong, missing, superfluous or exchanged with their neighbours, up to a third of
/// the word's. If several are equal, the first; nothing if all differ more.
std::optional<std::string> nearest(const std::string& word, const std::vector<std::string>& candidates);

/// The message about a parse of `app` that failed with `error`, of one line or more.
std::string usage_message(const CLI::App& app, const CLI::ParseError& error);

}  // namespace orbitutte::cli
