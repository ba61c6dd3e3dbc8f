// SPDX-License-Identifier: MIT
#include "orbitutte/render/scales.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>

namespace orbitutte {
namespace {

constexpr Rgb unmeasured = {150, 150, 150};

struct Tick {
  double at;  // 0 .. 1 along the bar
  std::string text;
};

void draw_bar(Canvas& canvas, const Box& box, const std::function<Colour(double)>& colour,
              const std::vector<Tick>& ticks) {
  const double em = canvas.em();
  const Box bar = scale_bar(canvas, box);
  constexpr int steps = 256;
  for (int k = 0; k < steps; ++k)
    // Each strip reaches below the next one: no gaps where they meet inside a pixel.
    canvas.box({bar.x + bar.width * k / steps, bar.y, bar.width - bar.width * k / steps, bar.height},
               srgb(colour((k + 0.5) / steps)));
  for (const Tick& tick : ticks) {
    const double x = bar.x + tick.at * bar.width;
    canvas.line({{x, bar.bottom()}, {x, bar.bottom() + 0.3 * em}}, {.colour = ink::quiet});
    canvas.text({x, bar.bottom() + 1.3 * em}, tick.text, {.size = 0.9, .align = Align::centre});
  }
}

void draw_bar_title(Canvas& canvas, const Box& box, const std::string& title) {
  canvas.text({box.x + 0.5 * box.width, box.y + 3.6 * canvas.em()}, title,
              {.size = 0.9, .colour = ink::quiet, .align = Align::centre});
}

}  // namespace

Box scale_bar(const Canvas& canvas, const Box& box) {
  const double em = canvas.em(), width = std::min(0.7 * box.width, 22 * em);
  return {box.x + 0.5 * (box.width - width), box.y + 0.4 * em, width, 0.8 * em};
}

double quantile(std::vector<double> values, double q) {
  if (values.empty()) return 0;
  const auto at = values.begin() + static_cast<std::ptrdiff_t>(q * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

std::vector<double> log_areas(const std::vector<FaceDistortion>& faces) {
  std::vector<double> values;
  for (const FaceDistortion& face : faces)
    if (face.area > 0) values.push_back(std::log2(face.area));
  return values;
}

std::vector<int> octaves(double range) {
  const int last = static_cast<int>(std::floor(range + 1e-9)), step = (last + 2) / 3;
  std::vector<int> result;
  for (int k = -(last / std::max(step, 1)) * step; k <= last; k += std::max(step, 1)) result.push_back(k);
  return result;
}

std::string power_of_two(int exponent) {
  return exponent < 0 ? fmt::format("1/{}", 1LL << -exponent) : fmt::format("{}", 1LL << exponent);
}

Colour AreaScale::colour(const FaceDistortion& face) const {
  return face.area > 0 ? diverging_colour(std::log2(face.area) / range) : linear(unmeasured);
}

Colour AngleScale::colour(const FaceDistortion& face) const {
  return face.angle > 0 ? sequential_colour((face.angle - 1) / (largest - 1)) : linear(unmeasured);
}

AreaScale area_scale(const std::vector<double>& log_areas) {
  std::vector<double> magnitudes = log_areas;
  for (double& value : magnitudes) value = std::abs(value);
  const double wanted = quantile(std::move(magnitudes), 0.9);
  for (const double range : {1.0, 2.0, 3.0, 4.0})
    if (wanted <= range) return {range};
  return {6};
}

AngleScale angle_scale(const std::vector<FaceDistortion>& faces) {
  std::vector<double> ratios;
  for (const FaceDistortion& face : faces)
    if (face.angle > 0) ratios.push_back(face.angle);
  const double wanted = quantile(std::move(ratios), 0.95);
  for (const double largest : {1.1, 1.2, 1.5, 2.0, 3.0, 5.0})
    if (wanted <= largest) return {largest};
  return {10};
}

void draw_scale(Canvas& canvas, const Box& box, const AreaScale& scale) {
  std::vector<Tick> ticks;
  for (const int k : octaves(scale.range)) ticks.push_back({0.5 * (k / scale.range + 1), power_of_two(k)});
  ticks.front().text.insert(0, "≤ ");
  ticks.back().text.insert(0, "≥ ");
  draw_bar(
      canvas, box, [](double t) { return diverging_colour(2 * t - 1); }, ticks);
  draw_bar_title(canvas, box, fmt::format("← shrunk    {}    enlarged →", area_ratio));
}

void draw_scale(Canvas& canvas, const Box& box, const AngleScale& scale) {
  std::vector<Tick> ticks;
  for (int k = 0; k <= 4; ++k)
    ticks.push_back({k / 4.0, fmt::format("{:.4g}", 1 + k / 4.0 * (scale.largest - 1))});
  ticks.back().text.insert(0, "≥ ");
  draw_bar(canvas, box, sequential_colour, ticks);
  draw_bar_title(canvas, box, "ratio of singular values");
}

}  // namespace orbitutte
