// SPDX-License-Identifier: MIT
#include "orbitutte/page/page_style.h"

#include "orbitutte/export/palette.h"
#include "orbitutte/page/html_template.h"
#include "orbitutte/page/page_assets.h"

namespace orbitutte {

std::string page_style_sheet() {
  const Rgb energy = tone_colour(ChartTone::energy), gradient = tone_colour(ChartTone::gradient);
  return fill_template({page_style, {}}, {{"energy", hexadecimal(energy)},
                                          {"energy_on_dark", hexadecimal(on_dark(energy))},
                                          {"gradient", hexadecimal(gradient)},
                                          {"gradient_on_dark", hexadecimal(on_dark(gradient))}});
}

}  // namespace orbitutte
