// SPDX-License-Identifier: MIT
// The style sheet of all pages.
#pragma once

#include <string>

namespace orbitutte {

/// viewer/style.css with the colours that charts have in pictures, too.
std::string page_style_sheet();

}  // namespace orbitutte
