// SPDX-License-Identifier: MIT
#include "orbitutte/export/carried_files.h"

#include <fmt/compile.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <iterator>

#include "orbitutte/errors.h"
#include "orbitutte/io/file.h"
#include "orbitutte/io/mesh_io.h"
#include "orbitutte/io/obj_lines.h"

namespace orbitutte {
namespace {

// The vertices of face f behind blanks, and the end of the line; `first`: the number of the first vertex.
void append_corners(const FaceView& faces, int f, long long first, std::string& text) {
  for (const int v : faces[f]) fmt::format_to(std::back_inserter(text), FMT_COMPILE(" {}"), v + first);
  text += '\n';
}

std::string coloured_obj(const Surface& surface, const Points& colours) {
  std::string text;
  const auto out = std::back_inserter(text);
  for (Eigen::Index v = 0; v < surface.V.rows(); ++v)
    fmt::format_to(out, FMT_COMPILE("v {} {} {} {:.6g} {:.6g} {:.6g}\n"), surface.V(v, 0), surface.V(v, 1),
                   surface.V(v, 2), colours(v, 0), colours(v, 1), colours(v, 2));
  for (int f = 0; f < surface.faces().count(); ++f) {
    text += 'f';
    append_corners(surface.faces(), f, 1, text);
  }
  return text;
}

long channel_byte(double channel) { return std::lround(255 * std::clamp(channel, 0.0, 1.0)); }

std::string coloured_ply(const Surface& surface, const Points& colours) {
  std::string text = fmt::format(
      "ply\nformat ascii 1.0\nelement vertex {}\nproperty double x\nproperty double y\nproperty double z\n"
      "property uchar red\nproperty uchar green\nproperty uchar blue\nelement face {}\n"
      "property list int int vertex_indices\nend_header\n",
      surface.V.rows(), surface.faces().count());
  const auto out = std::back_inserter(text);
  for (Eigen::Index v = 0; v < surface.V.rows(); ++v)
    fmt::format_to(out, FMT_COMPILE("{} {} {} {} {} {}\n"), surface.V(v, 0), surface.V(v, 1), surface.V(v, 2),
                   channel_byte(colours(v, 0)), channel_byte(colours(v, 1)), channel_byte(colours(v, 2)));
  for (int f = 0; f < surface.faces().count(); ++f) {
    text += std::to_string(surface.faces().degree(f));
    append_corners(surface.faces(), f, 0, text);
  }
  return text;
}

}  // namespace

SurfacePoints points_at_vertices(const Embedding& embedding, const std::vector<int>& vertices) {
  const std::vector<int> corner_of = embedding.corner_at_input_vertex();
  const int count = static_cast<int>(corner_of.size());
  SurfacePoints points;
  points.triangle.reserve(vertices.size());
  points.barycentric = Points::Zero(static_cast<Eigen::Index>(vertices.size()), 3);
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    const int v = vertices[i];
    if (v < 0 || v >= count || corner_of[v] < 0)
      throw ArgumentError(fmt::format("vertex {} does not exist, or no face uses it", v));
    points.triangle.push_back(corner_of[v] / 3);
    points.barycentric(static_cast<Eigen::Index>(i), corner_of[v] % 3) = 1;
  }
  return points;
}

std::string curves_obj(const std::vector<Points>& curves) {
  std::string text;
  const auto out = std::back_inserter(text);
  for (const Points& curve : curves) append_obj_vertices(curve, text);
  long long next = 1;
  for (const Points& curve : curves) {
    text += 'l';
    for (Eigen::Index k = 0; k < curve.rows(); ++k) fmt::format_to(out, FMT_COMPILE(" {}"), next++);
    text += '\n';
  }
  return text;
}

std::string coloured_mesh(const std::string& path, const Surface& surface, const Points& colours) {
  if (colours.rows() != surface.V.rows())
    throw ArgumentError(
        fmt::format("there are {} colours, but the mesh has {} vertices", colours.rows(), surface.V.rows()));
  const std::string ending = ending_of(path);
  if (ending == ".obj") return coloured_obj(surface, colours);
  if (ending == ".ply") return coloured_ply(surface, colours);
  throw ArgumentError(fmt::format("{}: a mesh with colours is written as .ply or .obj", path));
}

std::vector<std::string> frame_paths(const std::string& path, int count) {
  constexpr int most = 10000;
  if (count < 2 || count > most)
    throw ArgumentError(fmt::format("a morph in {} frames; there may be 2 to {}", count, most));
  const std::filesystem::path whole(path);
  const int digits = std::max(2, static_cast<int>(std::to_string(count - 1).size()));
  std::vector<std::string> paths;
  paths.reserve(static_cast<std::size_t>(count));
  for (int k = 0; k < count; ++k)
    paths.push_back((whole.parent_path() /
                     fmt::format("{}_{:0{}}{}", whole.stem().string(), k, digits, whole.extension().string()))
                        .string());
  return paths;
}

void write_morph_frames(const std::string& path, const Morph& morph, int count) {
  const std::vector<std::string> paths = frame_paths(path, count);
  for (int k = 0; k < count; ++k)
    write_mesh(paths[k], Mesh{morph_positions(morph, k / (count - 1.0)), morph.triangles});
}

}  // namespace orbitutte
