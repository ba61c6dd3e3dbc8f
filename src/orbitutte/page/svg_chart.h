// SPDX-License-Identifier: MIT
// Charts as inline SVG, in the page's own colours and readable without script.
#pragma once

#include "orbitutte/page/html_template.h"
#include "orbitutte/report/chart.h"

namespace orbitutte {

/// What fills viewer/chart.html: where texts, bars and lines are, in units of the picture. If the chart is
/// empty, `false`, so that the section is left out.
Content svg_chart(const Chart& chart);

}  // namespace orbitutte
