// SPDX-License-Identifier: MIT
#include "orbitutte/page/page_frame.h"

#include <fmt/format.h>

#include "orbitutte/export/palette.h"
#include "orbitutte/io/base64.h"
#include "orbitutte/page/html_template.h"
#include "orbitutte/page/page_assets.h"
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

}  // namespace

std::string page_style_sheet() {
  const Rgb energy = tone_colour(ChartTone::energy), gradient = tone_colour(ChartTone::gradient);
  return fill_template({page_style, {}}, {{"energy", hexadecimal(energy)},
                                          {"energy_on_dark", hexadecimal(on_dark(energy))},
                                          {"gradient", hexadecimal(gradient)},
                                          {"gradient_on_dark", hexadecimal(on_dark(gradient))}});
}

std::string page_policy(const std::string& style_sheet, std::string_view script) {
  return fmt::format(
      "default-src 'none'; script-src {}; style-src {}; img-src data:; base-uri 'none'; form-action 'none'",
      script.empty() ? "'none'" : policy_hash(script), policy_hash(style_sheet));
}

}  // namespace orbitutte
