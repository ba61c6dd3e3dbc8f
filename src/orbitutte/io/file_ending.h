// SPDX-License-Identifier: MIT
// Words as tables of formats have them: endings of file names, names of number types.
#pragma once

#include <string>
#include <string_view>

namespace orbitutte {

/// Is the word, without blanks, one of the words that blanks separate?
bool has_word(std::string_view words, std::string_view word);

/// Letters A to Z as a to z.
std::string lower_case(std::string text);

}  // namespace orbitutte
