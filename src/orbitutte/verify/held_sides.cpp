// SPDX-License-Identifier: MIT
#include "orbitutte/verify/held_sides.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace orbitutte {
namespace {

constexpr double off_side_bound = 1e-12;

// The great arc from p to q, less than pi long.
struct Arc {
  Vector3 p, pole;

  Arc(const Vector3& from, const Vector3& to) : p(from), pole(from.cross(to).normalized()) {}
  double off(const Vector3& x) const { return std::abs(pole.dot(x)); }
  double along(const Vector3& x) const { return std::atan2(pole.dot(p.cross(x)), p.dot(x)); }
};

// Appends what is wrong on a side: boundary vertices from a corner to the next, both included.
void judge_side(const Points& X, const std::vector<int>& side, std::vector<std::string>& departures) {
  const Arc arc(X.row(side.front()), X.row(side.back()));
  for (std::size_t k = 1; k < side.size(); ++k) {
    const Vector3 before = X.row(side[k - 1]), here = X.row(side[k]);
    if (!(arc.off(here) <= off_side_bound))
      departures.push_back(
          fmt::format("boundary vertex {} is off the side between the corners {} and {} by {:.3g}", side[k],
                      side.front(), side.back(), arc.off(here)));
    if (!(arc.along(before) < arc.along(here)))
      departures.push_back(
          fmt::format("boundary vertex {} is not further along the side from corner {} than {}", side[k],
                      side.front(), side[k - 1]));
  }
}

}  // namespace

std::vector<std::string> departures_from_sides(const Points& positions, std::vector<int> boundary,
                                               const std::vector<int>& corners) {
  const auto start = std::find(boundary.begin(), boundary.end(), corners.front());
  if (start == boundary.end())
    return {fmt::format("the corner {} is not on the boundary of the cut mesh", corners.front())};
  std::rotate(boundary.begin(), start, boundary.end());
  boundary.push_back(corners.front());  // the last side ends where the first begins

  std::vector<std::string> departures;
  std::vector<int> side;
  std::size_t next = 1;
  for (const int v : boundary) {
    side.push_back(v);
    if (side.size() == 1 || v != corners[next % corners.size()]) continue;
    judge_side(positions, side, departures);
    side = {v};
    ++next;
  }
  if (next != corners.size() + 1)
    departures.push_back(fmt::format("the boundary of the cut mesh does not meet the corner {} in its turn",
                                     corners[next % corners.size()]));
  return departures;
}

}  // namespace orbitutte
