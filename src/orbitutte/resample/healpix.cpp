// SPDX-License-Identifier: MIT
#include "orbitutte/resample/healpix.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "orbitutte/parallel.h"

namespace orbitutte {
namespace {

using std::numbers::pi;

// Every second bit of a number, from the lowest.
int every_second_bit(int bits) {
  int result = 0;
  for (int k = 0; k < 16; ++k) result |= (bits >> 2 * k & 1) << k;
  return result;
}

// The two pixels of a ring beside a longitude, with shares of `weight`.
void add_beside(int count, int first, double steps, double weight, Stencil& stencil) {
  const double below = std::floor(steps);
  const auto at = [&](double step) {
    const int j = static_cast<int>(step) % count;
    return first + (j < 0 ? j + count : j);
  };
  stencil.add(at(below), weight * (1 - (steps - below)));
  stencil.add(at(below + 1), weight * (steps - below));
}

}  // namespace

// Equations 4 to 9: caps of side - 1 rings, whose ring i has 4 i pixels at |z| = 1 - i^2/(3 side^2); between
// them rings of 4 side pixels at z = 4/3 - 2 i/(3 side).
Healpix::Ring Healpix::ring(int i) const {
  const double n = side_;
  if (i > 3 * side_) {
    const int j = 4 * side_ - i;
    return {4 * j, pixel_count() - 2 * j * (j + 1), -1 + j * j / (3 * n * n), 0.5};
  }
  if (i < side_) return {4 * i, 2 * i * (i - 1), 1 - i * i / (3 * n * n), 0.5};
  return {4 * side_, 2 * side_ * (side_ - 1) + (i - side_) * 4 * side_, 4.0 / 3 - 2 * i / (3 * n),
          (i - side_) % 2 == 0 ? 0.5 : 0.0};
}

int Healpix::ring_above(double z) const {
  const double away = std::abs(z);
  if (away <= 2.0 / 3) return static_cast<int>(side_ * (2 - 1.5 * z));
  const int from_pole = static_cast<int>(side_ * std::sqrt(3 * std::max(0.0, 1 - away)));
  return z > 0 ? from_pole : 4 * side_ - from_pole - 1;
}

Points Healpix::centres() const {
  Points points(pixel_count(), 3);
  parallel_for(4 * side_ - 1, [&](int k) {
    const Ring at = ring(k + 1);
    const double radius = std::sqrt((1 - at.z) * (1 + at.z));
    for (int j = 0; j < at.count; ++j) {
      const double longitude = 2 * pi * (j + at.shift) / at.count;
      points.row(at.first + j) << radius * std::cos(longitude), radius * std::sin(longitude), at.z;
    }
  });
  return points;
}

// Equations 10 to 14: in the base pixel f, the bits of x and y alternate; the ring is F1 side - x - y - 1, F1
// = 2, 3, 4 by the row of f, and along it the longitude grows with x - y.
std::vector<int> Healpix::rings_of_nested() const {
  constexpr std::array<int, 12> longitude = {1, 3, 5, 7, 0, 2, 4, 6, 1, 3, 5, 7};  // F2
  std::vector<int> numbers(pixel_count());
  parallel_ranges(pixel_count(), [&](int begin, int end) {
    for (int p = begin; p < end; ++p) {
      const int f = p / (side_ * side_), inside = p % (side_ * side_);
      const int x = every_second_bit(inside), y = every_second_bit(inside >> 1);
      const int i = (f / 4 + 2) * side_ - x - y - 1;
      const Ring at = ring(i);
      const int quarter = at.count / 4, shifted = at.shift == 0 ? 1 : 0;
      const int j = (longitude[f] * quarter + x - y + 1 + shifted) / 2 - 1;
      numbers[p] = at.first + (j + at.count) % at.count;
    }
  });
  return numbers;
}

Stencil Healpix::stencil(const Vector3& point) const {
  const double length = point.norm(), z = std::clamp(point.z() / length, -1.0, 1.0);
  const double colatitude = std::atan2(point.head<2>().norm(), point.z()),
               longitude = std::atan2(point.y(), point.x());
  const int above = ring_above(z), last = 4 * side_ - 1;
  const auto add = [&](int i, double weight, Stencil& stencil) {
    const Ring at = ring(i);
    add_beside(at.count, at.first, longitude / (2 * pi) * at.count - at.shift, weight, stencil);
  };
  Stencil result;
  if (above > 0 && above < last) {
    const double from = std::acos(ring(above).z), to = std::acos(ring(above + 1).z);
    const double share = std::clamp((colatitude - from) / (to - from), 0.0, 1.0);
    add(above, 1 - share, result);
    add(above + 1, share, result);
    return result;
  }
  // On a cap, `share` of the way from the pole to the ring of four.
  const Ring at = ring(above == 0 ? 1 : last);
  const double from_pole = above == 0 ? colatitude : pi - colatitude, to_ring = std::acos(std::abs(at.z));
  const double share = std::min(from_pole / to_ring, 1.0);
  Stencil beside;
  add(above == 0 ? 1 : last, share, beside);
  for (int j = 0; j < 4; ++j) result.add(at.first + j, (1 - share) / 4);
  for (int k = 0; k < beside.count; ++k) result.weight[beside.index[k] - at.first] += beside.weight[k];
  return result;
}

}  // namespace orbitutte
