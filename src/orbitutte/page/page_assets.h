// SPDX-License-Identifier: MIT
// The parts of the page that are files in viewer/, compiled in (cmake/viewer.cmake). The .html files and the
// style are templates: html_template.h.
#pragma once

#include <string_view>

namespace orbitutte {

/// viewer/page.html
extern const std::string_view page_template;
/// viewer/page_head.html
extern const std::string_view page_head;
/// viewer/page_foot.html
extern const std::string_view page_foot;
/// viewer/view.html
extern const std::string_view page_view;
/// viewer/map_page.html
extern const std::string_view map_page_template;
/// viewer/map_view.html
extern const std::string_view map_page_view;
/// viewer/pictures.html
extern const std::string_view page_pictures;
/// viewer/chart.html
extern const std::string_view page_chart;
/// viewer/batch.html
extern const std::string_view batch_template;
/// viewer/style.css
extern const std::string_view page_style;
/// the bundle of viewer/src; empty in a build without Node.js
extern const std::string_view page_script;
/// of what the bundle contains
extern const std::string_view page_licences;

}  // namespace orbitutte
