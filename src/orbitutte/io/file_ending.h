// SPDX-License-Identifier: MIT
// The endings of file names, which say what the files are.
#pragma once

#include <string>
#include <string_view>

namespace orbitutte {

/// Is the word, without blanks, one of the words that blanks separate?
bool has_word(std::string_view words, std::string_view word);

/// Letters A to Z as a to z.
std::string lower_case(std::string text);

/// Does the path end in `.gz` (any case)?
bool is_compressed(const std::string& path);

/// The path without `.gz` (any case) at its end.
std::string without_gz(const std::string& path);

}  // namespace orbitutte
