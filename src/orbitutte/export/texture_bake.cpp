// SPDX-License-Identifier: MIT
#include "orbitutte/export/texture_bake.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

#include "orbitutte/errors.h"
#include "orbitutte/export/colour.h"
#include "orbitutte/export/overlay_pieces.h"
#include "orbitutte/export/texture_chart.h"
#include "orbitutte/io/obj_lines.h"

namespace orbitutte {
namespace {

using Eigen::Vector2d;

// Red, green and blue in linear light, times the opacity, and the opacity, 0 .. 1.
using Light = Eigen::Array4f;

constexpr int samples_a_side = 3;
constexpr int largest_texture = 16384;

std::array<float, 256> linear_channels() {
  std::array<float, 256> table = {};
  for (int k = 0; k < 256; ++k) table[k] = linear({static_cast<std::uint8_t>(k), 0, 0})[0];
  return table;
}

Light light_of(const Pixel& pixel) {
  static const std::array<float, 256> channels = linear_channels();
  const float opacity = static_cast<float>(pixel[3]) / 255;
  return {opacity * channels[pixel[0]], opacity * channels[pixel[1]], opacity * channels[pixel[2]], opacity};
}

Pixel pixel_of(const Light& light) {
  const float opacity = light[3];
  const Rgb rgb = srgb(opacity > 0 ? Colour(light.head<3>() / opacity) : Colour(Colour::Zero()));
  return {rgb.red, rgb.green, rgb.blue,
          static_cast<std::uint8_t>(std::lround(255 * std::min(opacity, 1.0F)))};
}

int wrapped(int k, int count) {
  const int rest = k % count;
  return rest < 0 ? rest + count : rest;
}

// A picture as a function of texture coordinates, linear between the middles of pixels.
class PictureSampler {
 public:
  // It repeats if some of the coordinates that are used lie outside of the unit square, and ends with the
  // colour of its border otherwise.
  PictureSampler(const PixelImage& picture, const TextureLayout& layout) : picture_(picture) {
    for (const int row : layout.of_corner)
      repeats_ |= layout.uv.row(row).minCoeff() < 0 || layout.uv.row(row).maxCoeff() > 1;
  }

  Light at(const Vector2d& uv) const {
    const double x = uv[0] * picture_.width - 0.5, y = (1 - uv[1]) * picture_.height - 0.5,
                 left = std::floor(x), top = std::floor(y);
    const auto s = static_cast<float>(x - left), t = static_cast<float>(y - top);
    const auto column = static_cast<int>(left), row = static_cast<int>(top);
    return (1 - t) * ((1 - s) * pixel(column, row) + s * pixel(column + 1, row)) +
           t * ((1 - s) * pixel(column, row + 1) + s * pixel(column + 1, row + 1));
  }

 private:
  Light pixel(int column, int row) const {
    if (repeats_)
      return light_of(picture_.at(wrapped(column, picture_.width), wrapped(row, picture_.height)));
    return light_of(
        picture_.at(std::clamp(column, 0, picture_.width - 1), std::clamp(row, 0, picture_.height - 1)));
  }

  const PixelImage& picture_;
  bool repeats_ = false;
};

// The sums of samples in every pixel.
class TextureCanvas {
 public:
  explicit TextureCanvas(const TextureSize& size)
      : size_(size), texels_(static_cast<std::size_t>(size.width) * size.height) {}

  // Adds the samples in a triangle, whose corners are texture coordinates: `light` gives the light at
  // coordinates on the corners.
  template <typename LightAt>
  void add(const std::array<Vector2d, 3>& uv, const LightAt& light) {
    std::array<Vector2d, 3> at;  // in samples, from the middle of the first
    for (int k = 0; k < 3; ++k)
      at[k] = {uv[k][0] * size_.width * samples_a_side - 0.5,
               (1 - uv[k][1]) * size_.height * samples_a_side - 0.5};
    const Vector2d e = at[1] - at[0], f = at[2] - at[0];
    const double area = e[0] * f[1] - e[1] * f[0];
    if (area == 0 || !std::isfinite(area)) return;
    const Vector2d low = at[0].cwiseMin(at[1]).cwiseMin(at[2]), high = at[0].cwiseMax(at[1]).cwiseMax(at[2]);
    for (int y = first(low[1]); y <= last(high[1]); ++y) {
      for (int x = first(low[0]); x <= last(high[0]); ++x) {
        const Vector2d d = Vector2d(x, y) - at[0];
        const double s = (d[0] * f[1] - d[1] * f[0]) / area, t = (e[0] * d[1] - e[1] * d[0]) / area;
        const Vector3 weights(1 - s - t, s, t);
        if (weights.minCoeff() >= -on_edge) put(x, y, weights.minCoeff() > on_edge, light(weights));
      }
    }
  }

  // Of the samples in faces, the share that lies in several.
  double overlap() const {
    return inside_ > 0 ? static_cast<double>(overlapping_) / static_cast<double>(inside_) : 0;
  }

  PixelImage picture() const {
    std::vector<Light> lights(texels_.size(), Light::Zero());
    std::vector<int> filled;
    for (std::size_t k = 0; k < texels_.size(); ++k) {
      if (texels_[k].count == 0) continue;
      lights[k] = texels_[k].sum / static_cast<float>(texels_[k].count);
      filled.push_back(static_cast<int>(k));
    }
    if (filled.empty()) throw ArgumentError("the texture coordinates of A cover no pixel");
    spread(filled, lights);
    PixelImage image = {size_.width, size_.height, {}};
    image.pixels.reserve(lights.size());
    for (const Light& light : lights) image.pixels.push_back(pixel_of(light));
    return image;
  }

 private:
  struct Texel {
    Light sum = Light::Zero();
    int count = 0;
    std::uint16_t inside = 0;  // bits of the samples that lie inside of a face
  };

  static constexpr double on_edge = 1e-9;

  static int first(double low) { return static_cast<int>(std::ceil(low - on_edge)); }
  static int last(double high) { return static_cast<int>(std::floor(high + on_edge)); }

  void put(int x, int y, bool is_inside, const Light& light) {
    const int column = wrapped(x, size_.width * samples_a_side),
              row = wrapped(y, size_.height * samples_a_side);
    Texel& texel =
        texels_[static_cast<std::size_t>(row / samples_a_side) * size_.width + column / samples_a_side];
    texel.sum += light;
    ++texel.count;
    if (!is_inside) return;
    const auto bit =
        static_cast<std::uint16_t>(1U << (samples_a_side * (row % samples_a_side) + column % samples_a_side));
    overlapping_ += (texel.inside & bit) != 0;
    texel.inside |= bit;
    ++inside_;
  }

  // From pixels that have a colour to those beside them, ring by ring; a pixel of the next ring has the mean
  // of its neighbours that had a colour before.
  void spread(std::vector<int> ring, std::vector<Light>& lights) const {
    std::vector<int> age(lights.size(), 0);  // 0: no colour yet
    for (const int k : ring) age[k] = 1;
    for (int now = 1; !ring.empty(); ++now) {
      std::vector<int> next;
      for (const int k : ring)
        for_neighbours(k, [&](int other) {
          if (age[other] != 0) return;
          age[other] = now + 1;
          next.push_back(other);
        });
      for (const int k : next) {
        int count = 0;
        for_neighbours(k, [&](int other) {
          if (age[other] == 0 || age[other] > now) return;
          lights[k] += lights[other];
          ++count;
        });
        lights[k] /= static_cast<float>(count);
      }
      ring = std::move(next);
    }
  }

  template <typename Visit>
  void for_neighbours(int k, const Visit& visit) const {
    const int column = k % size_.width, row = k / size_.width;
    for (int y = std::max(row - 1, 0); y <= std::min(row + 1, size_.height - 1); ++y)
      for (int x = std::max(column - 1, 0); x <= std::min(column + 1, size_.width - 1); ++x)
        if (x != column || y != row) visit(y * size_.width + x);
  }

  TextureSize size_;
  std::vector<Texel> texels_;
  long long inside_ = 0, overlapping_ = 0;
};

// The texture coordinates of the corners of a piece of the overlay on one of the surfaces.
class PieceTexture {
 public:
  PieceTexture(const TexturedSurface& side, const SurfacePoints& points)
      : side_(side), points_(points), rows_(texture_triangles(side.surface, side.layout)) {}

  Vector2d at(int point, int triangle) const {
    const Vector3 weights = coordinates_in(side_.embedding, points_, point, triangle);
    Vector2d uv = Vector2d::Zero();
    for (int k = 0; k < 3; ++k)
      if (weights[k] != 0) uv += weights[k] * side_.layout.uv.row(rows_(triangle, k)).transpose();
    return uv;
  }

 private:
  const TexturedSurface& side_;
  const SurfacePoints& points_;
  Triangles rows_;
};

void require_no_overlap(const TextureCanvas& canvas) {
  constexpr double tolerated = 0.01;
  if (canvas.overlap() > tolerated)
    throw ArgumentError(
        fmt::format("faces of A lie upon each other in its texture, on {:.0f} % of what they cover, so that "
                    "its parts cannot have colours of their own; take a new chart",
                    100 * canvas.overlap()));
}

}  // namespace

void require_texture_size(const TextureSize& size) {
  if (std::min(size.width, size.height) < 1 || std::max(size.width, size.height) > largest_texture)
    throw ArgumentError(fmt::format("a texture of {} x {} pixels; its sides may have 1 to {}", size.width,
                                    size.height, largest_texture));
}

PixelImage bake_texture(const Overlay& overlay, const TexturedSurface& a, const TexturedSurface& b,
                        const PixelImage& picture_of_b, const TextureSize& size) {
  require_texture_size(size);
  const OverlayPieces pieces = overlay_pieces(overlay);
  const PieceTexture on_a(a, overlay.on_a), on_b(b, overlay.on_b);
  const PictureSampler sampler(picture_of_b, b.layout);
  TextureCanvas canvas(size);
  for (int piece = 0; piece < pieces.count(); ++piece) {
    std::array<Vector2d, 3> target, source;
    for (int k = 0; k < 3; ++k) {
      target[k] = on_a.at(pieces.triangles(piece, k), pieces.on_a[piece]);
      source[k] = on_b.at(pieces.triangles(piece, k), pieces.on_b[piece]);
    }
    canvas.add(target, [&](const Vector3& weights) {
      return sampler.at(weights[0] * source[0] + weights[1] * source[1] + weights[2] * source[2]);
    });
  }
  require_no_overlap(canvas);
  return canvas.picture();
}

TextureLayout new_texture_layout(const Embedding& embedding) {
  TextureCoordinates chart = texture_coordinates(embedding, suitable_chart(embedding));
  return {std::move(chart.uv), std::move(chart.of_corner)};
}

std::string textured_obj(const Surface& surface, const TextureLayout& layout, const std::string& material) {
  texture_triangles(surface, layout);  // throws if the layout is another surface's
  std::string text = fmt::format("mtllib {}\nusemtl surface\n", material);
  append_textured_obj(surface, layout, text);
  return text;
}

std::string textured_material(const std::string& picture) {
  return fmt::format("newmtl surface\nKd 1 1 1\nKs 0 0 0\nillum 1\nmap_Kd {}\n", picture);
}

}  // namespace orbitutte
