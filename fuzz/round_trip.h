// SPDX-License-Identifier: MIT
// What has to hold for any bytes given to a reader of meshes or of values at vertices. The fuzz targets and
// the test that replays their corpus both check it.
#pragma once

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>

#include "orbitutte/io/mesh_io.h"
#include "orbitutte/io/ply.h"
#include "orbitutte/io/vertex_data.h"

namespace orbitutte::fuzz {

inline void require(bool holds, const char* property) {
  if (!holds) throw std::logic_error(std::string("violated: ") + property);
}

/// Messages may end up in JSON and on a terminal, so that no byte of the file may get through unseen.
inline void check_message(std::string_view message) {
  const auto is_printable = [](char c) { return c >= ' ' && c <= '~'; };
  require(!message.empty(), "a message says something");
  require(std::all_of(message.begin(), message.end(), is_printable),
          "a message is one line of printable ASCII");
}

inline void check_faces(const PolygonMesh& mesh) {
  const std::vector<int>& start = mesh.face_start;
  require(!start.empty() && start.front() == 0, "the first face starts at the first corner");
  require(start.back() == static_cast<int>(mesh.corners.size()), "the last face ends at the last corner");
  require(std::is_sorted(start.begin(), start.end()), "faces follow each other");
}

inline void check_colours(const PolygonMesh& mesh) {
  require(mesh.colours.rows() == 0 || mesh.colours.rows() == mesh.V.rows(),
          "all vertices have colours, or none");
  require((mesh.colours.array() >= 0 && mesh.colours.array() <= 1).all(), "colours are within 0 .. 1");
}

inline bool is_indexed_triangle_mesh(const PolygonMesh& mesh) {
  for (int f = 0; f < mesh.face_count(); ++f) {
    if (mesh.face_degree(f) != 3) return false;
  }
  const auto is_vertex = [&](int index) { return index >= 0 && index < mesh.vertex_count(); };
  return std::all_of(mesh.corners.begin(), mesh.corners.end(), is_vertex);
}

/// Equal bit by bit, or both no numbers.
inline bool same_number(double a, double b) {
  return std::bit_cast<std::uint64_t>(a) == std::bit_cast<std::uint64_t>(b) ||
         (std::isnan(a) && std::isnan(b));
}

inline void check_same_mesh(const Mesh& a, const Mesh& b) {
  require(
      a.V.rows() == b.V.rows() && std::equal(a.V.data(), a.V.data() + a.V.size(), b.V.data(), same_number),
      "positions come back bit by bit");
  require(a.F.rows() == b.F.rows() && a.F == b.F, "faces come back in their order");
}

/// In single precision.
inline bool has_equal_corners(const Mesh& mesh, Eigen::Index f) {
  const auto corner = [&](int k) { return Eigen::RowVector3f(mesh.V.row(mesh.F(f, k)).cast<float>()); };
  return corner(0) == corner(1) || corner(1) == corner(2) || corner(2) == corner(0);
}

/// STL numbers the vertices anew and knows single precision only: what has to come back are the rounded
/// corners.
inline void check_same_corners(const Mesh& a, const Mesh& b) {
  Eigen::Index came_back = 0;
  for (Eigen::Index f = 0; f < a.F.rows(); ++f) {
    if (has_equal_corners(a, f)) continue;  // left out
    require(came_back < b.F.rows(), "faces come back");
    for (int corner = 0; corner < 3; ++corner) {
      for (int axis = 0; axis < 3; ++axis) {
        const auto x = static_cast<float>(a.V(a.F(f, corner), axis)),
                   y = static_cast<float>(b.V(b.F(came_back, corner), axis));
        require(x == y || (std::isnan(x) && std::isnan(y)), "corners come back in single precision");
      }
    }
    ++came_back;
  }
  require(came_back == b.F.rows(), "no other faces come back");
}

inline void check_ply_round_trip(std::string_view bytes) {
  const std::string once = serialize_ply(parse_ply(bytes));
  require(serialize_ply(parse_ply(once)) == once, "a PLY file comes back byte by byte");
}

inline bool keeps_single_precision(MeshFormat format) {
  constexpr MeshFormat formats[] = {MeshFormat::gifti, MeshFormat::freesurfer, MeshFormat::gltf,
                                    MeshFormat::glb};
  return std::find(std::begin(formats), std::end(formats), format) != std::end(formats);
}

inline void check_accepted(std::string_view bytes, MeshFormat format) {
  const PolygonMesh polygons = parse_mesh(bytes, format);
  check_faces(polygons);
  check_colours(polygons);
  if (!is_indexed_triangle_mesh(polygons)) return;
  Mesh mesh = to_triangle_mesh(polygons);
  if (keeps_single_precision(format)) mesh.V = mesh.V.cast<float>().cast<double>().eval();
  const Mesh again = to_triangle_mesh(parse_mesh(serialize_mesh(mesh, format), format));
  format == MeshFormat::stl ? check_same_corners(mesh, again) : check_same_mesh(mesh, again);
}

/// The check must succeed, or refuse the bytes by a MeshError that is fit to be shown.
template <class Check>
void check_or_refuse(Check check) {
  try {
    check();
  } catch (const MeshError& error) {
    check_message(error.what());
  }
}

inline bool same_value(double a, double b, VertexDataFormat format) {
  switch (format) {
    case VertexDataFormat::annot:
      return a == b || a == -1;
    case VertexDataFormat::label_gifti:
      return a == b;
    case VertexDataFormat::curv:
    case VertexDataFormat::shape_gifti:
    case VertexDataFormat::func_gifti:
      return same_number(static_cast<float>(a), static_cast<float>(b));
    default:
      return same_number(a, b);
  }
}

/// Values come back: in single precision from GIfTI and FreeSurfer's curv. Where no label was, an annotation
/// that has a black label may have that one.
inline void check_accepted_values(std::string_view bytes, VertexDataFormat format) {
  const VertexData data = parse_vertex_data(bytes, format);
  require(data.names.empty() || static_cast<Eigen::Index>(data.names.size()) == data.values.cols(),
          "all maps have names, or none");
  const VertexData again = parse_vertex_data(serialize_vertex_data(data, format), format);
  require(data.values.rows() == again.values.rows() && data.values.cols() == again.values.cols(),
          "as many values come back");
  if (format == VertexDataFormat::annot || format == VertexDataFormat::label_gifti)
    require(data.labels.size() == again.labels.size(), "labels come back");
  for (Eigen::Index k = 0; k < data.values.size(); ++k)
    require(same_value(data.values(k), again.values(k), format), "values come back");
}

/// As check_round_trip, of values at vertices.
inline void check_value_round_trip(std::string_view bytes, VertexDataFormat format) {
  check_or_refuse([&] { check_accepted_values(bytes, format); });
}

/// Throws std::logic_error, or whatever the readers throw by mistake, where a property is violated.
inline void check_round_trip(std::string_view bytes, MeshFormat format) {
  check_or_refuse([&] { check_accepted(bytes, format); });
  if (format == MeshFormat::ply) check_or_refuse([&] { check_ply_round_trip(bytes); });
}

}  // namespace orbitutte::fuzz
