// SPDX-License-Identifier: MIT
#include "orbitutte/output/comparison.h"

#include <fmt/format.h>

#include "orbitutte/mesh/file.h"
#include "orbitutte/output/file_ending.h"
#include "orbitutte/output/render/plots.h"

namespace orbitutte {
namespace {

PictureFormat format_of(const std::string& path) {
  const std::string ending = lower_case_ending(path);
  if (ending == ".png") return PictureFormat::png;
  if (ending == ".svg") return PictureFormat::svg;
  throw ArgumentError(fmt::format("{}: a comparison is written as .png or .svg", path));
}

}  // namespace

void write_comparison(const std::string& path, const std::vector<ComparedMap>& maps) {
  const PictureFormat format = format_of(path);
  constexpr double width = 900, height = 700, em = 24;
  const int count = static_cast<int>(maps.size());
  Canvas canvas(format, {count * static_cast<int>(width), static_cast<int>(height)}, em);
  for (int k = 0; k < count; ++k) {
    const Box box = Box{k * width, 0, width, height}.inset(em, 3.2 * em, em, em);
    canvas.text({box.x + box.width / 2, 2.2 * em}, maps[k].title,
                {.size = 1.2, .align = Align::centre, .bold = true});
    draw_histogram(canvas, box, maps[k].faces);
  }
  write_file(path, canvas.finish());
}

}  // namespace orbitutte
