// SPDX-License-Identifier: MIT
// The parts of the page that are files in viewer/, compiled in (cmake/viewer.cmake).
#pragma once

#include <string_view>

namespace orbitutte {

extern const std::string_view page_template;  ///< viewer/page.html
extern const std::string_view page_view;      ///< viewer/view.html
extern const std::string_view page_style;     ///< viewer/style.css
extern const std::string_view page_script;    ///< the bundle of viewer/src; empty in a build without Node.js
extern const std::string_view page_licences;  ///< of what the bundle contains

}  // namespace orbitutte
