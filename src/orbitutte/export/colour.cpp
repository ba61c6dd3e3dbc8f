// SPDX-License-Identifier: MIT
// Oklab: B. Ottosson, "A perceptual color space for image processing", 2020.
#include "orbitutte/export/colour.h"

#include <fmt/format.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

namespace orbitutte {
namespace {

using Matrix3f = Eigen::Matrix3f;

float linear_share(std::uint8_t channel) {
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

}  // namespace

Colour linear(const Rgb& colour) {
  return {linear_share(colour.red), linear_share(colour.green), linear_share(colour.blue)};
}

Rgb srgb(const Colour& colour) {
  return {srgb_channel(colour[0]), srgb_channel(colour[1]), srgb_channel(colour[2])};
}

Colour mix(const Colour& a, const Colour& b, float t) { return a + t * (b - a); }

double lightness(const Colour& colour) { return oklab(colour)[0]; }

Colour between(const Colour& from, const Colour& to, double t) {
  const Eigen::Vector3f a = oklab(from), b = oklab(to);
  return from_oklab(a + static_cast<float>(std::clamp(t, 0.0, 1.0)) * (b - a)).max(0).min(1);
}

Colour at_lightness(const Rgb& colour, double wanted) {
  Eigen::Vector3f lab = oklab(linear(colour));
  lab[0] = static_cast<float>(wanted);
  return linear(srgb(from_oklab(lab)));
}

std::string hexadecimal(const Rgb& colour) {
  return fmt::format("#{:02x}{:02x}{:02x}", colour.red, colour.green, colour.blue);
}

}  // namespace orbitutte
