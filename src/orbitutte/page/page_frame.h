// SPDX-License-Identifier: MIT
// What all pages share. Private to page/.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <string_view>

#include "orbitutte/page/html_template.h"

namespace orbitutte {

/// A page's template: its text, the parts that all pages have ({{>head}}, {{>foot}}), and others of its own.
Template framed_template(std::string_view text, std::map<std::string, std::string_view> parts);

/// What the interactive view shows.
struct PageScene {
  /// Of the element that holds it.
  std::string id;

  /// JSON.
  std::string json;
};

/// Adds what the parts that all pages have show: version, style, a content security policy (nothing is
/// loaded, sent or run but this style and the view's script), and the script with its licences if there is a
/// scene for it.
void add_frame(std::optional<PageScene> scene, Content& content);

}  // namespace orbitutte
