// SPDX-License-Identifier: MIT
// A glTF 2.0 model of one mesh in one buffer (Khronos Group, 2021), written as GLB. Private to export/.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "orbitutte/export/palette.h"
#include "orbitutte/types.h"

namespace orbitutte {

/// What add_... returns are numbers of accessors, to be named in primitives. Numbers are stored in single
/// precision.
class GltfModel {
 public:
  GltfModel();
  ~GltfModel();

  /// POSITION, with the bounds that glTF asks for. V: n x 3.
  int add_positions(const Points& V);

  /// NORMAL and other vectors. N: n x 3.
  int add_vectors(const Points& N);

  /// TEXCOORD_0, from the lower left corner as everywhere else here; glTF counts from the upper left.
  /// coordinates: n x 2.
  int add_texture_coordinates(const Eigen::MatrixX2d& coordinates);

  /// COLOR_0, of sRGB colours.
  int add_colours(const std::vector<Rgb>& colours);

  /// Indices, three a triangle.
  int add_triangles(const std::vector<std::uint32_t>& indices);

  /// The number of a matt material of an sRGB colour; double_sided of both orientations.
  enum class Sides { front, both };
  int add_material(const std::string& name, const Rgb& colour, Sides sides);

  /// Triangles of vertices with attributes such as {"POSITION", accessor}.
  void add_primitive(const std::map<std::string, int>& attributes, int indices, int material);

  /// The GLB file.
  std::string bytes() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// sRGB, 0 .. 255, to the linear scale 0 .. 1 that glTF's colours are on.
double linear_channel(std::uint8_t channel);

/// Throws ArgumentError where so many bytes of vertices and indices do not fit into a GLB, whose lengths are
/// 32-bit numbers; `what` is named.
void check_glb_size(std::size_t bytes, const std::string& what);

}  // namespace orbitutte
