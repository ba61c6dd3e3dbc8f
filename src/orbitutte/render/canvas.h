// SPDX-License-Identifier: MIT
// Lines, text and images on paper, through Cairo: the same drawing as PNG or as SVG.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "orbitutte/export/palette.h"
#include "orbitutte/render/image.h"

namespace orbitutte {

enum class PictureFormat { png, svg };

/// In pixels, from the top left corner of the picture.
using Place = Eigen::Vector2d;

struct Box {
  double x = 0, y = 0, width = 0, height = 0;

  double right() const { return x + width; }
  double bottom() const { return y + height; }
  /// What remains inside margins, in pixels.
  Box inset(double left, double top, double right, double bottom) const;
};

enum class Align { left, centre, right };

struct TextStyle {
  /// In ems of the canvas.
  double size = 1;
  Rgb colour = ink::text;
  Align align = Align::left;
  bool bold = false;
  /// Radians, clockwise.
  double angle = 0;
};

struct LineStyle {
  /// In ems of the canvas.
  double width = 0.08;
  Rgb colour = ink::text;
  /// In ems; 0: a full line.
  double dash = 0;
};

class Canvas {
 public:
  /// White paper. em: the size of normal text, in pixels. Throws Error if Cairo fails.
  Canvas(PictureFormat format, const PictureSize& size, double em);

  const PictureSize& size() const { return size_; }
  double em() const { return em_; }

  /// The text's baseline begins, is centred or ends at `at`.
  void text(const Place& at, const std::string& text, const TextStyle& style);

  /// All texts so far, in the order in which they were drawn.
  const std::vector<std::string>& texts() const { return texts_; }

  /// In pixels.
  double text_width(const std::string& text, const TextStyle& style) const;

  void line(const std::vector<Place>& points, const LineStyle& style);
  void box(const Box& box, const Rgb& colour);
  void disc(const Place& centre, double radius, const Rgb& colour);
  void ring(const Place& centre, double radius, const LineStyle& style);
  void image(const Place& top_left, const Image& image);

  /// The bytes of the file. Nothing can be drawn afterwards.
  std::string finish();

 private:
  void stroke(const LineStyle& style);

  struct State;
  std::shared_ptr<State> state_;
  PictureSize size_;
  double em_;
  std::vector<std::string> texts_;
};

}  // namespace orbitutte
