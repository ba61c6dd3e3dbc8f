// SPDX-License-Identifier: MIT
#include "orbitutte/render/plot_axes.h"

#include <array>
#include <cmath>
#include <cstdlib>
#include <numbers>

namespace orbitutte {

Box plot_area(const Canvas& canvas, const Box& box) {
  const double em = canvas.em();
  return box.inset(4 * em, 2.2 * em, 1.5 * em, 3.6 * em);
}

void draw_frame(Canvas& canvas, const Box& plot) {
  canvas.line({{plot.x, plot.y}, {plot.x, plot.bottom()}, {plot.right(), plot.bottom()}},
              {.colour = ink::quiet});
}

void draw_x_tick(Canvas& canvas, const Box& plot, double x, const std::string& text) {
  const double em = canvas.em();
  canvas.line({{x, plot.bottom()}, {x, plot.bottom() + 0.3 * em}}, {.colour = ink::quiet});
  canvas.text({x, plot.bottom() + 1.4 * em}, text, {.size = 0.9, .align = Align::centre});
}

void draw_y_tick(Canvas& canvas, const Box& plot, double y, const std::string& text) {
  const double em = canvas.em();
  canvas.line({{plot.x, y}, {plot.right(), y}}, {.width = 0.05, .colour = ink::hairline});
  canvas.text({plot.x - 0.4 * em, y + 0.32 * em}, text, {.size = 0.9, .align = Align::right});
}

void draw_x_label(Canvas& canvas, const Box& plot, const std::string& text) {
  canvas.text({plot.x + 0.5 * plot.width, plot.bottom() + 2.9 * canvas.em()}, text,
              {.size = 0.9, .colour = ink::quiet, .align = Align::centre});
}

void draw_y_label(Canvas& canvas, const Box& plot, const std::string& text) {
  constexpr double upwards = -std::numbers::pi / 2;
  canvas.text({plot.x - 3.2 * canvas.em(), plot.y + 0.5 * plot.height}, text,
              {.size = 0.9, .colour = ink::quiet, .align = Align::centre, .angle = upwards});
}

std::string power(int base, int exponent) {
  static constexpr std::array<const char*, 10> digits = {"⁰", "¹", "²", "³", "⁴", "⁵", "⁶", "⁷", "⁸", "⁹"};
  std::string text = std::to_string(base) + (exponent < 0 ? "⁻" : "");
  for (const char digit : std::to_string(std::abs(exponent))) text += digits[digit - '0'];
  return text;
}

double round_step(double largest, int count) {
  const double raw = largest / count, decade = std::pow(10, std::floor(std::log10(raw)));
  for (const double factor : {1.0, 2.0, 5.0})
    if (factor * decade >= raw * (1 - 1e-9)) return factor * decade;
  return 10 * decade;
}

}  // namespace orbitutte
