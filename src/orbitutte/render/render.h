// SPDX-License-Identifier: MIT
// Pictures of an embedding, made without a display: source mesh, sphere, distortion, checkerboard, plots
// (docs/rendering.md).
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "orbitutte/mesh/surface.h"
#include "orbitutte/names.h"
#include "orbitutte/orbifold/embedding.h"
#include "orbitutte/report/report.h"

namespace orbitutte {

enum class Panel { source, sphere, area, angle, checkerboard, histogram, convergence, sheet };

/// Its names.
template <>
struct NameTable<Panel> {
  static constexpr NamedValue<Panel> rows[] = {{Panel::source, "source"},
                                               {Panel::sphere, "sphere"},
                                               {Panel::area, "area"},
                                               {Panel::angle, "angle"},
                                               {Panel::checkerboard, "checkerboard"},
                                               {Panel::histogram, "histogram"},
                                               {Panel::convergence, "convergence"},
                                               {Panel::sheet, "sheet"}};
};

/// What a picture shows, from where, and how large.
struct RenderOptions {
  Panel panel = Panel::sheet;
  /// Pixels, 64 .. 10,000; 0: as suits the panel.
  int width = 0;
  int height = 0;
  /// The direction from the source mesh towards the viewer; from the sphere if that is the only panel.
  std::optional<Vector3> view;
  /// What points up; if not given, default_up_direction decides.
  std::optional<Vector3> up;
};

/// "1200x800", or "1200" for a square. Throws ArgumentError.
void parse_picture_size(const std::string& text, RenderOptions& options);

/// What points up if nothing is given: y, as in most files; z for closed meshes that stand on a broad base
/// across z and not across y, as parts for printing do; -y for those that stand on a base four times as broad
/// at their other end. A guess.
Vector3 default_up_direction(const Surface& surface);

/// A direction "x,y,z" or "x", "-x", ... "-z". Throws ArgumentError.
Vector3 parse_up_direction(const std::string& text);

/// The direction towards the viewer: "front", "back", "left", "right", "top", "bottom" relative to `up`, or
/// "x,y,z". The front is at +z if y is up, and at -y if z is up. Throws ArgumentError.
Vector3 parse_view_direction(const std::string& text, const Vector3& up);

/// What is shown. The surface is the one that was embedded.
struct RenderSubject {
  const Surface& surface;
  const Embedding& embedding;
  const Report& report;
  /// Of the sheet.
  std::string title;
  /// Vertices of the surface among which the cones were chosen: the panel of areas marks them by small balls,
  /// and the cones by large ones.
  std::vector<int> candidates = {};
};

/// The bytes of a PNG, or of an SVG (histogram and convergence only). The same input and options give the
/// same bytes. Throws ArgumentError for options out of range or an SVG of another panel; MeshError if mesh
/// and embedding do not belong together.
std::string render_png(const RenderSubject& subject, const RenderOptions& options = {});
std::string render_svg(const RenderSubject& subject, const RenderOptions& options);

/// Writes the format that the path's ending names (any case), .png or .svg. The file appears whole or not at
/// all. Throws as above, ArgumentError for another ending, and FileError.
void write_picture(const std::string& path, const RenderSubject& subject, const RenderOptions& options = {});

/// What the panel `sphere` shows of an embedding, in words.
std::string tile_caption(const Embedding& embedding);

}  // namespace orbitutte
