// SPDX-License-Identifier: MIT
#include "orbitutte/page/page_frame.h"

#include <fmt/format.h>

#include <utility>

#include "orbitutte/export/palette.h"
#include "orbitutte/io/base64.h"
#include "orbitutte/page/page_assets.h"
#include "orbitutte/report/program.h"
#include "orbitutte/report/report.h"

namespace orbitutte {
namespace {

/// For a content security policy: what the text hashes to.
std::string policy_hash(std::string_view text) {
  const std::string digits = sha256(text);
  std::string digest;
  for (std::size_t k = 0; k < digits.size(); k += 2)
    digest += static_cast<char>(std::stoi(digits.substr(k, 2), nullptr, 16));
  return "'sha256-" + base64(digest) + "'";
}

// The style sheet with the colours that charts have in pictures, too.
std::string page_style_sheet() {
  const Rgb energy = tone_colour(ChartTone::energy), gradient = tone_colour(ChartTone::gradient);
  return fill_template({page_style, {}}, {{"energy", hexadecimal(energy)},
                                          {"energy_on_dark", hexadecimal(on_dark(energy))},
                                          {"gradient", hexadecimal(gradient)},
                                          {"gradient_on_dark", hexadecimal(on_dark(gradient))}});
}

// A content security policy.
std::string page_policy(const std::string& style_sheet, std::string_view script) {
  return fmt::format(
      "default-src 'none'; script-src {}; style-src {}; img-src data:; base-uri 'none'; form-action 'none'",
      script.empty() ? "'none'" : policy_hash(script), policy_hash(style_sheet));
}

}  // namespace

Template framed_template(std::string_view text, std::map<std::string, std::string_view> parts) {
  parts.insert({{"head", page_head}, {"foot", page_foot}});
  return {text, std::move(parts)};
}

void add_frame(std::optional<PageScene> scene, Content& content) {
  const std::string style_sheet = page_style_sheet();
  content["version"] = this_program().version;
  content["style"] = style_sheet;
  content["policy"] = page_policy(style_sheet, scene ? page_script : std::string_view());
  content["interactive"] = scene.has_value();
  if (!scene) return;
  content["licences"] = std::string(page_licences);
  content["script"] = std::string(page_script);
  content["scene_id"] = std::move(scene->id);
  content["scene"] = std::move(scene->json);
}

}  // namespace orbitutte
