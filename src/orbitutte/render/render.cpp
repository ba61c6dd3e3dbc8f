// SPDX-License-Identifier: MIT
#include "orbitutte/render/render.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <Eigen/Geometry>
#include <array>
#include <cmath>
#include <optional>
#include <vector>

#include "orbitutte/io/file.h"
#include "orbitutte/io/text_scanner.h"
#include "orbitutte/render/camera.h"
#include "orbitutte/render/panels.h"

namespace orbitutte {
namespace {

constexpr int smallest_side = 64, largest_side = 10000;

bool is_plot(Panel panel) { return panel == Panel::histogram || panel == Panel::convergence; }

PictureSize default_size(Panel panel) {
  if (panel == Panel::sheet) return {2400, 1840};
  return is_plot(panel) ? PictureSize{1200, 800} : PictureSize{1200, 1200};
}

PictureSize picture_size(const RenderOptions& options) {
  if (options.width == 0 && options.height == 0) return default_size(options.panel);
  for (const int side : {options.width, options.height})
    if (side < smallest_side || side > largest_side)
      throw ArgumentError(fmt::format("the picture's size is {}x{}; each side may have {} to {} pixels",
                                      options.width, options.height, smallest_side, largest_side));
  return {options.width, options.height};
}

bool has_scale(Panel panel) { return panel == Panel::area || panel == Panel::angle; }

// The size of normal text, in pixels: the same share of pictures of all sizes, but larger in small pictures,
// so that the numbers of scales can be read.
double em_of(Panel panel, const PictureSize& size) {
  constexpr double readable = 11;
  const double side = std::min(size.width, size.height);
  if (has_scale(panel)) return std::max(side / 44, std::min(readable, side / 24));
  if (panel == Panel::sheet) return std::min(size.width / 96.0, size.height / 72.0);
  return is_plot(panel) ? std::min(size.width / 42.0, size.height / 26.0) : side / 44;
}

void require_same_mesh(const RenderSubject& subject) {
  const Embedding& embedding = subject.embedding;
  if (subject.surface.triangles.rows() != embedding.triangles.rows())
    throw MeshError(fmt::format("the mesh has {} faces and the embedding {}: they do not belong together",
                                subject.surface.triangles.rows(), embedding.triangles.rows()));
  if (subject.surface.triangles.rows() == 0)
    throw MeshError("the mesh has no faces: there is nothing to draw");
  if (!subject.surface.V.allFinite()) throw MeshError("the mesh has coordinates that are not finite");
  const int vertices = static_cast<int>(subject.surface.V.rows());
  for (const int v : embedding.source_vertex)
    if (v < 0 || v >= vertices)
      throw MeshError(fmt::format(
          "the embedding names vertex {}, but the mesh has {}: they do not belong together", v, vertices));
  for (const ConeCopies& cone : embedding.cones)
    if (cone.vertex < 0 || cone.vertex >= vertices)
      throw MeshError(
          fmt::format("the report names vertex {}, but the mesh has {}: they do not belong together",
                      cone.vertex, vertices));
}

std::string picture(PictureFormat format, const RenderSubject& subject, const RenderOptions& options) {
  require_same_mesh(subject);
  const PictureSize size = picture_size(options);
  Canvas canvas(format, size, em_of(options.panel, size));
  PictureParts parts(subject, options);
  const double margin = (options.panel == Panel::sheet ? 1.5 : 1) * canvas.em();
  const Box page = {0, 0, static_cast<double>(size.width), static_cast<double>(size.height)};
  draw_panel(options.panel, canvas, page.inset(margin, margin, margin, margin), parts);
  return canvas.finish();
}

// All of a text as a number.
template <typename Number>
std::optional<Number> to_number(std::string_view text) {
  Number number = 0;
  return parse_number(text, number) == NumberError::none ? std::optional(number) : std::nullopt;
}

// "x,y,z", finite and not all zero.
std::optional<Vector3> to_direction(std::string_view text) {
  Vector3 direction;
  for (int k = 0; k < 3; ++k) {
    const std::size_t end = k < 2 ? text.find(',') : text.size();
    if (end == std::string_view::npos) return std::nullopt;
    const auto number = to_number<double>(text.substr(0, end));
    if (!number) return std::nullopt;
    direction[k] = *number;
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  if (!direction.allFinite() || !(direction.stableNorm() > 0)) return std::nullopt;
  return direction.stableNormalized();
}

}  // namespace

void parse_picture_size(const std::string& text, RenderOptions& options) {
  const std::size_t cross = text.find('x');
  const std::string_view width = std::string_view(text).substr(0, cross);
  const std::string_view height =
      cross == std::string::npos ? width : std::string_view(text).substr(cross + 1);
  const auto columns = to_number<int>(width), rows = to_number<int>(height);
  if (!columns || !rows)
    throw ArgumentError(fmt::format("the size is '{}'; give pixels, as in 1200x800 or 1200", text));
  options.width = *columns, options.height = *rows;
  if (*columns == 0 && *rows == 0)
    options.width = -1;  // 0x0 is no size, though it stands for the default inside
  picture_size(options);
}

Vector3 parse_up_direction(const std::string& text) {
  const std::string_view axis =
      text.starts_with('-') ? std::string_view(text).substr(1) : std::string_view(text);
  const double sign = text.starts_with('-') ? -1 : 1;
  if (axis == "x") return sign * Vector3::UnitX();
  if (axis == "y") return sign * Vector3::UnitY();
  if (axis == "z") return sign * Vector3::UnitZ();
  if (const auto direction = to_direction(text)) return *direction;
  throw ArgumentError(
      fmt::format("the direction up is '{}'; give x, y, z, -x, -y, -z or three numbers 'x,y,z'", text));
}

Vector3 parse_view_direction(const std::string& text, const Vector3& up) {
  const Matrix3 axes = front_axes(up);
  Vector3 right = axes.row(0), above = axes.row(1), front = axes.row(2);
  if (text == "front") return front;
  if (text == "back") return -front;
  if (text == "right") return right;
  if (text == "left") return -right;
  if (text == "top") return above;
  if (text == "bottom") return -above;
  if (const auto direction = to_direction(text)) return *direction;
  throw ArgumentError(
      fmt::format("the view is '{}'; give front, back, left, right, top, bottom or a direction 'x,y,z' "
                  "towards the viewer",
                  text));
}

std::string render_png(const RenderSubject& subject, const RenderOptions& options) {
  return picture(PictureFormat::png, subject, options);
}

std::string render_svg(const RenderSubject& subject, const RenderOptions& options) {
  if (!is_plot(options.panel))
    throw ArgumentError(fmt::format(
        "the panel '{}' is not a plot, and SVG files hold plots only; write a .png", name_of(options.panel)));
  return picture(PictureFormat::svg, subject, options);
}

void write_picture(const std::string& path, const RenderSubject& subject, const RenderOptions& options) {
  const std::string ending = ending_of(path);
  if (ending == ".png") return write_file(path, render_png(subject, options));
  if (ending == ".svg") return write_file(path, render_svg(subject, options));
  throw ArgumentError(fmt::format("{}: a picture is written as .png or .svg", path));
}

}  // namespace orbitutte
