// SPDX-License-Identifier: MIT
// The affine map between two flat triangles that are given by the lengths of their sides.
#pragma once

#include <algorithm>
#include <cmath>
#include <optional>

namespace orbitutte {

/// The third corner of a plane triangle whose first two corners are (0, 0) and (1, 0); above them.
struct Apex {
  double x, y;
};

/// Of the triangle with the sides ab, bc, ca, scaled so that ab is 1; nothing if it has no area.
inline std::optional<Apex> lay_out(double ab, double bc, double ca) {
  if (!(ab > 0)) return std::nullopt;
  const double x = ((ab - bc) * (ab + bc) + ca * ca) / (2 * ab);
  const double y_squared = (ca - x) * (ca + x);
  if (!(y_squared > 0)) return std::nullopt;
  return Apex{x / ab, std::sqrt(y_squared) / ab};
}

/// sigma_1/sigma_2 of the affine map between two triangles with the same first side. It is z -> a z + b
/// conj(z), |a| : |b| = |p - conj(q)| : |p - q|, p and q their apices, and the ratio is (|a| + |b|)/(|a| -
/// |b|).
inline double ratio_of_singular_values(const Apex& p, const Apex& q) {
  const double x = p.x - q.x, far = std::sqrt(x * x + (p.y + q.y) * (p.y + q.y)),
               near = std::sqrt(x * x + (p.y - q.y) * (p.y - q.y));
  return std::max(1.0, (far + near) * (far + near) / (4 * p.y * q.y));
}

}  // namespace orbitutte
