// SPDX-License-Identifier: MIT
#include "orbitutte/io/corner_file.h"

#include <fmt/format.h>

#include <cmath>

#include "orbitutte/io/file.h"
#include "orbitutte/io/text_scanner.h"

namespace orbitutte {
namespace {

constexpr double rounded_decimals = 1e-3;

PolygonCorner next_corner(TextScanner& scanner, std::size_t number) {
  const TextItem item = {"corner", number};
  PolygonCorner corner;
  corner.vertex = scanner.number<int>(item, "vertex");
  for (int k = 0; k < 3; ++k) corner.position[k] = scanner.number<double>(item, "coordinate");
  if (scanner.find_word_in_line())
    scanner.refuse(fmt::format("more than 'vertex x y z' for the corner at vertex {}", corner.vertex));
  if (!(std::abs(corner.position.norm() - 1) <= rounded_decimals))
    scanner.refuse(
        fmt::format("the corner at vertex {} is at distance {:.6g} from the centre, not on the unit "
                    "sphere",
                    corner.vertex, corner.position.norm()));
  corner.position.normalize();
  return corner;
}

std::vector<PolygonCorner> parse_corners(std::string_view text) {
  TextScanner scanner(text, {.comment = '#'});
  std::vector<PolygonCorner> corners;
  while (scanner.find_word()) corners.push_back(next_corner(scanner, corners.size()));
  return corners;
}

}  // namespace

std::vector<PolygonCorner> read_corners(const std::string& path) { return parse_file(path, parse_corners); }

}  // namespace orbitutte
