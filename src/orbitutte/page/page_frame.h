// SPDX-License-Identifier: MIT
// What all pages share. Private to page/.
#pragma once

#include <string>
#include <string_view>

namespace orbitutte {

/// The style sheet with the colours that charts have in pictures, too.
std::string page_style_sheet();

/// A content security policy: nothing is loaded, sent or run but this style and this script, if there is one.
std::string page_policy(const std::string& style_sheet, std::string_view script);

}  // namespace orbitutte
