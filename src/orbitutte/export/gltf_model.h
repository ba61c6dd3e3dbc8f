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

/// The add_... functions return accessor numbers for use in primitives. Numbers are stored in single
/// precision.
class GltfModel {
 public:
  GltfModel();
  ~GltfModel();

  /// POSITION, with the bounds that glTF requires. V: n x 3.
  int add_positions(const Points& V);

  /// NORMAL and other vectors. N: n x 3.
  int add_vectors(const Points& N);

  /// TEXCOORD_0, counted from the lower left corner as everywhere else here, although glTF counts from the
  /// upper left. coordinates: n x 2.
  int add_texture_coordinates(const Eigen::MatrixX2d& coordinates);

  /// COLOR_0, from sRGB colours.
  int add_colours(const std::vector<Rgb>& colours);

  /// Indices, three per triangle.
  int add_triangles(const std::vector<std::uint32_t>& indices);

  /// Returns the number of a matt material with an sRGB colour. Sides::both makes it visible from both sides.
  enum class Sides { front, both };
  int add_material(const std::string& name, const Rgb& colour, Sides sides);

  /// Triangles whose vertices have attributes such as {"POSITION", accessor}.
  void add_primitive(const std::map<std::string, int>& attributes, int indices, int material);

  /// Adds a morph target to the last primitive: attributes such as {"POSITION", accessor of displacements}.
  void add_morph_target(const std::map<std::string, int>& displacements);

  /// Lets the weight of the only morph target follow these values at these times (seconds, ascending), linear
  /// in between.
  void animate_morph(const std::vector<float>& times, const std::vector<float>& weights);

  /// The GLB file.
  std::string bytes() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// Converts sRGB, 0 .. 255, to the linear scale 0 .. 1 of glTF's colours.
double linear_channel(std::uint8_t channel);

/// Throws an ArgumentError that names `what` if so many bytes of vertices and indices do not fit into a GLB,
/// whose lengths are 32-bit numbers.
void check_glb_size(std::size_t bytes, const std::string& what);

}  // namespace orbitutte
