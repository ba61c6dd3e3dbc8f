// SPDX-License-Identifier: MIT
#include "orbitutte/report/chart_numbers.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>

namespace orbitutte {
namespace {

std::string fraction_text(int exponent) {
  return exponent < 0 ? fmt::format("1/{}", 1LL << -exponent) : fmt::format("{}", 1LL << exponent);
}

}  // namespace

double quantile(std::vector<double> values, double q) {
  if (values.empty()) return 0;
  const auto at = values.begin() + static_cast<std::ptrdiff_t>(q * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

double quantile_of_magnitudes(const std::vector<double>& values, double q) {
  std::vector<double> magnitudes = values;
  for (double& value : magnitudes) value = std::abs(value);
  return quantile(std::move(magnitudes), q);
}

double round_step(double largest, int count) {
  const double raw = largest / count, decade = std::pow(10, std::floor(std::log10(raw)));
  for (const double factor : {1.0, 2.0, 5.0})
    if (factor * decade >= raw * (1 - 1e-9)) return factor * decade;
  return 10 * decade;
}

std::vector<ChartTick> octave_ticks(double range) {
  constexpr double longest_fractions = 9;
  const int last = static_cast<int>(std::floor(range + 1e-9)), step = std::max((last + 2) / 3, 1);
  std::vector<ChartTick> ticks;
  for (int k = -(last / step) * step; k <= last; k += step)
    ticks.push_back(
        {static_cast<double>(k), range > longest_fractions ? power_text(2, k) : fraction_text(k)});
  return ticks;
}

std::string power_text(int base, int exponent) {
  static constexpr std::array<const char*, 10> digits = {"⁰", "¹", "²", "³", "⁴", "⁵", "⁶", "⁷", "⁸", "⁹"};
  std::string text = std::to_string(base) + (exponent < 0 ? "⁻" : "");
  for (const char digit : std::to_string(std::abs(exponent))) text += digits[digit - '0'];
  return text;
}

}  // namespace orbitutte
