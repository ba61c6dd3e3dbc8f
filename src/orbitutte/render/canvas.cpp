// SPDX-License-Identifier: MIT
#include "orbitutte/render/canvas.h"

#include <cairo-svg.h>
#include <cairo.h>
#include <fmt/format.h>

#include <cmath>
#include <cstdint>
#include <new>
#include <numbers>

#include "orbitutte/parallel.h"

namespace orbitutte {
namespace {

constexpr const char* font = "DejaVu Sans";

// A callback of Cairo, whose user data is a std::string.
cairo_status_t append_bytes(void* string, const unsigned char* bytes, unsigned count) {
  static_cast<std::string*>(string)->append(reinterpret_cast<const char*>(bytes), count);
  return CAIRO_STATUS_SUCCESS;
}

void check(cairo_status_t status) {
  if (status == CAIRO_STATUS_NO_MEMORY) throw std::bad_alloc();
  if (status != CAIRO_STATUS_SUCCESS)
    throw Error(fmt::format("the picture cannot be drawn: {}", cairo_status_to_string(status)));
}

void set_source(cairo_t* context, const Rgb& colour) {
  cairo_set_source_rgb(context, colour.red / 255.0, colour.green / 255.0, colour.blue / 255.0);
}

// Cairo's ARGB32: channels times coverage, in sRGB. Blending happens in linear light against white paper, and
// the result is opaque: what Cairo would do with transparent sRGB darkens outlines.
std::uint32_t on_paper(const Rgba& pixel) {
  if (pixel[3] == 0) return 0xffffffffU;
  const Rgb colour = srgb(pixel.head<3>() + (1 - pixel[3]));
  return 0xff000000U | static_cast<std::uint32_t>(colour.red) << 16U |
         static_cast<std::uint32_t>(colour.green) << 8U | colour.blue;
}

// Cairo numbers all surfaces of the process, and writes the number into an attribute that nothing refers to.
void drop_surface_number(std::string& svg) {
  const std::size_t begin = svg.find(" id=\"surface");
  if (begin == std::string::npos) return;
  const std::size_t end = svg.find('>', begin);
  svg.erase(begin, end - begin);
}

}  // namespace

struct Canvas::State {
  std::string bytes;  // what an SVG surface has written so far
  PictureFormat format;
  cairo_surface_t* surface = nullptr;
  cairo_t* context = nullptr;

  State(PictureFormat wanted, const PictureSize& size) : format(wanted) {
    surface = format == PictureFormat::png
                  ? cairo_image_surface_create(CAIRO_FORMAT_RGB24, size.width, size.height)
                  : cairo_svg_surface_create_for_stream(append_bytes, &bytes, size.width, size.height);
    context = cairo_create(surface);
  }
  State(const State&) = delete;
  State& operator=(const State&) = delete;
  ~State() {
    cairo_destroy(context);
    cairo_surface_destroy(surface);
  }
};

Box Box::inset(double left, double top, double right_margin, double bottom_margin) const {
  return {x + left, y + top, width - left - right_margin, height - top - bottom_margin};
}

Canvas::Canvas(PictureFormat format, const PictureSize& size, double em)
    : state_(std::make_shared<State>(format, size)), size_(size), em_(em) {
  check(cairo_status(state_->context));
  cairo_font_options_t* const options = cairo_font_options_create();
  cairo_font_options_set_antialias(options, CAIRO_ANTIALIAS_GRAY);
  cairo_font_options_set_hint_style(options, CAIRO_HINT_STYLE_NONE);
  cairo_font_options_set_hint_metrics(options, CAIRO_HINT_METRICS_OFF);
  cairo_set_font_options(state_->context, options);
  cairo_font_options_destroy(options);
  box({0, 0, static_cast<double>(size.width), static_cast<double>(size.height)}, ink::paper);
}

void Canvas::text(const Place& at, const std::string& text, const TextStyle& style) {
  texts_.push_back(text);
  cairo_t* const context = state_->context;
  const double width = text_width(text, style);
  const double shift = style.align == Align::left ? 0 : style.align == Align::centre ? 0.5 * width : width;
  cairo_save(context);
  cairo_translate(context, at[0], at[1]);
  cairo_rotate(context, style.angle);
  cairo_move_to(context, -shift, 0);
  set_source(context, style.colour);
  cairo_show_text(context, text.c_str());
  cairo_restore(context);
  cairo_new_path(context);  // text leaves a point behind, from which the next line would begin
}

double Canvas::text_width(const std::string& text, const TextStyle& style) const {
  cairo_t* const context = state_->context;
  cairo_select_font_face(context, font, CAIRO_FONT_SLANT_NORMAL,
                         style.bold ? CAIRO_FONT_WEIGHT_BOLD : CAIRO_FONT_WEIGHT_NORMAL);
  cairo_set_font_size(context, style.size * em_);
  cairo_text_extents_t extents;
  cairo_text_extents(context, text.c_str(), &extents);
  return extents.x_advance;
}

void Canvas::line(const std::vector<Place>& points, const LineStyle& style) {
  for (const Place& point : points) cairo_line_to(state_->context, point[0], point[1]);
  stroke(style);
}

void Canvas::box(const Box& box, const Rgb& colour) {
  cairo_rectangle(state_->context, box.x, box.y, box.width, box.height);
  set_source(state_->context, colour);
  cairo_fill(state_->context);
}

void Canvas::disc(const Place& centre, double radius, const Rgb& colour) {
  cairo_arc(state_->context, centre[0], centre[1], radius, 0, 2 * std::numbers::pi);
  set_source(state_->context, colour);
  cairo_fill(state_->context);
}

void Canvas::ring(const Place& centre, double radius, const LineStyle& style) {
  cairo_arc(state_->context, centre[0], centre[1], radius, 0, 2 * std::numbers::pi);
  stroke(style);
}

void Canvas::stroke(const LineStyle& style) {
  cairo_t* const context = state_->context;
  const double dash = style.dash * em_;
  cairo_set_dash(context, &dash, style.dash > 0 ? 1 : 0, 0);
  cairo_set_line_join(context, CAIRO_LINE_JOIN_ROUND);
  cairo_set_line_width(context, style.width * em_);
  set_source(context, style.colour);
  cairo_stroke(context);
}

void Canvas::image(const Place& top_left, const Image& image) {
  cairo_surface_t* const pixels =
      cairo_image_surface_create(CAIRO_FORMAT_RGB24, image.size.width, image.size.height);
  check(cairo_surface_status(pixels));
  unsigned char* const data = cairo_image_surface_get_data(pixels);
  const int stride = cairo_image_surface_get_stride(pixels);
  parallel_for(image.size.height, [&](int row) {
    auto* const line = reinterpret_cast<std::uint32_t*>(data + static_cast<std::ptrdiff_t>(row) * stride);
    for (int column = 0; column < image.size.width; ++column) line[column] = on_paper(image.at(column, row));
  });
  cairo_surface_mark_dirty(pixels);
  cairo_set_source_surface(state_->context, pixels, std::round(top_left[0]), std::round(top_left[1]));
  cairo_paint(state_->context);
  cairo_surface_destroy(pixels);
}

std::string Canvas::finish() {
  check(cairo_status(state_->context));
  if (state_->format == PictureFormat::png) {
    check(cairo_surface_write_to_png_stream(state_->surface, append_bytes, &state_->bytes));
  } else {
    cairo_surface_finish(state_->surface);
    check(cairo_surface_status(state_->surface));
    drop_surface_number(state_->bytes);
  }
  return std::move(state_->bytes);
}

}  // namespace orbitutte
