// SPDX-License-Identifier: MIT
// Colour maps are straight lines in Oklab (B. Ottosson, "A perceptual color space for image processing",
// 2020), where equal steps look equal. Lists of colours: P. Tol, "Colour Schemes", SRON technical note 09-002
// (2021).
#include "orbitutte/render/colour.h"

#include <Eigen/LU>
#include <array>
#include <cmath>

namespace orbitutte {
namespace {

using Matrix3f = Eigen::Matrix3f;

float linear_channel(std::uint8_t channel) {
  const float s = static_cast<float>(channel) / 255;
  return s <= 0.04045F ? s / 12.92F : std::pow((s + 0.055F) / 1.055F, 2.4F);
}

std::uint8_t srgb_channel(float channel) {
  const float c = std::min(std::max(channel, 0.0F), 1.0F);
  const float s = c <= 0.0031308F ? 12.92F * c : 1.055F * std::pow(c, 1 / 2.4F) - 0.055F;
  return static_cast<std::uint8_t>(std::lround(255 * s));
}

// Linear sRGB to the responses of the eye's cones, and their cube roots to Oklab.
Matrix3f eye_from_rgb() {
  return (Matrix3f() << 0.4122214708F, 0.5363325363F, 0.0514459929F, 0.2119034982F, 0.6806995451F,
          0.1073969566F, 0.0883024619F, 0.2817188376F, 0.6299787005F)
      .finished();
}

Matrix3f oklab_from_eye() {
  return (Matrix3f() << 0.2104542553F, 0.7936177850F, -0.0040720468F, 1.9779984951F, -2.4285922050F,
          0.4505937099F, 0.0259040371F, 0.7827717662F, -0.8086757660F)
      .finished();
}

Eigen::Vector3f oklab(const Colour& colour) {
  const Eigen::Vector3f eye = eye_from_rgb() * colour.matrix();
  return oklab_from_eye() * eye.array().unaryExpr([](float x) { return std::cbrt(x); }).matrix();
}

Colour from_oklab(const Eigen::Vector3f& lab) {
  static const Matrix3f rgb_from_eye = eye_from_rgb().inverse(), eye_from_oklab = oklab_from_eye().inverse();
  return (rgb_from_eye * (eye_from_oklab * lab).array().cube().matrix()).array();
}

// The point t in 0 .. 1 of the straight line between two colours in Oklab.
Colour between(const Eigen::Vector3f& from, const Eigen::Vector3f& to, double t) {
  return from_oklab(from + static_cast<float>(t) * (to - from)).max(0).min(1);
}

// The same colour at another lightness, in Oklab; what no screen can show is cut off.
Eigen::Vector3f at_lightness(const Rgb& colour, float lightness) {
  Eigen::Vector3f lab = oklab(linear(colour));
  lab[0] = lightness;
  return oklab(linear(srgb(from_oklab(lab))));
}

}  // namespace

Colour linear(const Rgb& colour) {
  return {linear_channel(colour.red), linear_channel(colour.green), linear_channel(colour.blue)};
}

Rgb srgb(const Colour& colour) {
  return {srgb_channel(colour[0]), srgb_channel(colour[1]), srgb_channel(colour[2])};
}

Colour mix(const Colour& a, const Colour& b, float t) { return a + t * (b - a); }

double lightness(const Colour& colour) { return oklab(colour)[0]; }

Colour diverging_colour(double t) {
  constexpr float darkest = 0.46F;
  static const Eigen::Vector3f white = oklab(linear({244, 244, 242})),
                               blue = at_lightness({33, 102, 172}, darkest),
                               red = at_lightness({178, 24, 43}, darkest);
  return between(white, t < 0 ? blue : red, std::min(std::abs(t), 1.0));
}

Colour sequential_colour(double t) {
  // Three stops of equally spaced lightness.
  static const Eigen::Vector3f pale = at_lightness({255, 247, 214}, 0.96F),
                               middle = at_lightness({221, 106, 96}, 0.66F),
                               dark = at_lightness({80, 24, 96}, 0.36F);
  const double s = std::min(std::max(t, 0.0), 1.0);
  return s < 0.5 ? between(pale, middle, 2 * s) : between(middle, dark, 2 * s - 1);
}

Rgb cone_colour(int cone) {
  static constexpr std::array<Rgb, 4> colours = {{{204, 51, 17}, {0, 136, 96}, {136, 46, 114}, {0, 92, 160}}};
  return colours[cone % colours.size()];
}

Rgb seam_colour(int seam) {
  static constexpr std::array<Rgb, 6> colours = {
      {{238, 153, 34}, {34, 48, 92}, {238, 51, 119}, {0, 153, 136}, {187, 187, 51}, {102, 102, 102}}};
  return colours[seam % colours.size()];
}

}  // namespace orbitutte
