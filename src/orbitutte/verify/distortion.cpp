// SPDX-License-Identifier: MIT
#include "orbitutte/verify/distortion.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>
#include <numeric>
#include <optional>

#include "orbitutte/verify/spherical_triangle.h"

namespace orbitutte {
namespace {

using Complex = std::complex<double>;

constexpr double position_rounding = 16 * std::numeric_limits<double>::epsilon();
constexpr double area_rounding = 4 * std::numeric_limits<double>::epsilon();

double triangle_area(const Vector3& a, const Vector3& b, const Vector3& c) {
  return 0.5 * (b - a).cross(c - a).norm();
}

// The two edges from the first corner of a plane triangle with sides ab, bc, ca, the first along the real
// axis; counterclockwise.
std::optional<std::array<Complex, 2>> lay_out(double ab, double bc, double ca) {
  if (!(ab > 0)) return std::nullopt;
  const double x = ((ab - bc) * (ab + bc) + ca * ca) / (2 * ab);
  const double y_squared = (ca - x) * (ca + x);
  if (!(y_squared > 0)) return std::nullopt;
  return std::array<Complex, 2>{Complex(ab, 0), Complex(x, std::sqrt(y_squared))};
}

// sigma_1/sigma_2 of the linear map e_k -> f_k, which is z -> a z + b conj(z): (|a| + |b|)/(|a| - |b|).
double ratio_of_singular_values(const std::array<Complex, 2>& e, const std::array<Complex, 2>& f) {
  const Complex determinant = e[0] * std::conj(e[1]) - e[1] * std::conj(e[0]);
  const double a = std::abs((f[0] * std::conj(e[1]) - f[1] * std::conj(e[0])) / determinant);
  const double b = std::abs((f[1] * e[0] - f[0] * e[1]) / determinant);
  return (a + b) / (a - b);
}

Distortion::Area statistics(std::vector<double>& values) {
  Distortion::Area result;
  if (values.empty()) return result;
  const double count = static_cast<double>(values.size());
  result.mean = std::accumulate(values.begin(), values.end(), 0.0) / count;
  double squares = 0;
  for (const double value : values) squares += (value - result.mean) * (value - result.mean);
  result.std = std::sqrt(squares / count);
  result.max = *std::max_element(values.begin(), values.end());
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  result.median = values.size() % 2 ? *middle : 0.5 * (*middle + *std::max_element(values.begin(), middle));
  return result;
}

// Bins of log2 A, a quarter wide, from -8 to 8.
Distortion::Histogram empty_histogram() {
  Distortion::Histogram histogram;
  for (int k = -32; k <= 32; ++k) histogram.edges.push_back(0.25 * k);
  histogram.counts.assign(64, 0);
  return histogram;
}

void count_in(Distortion::Histogram& histogram, double log2_ratio) {
  const int bin = static_cast<int>(std::floor(std::clamp(4 * log2_ratio, -32.0, 31.0))) + 32;
  ++histogram.counts[bin];
}

// The largest coordinate of an edge: areas in its square overflow nowhere.
double length_unit(const Mesh& mesh) {
  double unit = 0;
  for (int f = 0; f < mesh.F.rows(); ++f)
    for (int k = 0; k < 3; ++k)
      unit = std::max(unit,
                      (mesh.V.row(mesh.F(f, (k + 1) % 3)) - mesh.V.row(mesh.F(f, k))).cwiseAbs().maxCoeff());
  return unit > 0 ? unit : 1;
}

}  // namespace

Distortion measure_distortion(const Mesh& mesh, const Embedding& embedding) {
  const int m = static_cast<int>(mesh.F.rows());
  const double unit = length_unit(mesh);
  std::vector<double> source(m), image(m);
  for (int f = 0; f < m; ++f) {
    const auto v = mesh.F.row(f), w = embedding.faces.row(f);
    source[f] = triangle_area(mesh.V.row(v[0]) / unit, mesh.V.row(v[1]) / unit, mesh.V.row(v[2]) / unit);
    image[f] = signed_area(embedding.positions.row(w[0]), embedding.positions.row(w[1]),
                           embedding.positions.row(w[2]));
  }
  const double source_total = std::accumulate(source.begin(), source.end(), 0.0);
  const double image_total = std::accumulate(image.begin(), image.end(), 0.0, [](double sum, double area) {
    return area > 0 ? sum + area : sum;  // a map that is turned over in places still has shares
  });

  Distortion result;
  result.histogram = empty_histogram();
  std::vector<double> areas;
  double angle_sum = 0;
  int angles = 0;
  for (int f = 0; f < m; ++f) {
    const auto v = mesh.F.row(f), w = embedding.faces.row(f);
    const auto length = [&](int i, int j) {
      return (mesh.V.row(v[i]) / unit - mesh.V.row(v[j]) / unit).norm();
    };
    const auto arc = [&](int i, int j) {
      return arc_length(embedding.positions.row(w[i]), embedding.positions.row(w[j]));
    };
    const double longest = std::max({length(0, 1), length(1, 2), length(2, 0)});
    const double longest_arc = std::max({arc(0, 1), arc(1, 2), arc(2, 0)});
    if (!(source[f] > area_rounding * longest * longest) || !(image[f] > position_rounding * longest_arc))
      continue;
    const double ratio = (image[f] / image_total) / (source[f] / source_total);
    if (!(ratio > 0) || !std::isfinite(ratio)) continue;
    areas.push_back(std::max(ratio, 1 / ratio));
    count_in(result.histogram, std::log2(ratio));

    const auto e = lay_out(length(0, 1), length(1, 2), length(2, 0)),
               g = lay_out(arc(0, 1), arc(1, 2), arc(2, 0));
    if (!e || !g) continue;
    const double angle = ratio_of_singular_values(*e, *g);
    if (!std::isfinite(angle) || angle < 1) continue;
    angle_sum += angle;
    ++angles;
    result.angle.max = std::max(result.angle.max, angle);
  }
  result.measured_faces = static_cast<int>(areas.size());
  result.area = statistics(areas);
  result.angle.mean = angles ? angle_sum / angles : 0;
  return result;
}

}  // namespace orbitutte
