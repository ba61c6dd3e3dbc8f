// SPDX-License-Identifier: MIT
// Text in the form that HTML requires.
#pragma once

#include <string>
#include <string_view>

namespace orbitutte {

/// Replaces & < > " ' by character references: the text is then safe between tags and within quoted
/// attributes.
std::string escape_html(std::string_view text);

/// A count with commas between groups of three digits.
std::string grouped_digits(long long count);

}  // namespace orbitutte
