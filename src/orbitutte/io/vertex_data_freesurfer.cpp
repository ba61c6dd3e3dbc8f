// SPDX-License-Identifier: MIT
// FreeSurfer's values at vertices (lh.thickness, lh.curv ...) and annotations (lh.aparc.annot), the highest
// byte of each number first. FreeSurfer has no document of them but its sources (utils/mrisurf_io.cpp,
// utils/colortab.cpp).
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <unordered_map>

#include "orbitutte/io/big_endian_bytes.h"
#include "orbitutte/io/text_scanner.h"
#include "orbitutte/io/vertex_data_formats.h"
#include "orbitutte/types.h"

namespace orbitutte {
namespace {

constexpr int new_curv = 0xFFFFFF;

// In single precision.
VertexData read_new_curv(BigEndianBytes& in) {
  const auto vertices = in.take<std::int32_t>("the number of vertices");
  in.take<std::int32_t>("the number of faces");
  const auto maps = in.take<std::int32_t>("the number of values at a vertex");
  if (maps != 1) in.refuse(fmt::format("each vertex has {} values in place of one", maps));
  in.require_room(vertices, "the number of vertices", sizeof(float));
  VertexData data;
  data.values.resize(vertices, 1);
  for (double& value : data.values.reshaped()) value = in.take<float>("a value");
  return data;
}

// In hundredths.
VertexData read_old_curv(BigEndianBytes& in, int vertices) {
  in.take_three_bytes("the number of faces");
  in.require_room(vertices, "the number of vertices", sizeof(std::int16_t));
  VertexData data;
  data.values.resize(vertices, 1);
  for (double& value : data.values.reshaped()) value = in.take<std::int16_t>("a value") / 100.0;
  return data;
}

void require_one_map(const VertexData& data, std::string_view format) {
  if (data.values.cols() != 1)
    throw MeshError(fmt::format(
        "{} files hold one map, but there are {}; write them one by one, or as .func.gii, .csv or .npy",
        format, data.values.cols()));
}

// What an annotation holds at the vertices of a label: its colour.
std::int32_t colour_code(const std::array<double, 4>& colour) {
  const auto byte = [&](int channel) {
    return static_cast<std::int32_t>(std::lround(255 * std::clamp(colour[channel], 0.0, 1.0)));
  };
  return byte(0) | byte(1) << 8 | byte(2) << 16;
}

// The alpha of what FreeSurfer calls t, which is 0 where nothing shines through.
double channel_of(std::int32_t value) { return std::clamp(value, 0, 255) / 255.0; }

std::vector<ValueLabel> read_colour_table(BigEndianBytes& in) {
  constexpr std::size_t least_entry = 6 * sizeof(std::int32_t);
  if (in.bytes_left() == 0 || in.take<std::int32_t>("the mark of a colour table") == 0)
    in.refuse("the annotation has no colour table, so that its labels have no names");
  const auto version = in.take<std::int32_t>("the version of the colour table");
  if (version != -2)
    in.refuse(fmt::format("the colour table has the version {}, but only 2 is read", -std::int64_t{version}));
  in.take<std::int32_t>("the largest index of the colour table");
  in.take_text("the colour table's file");
  const int count = in.take_count("the number of colours", least_entry);
  std::vector<ValueLabel> labels(static_cast<std::size_t>(count));
  for (ValueLabel& label : labels) {
    label.key = in.take<std::int32_t>("the index of a colour");
    label.name = in.take_text("a colour's name");
    for (int channel = 0; channel < 4; ++channel)
      label.colour[channel] = channel_of(in.take<std::int32_t>("a colour"));
    label.colour[3] = 1 - label.colour[3];
  }
  return labels;
}

std::unordered_map<std::int32_t, int> keys_of_colours(const std::vector<ValueLabel>& labels) {
  std::unordered_map<std::int32_t, int> keys;
  for (const ValueLabel& label : labels) keys.emplace(colour_code(label.colour), label.key);
  return keys;
}

// The labels' colours, by key. Throws MeshError if two labels have the same, or a key is no index.
std::unordered_map<int, std::int32_t> colours_of_keys(const std::vector<ValueLabel>& labels) {
  std::unordered_map<int, std::int32_t> colours;
  std::unordered_map<std::int32_t, const ValueLabel*> labels_of_colours;
  for (const ValueLabel& label : labels) {
    const std::int32_t code = colour_code(label.colour);
    const auto [other, is_new] = labels_of_colours.emplace(code, &label);
    if (!is_new)
      throw MeshError(
          fmt::format("the labels {} and {} have the same colour, by which alone .annot files tell labels "
                      "apart; change one, "
                      "or write .label.gii",
                      in_quotes(other->second->name), in_quotes(label.name)));
    if (label.key < 0 || !colours.emplace(label.key, code).second)
      throw MeshError(
          fmt::format("the label {} has the key {}, which is negative or another label's; write .label.gii",
                      in_quotes(label.name), label.key));
  }
  return colours;
}

void append_text(std::string& bytes, std::string_view text) {
  append_big_endian(bytes, static_cast<std::int32_t>(text.size() + 1));
  bytes += text;
  bytes += '\0';
}

void append_colour_table(std::string& bytes, const std::vector<ValueLabel>& labels) {
  int indices = 0;  // one more than the largest
  for (const ValueLabel& label : labels)
    indices = std::max(indices, label.key < std::numeric_limits<int>::max() ? label.key + 1 : label.key);
  for (const std::int32_t number : {1, -2, indices}) append_big_endian(bytes, number);
  append_text(bytes, "orbitutte");
  append_big_endian(bytes, static_cast<std::int32_t>(labels.size()));
  for (const ValueLabel& label : labels) {
    append_big_endian(bytes, static_cast<std::int32_t>(label.key));
    append_text(bytes, label.name.substr(0, label.name.find('\0')));
    const std::int32_t code = colour_code(label.colour);
    for (const int shift : {0, 8, 16})
      append_big_endian(bytes, static_cast<std::int32_t>(code >> shift & 255));
    append_big_endian(
        bytes, static_cast<std::int32_t>(std::lround(255 * (1 - std::clamp(label.colour[3], 0.0, 1.0)))));
  }
}

}  // namespace

VertexData read_curv(std::string_view bytes) {
  BigEndianBytes in(bytes);
  const int start = in.take_three_bytes("its first number");
  return start == new_curv ? read_new_curv(in) : read_old_curv(in, start);
}

std::string write_curv(const VertexData& data) {
  require_one_map(data, "FreeSurfer's");
  std::string bytes = "\xFF\xFF\xFF";
  bytes.reserve(15 + sizeof(float) * static_cast<std::size_t>(data.values.size()));
  constexpr std::int32_t unknown_faces = 0, maps = 1;
  for (const std::int32_t number : {static_cast<std::int32_t>(data.values.rows()), unknown_faces, maps})
    append_big_endian(bytes, number);
  for (const double value : data.values.reshaped()) append_big_endian(bytes, static_cast<float>(value));
  return bytes;
}

VertexData read_annot(std::string_view bytes) {
  constexpr std::size_t row_size = 2 * sizeof(std::int32_t);
  BigEndianBytes in(bytes);
  const int vertices = in.take_count("the number of vertices", row_size);
  std::vector<std::int32_t> codes(static_cast<std::size_t>(vertices), 0);
  for (int k = 0; k < vertices; ++k) {
    const auto vertex = in.take<std::int32_t>("a vertex");
    if (vertex < 0 || vertex >= vertices)
      in.refuse(fmt::format("row {} is of the vertex {}, but there are {}", k, vertex, vertices));
    codes[static_cast<std::size_t>(vertex)] = in.take<std::int32_t>("a label");
  }
  VertexData data;
  data.labels = read_colour_table(in);
  const std::unordered_map<std::int32_t, int> keys = keys_of_colours(data.labels);
  data.values.resize(vertices, 1);
  for (int v = 0; v < vertices; ++v) {
    const auto key = keys.find(codes[static_cast<std::size_t>(v)]);
    data.values(v, 0) = key == keys.end() ? -1 : key->second;
  }
  return data;
}

std::string write_annot(const VertexData& data) {
  require_one_map(data, ".annot");
  if (data.labels.empty())
    throw MeshError("the values have no table of labels, which .annot files need; write .shape.gii or .curv");
  const std::unordered_map<int, std::int32_t> colours = colours_of_keys(data.labels);
  std::string bytes;
  append_big_endian(bytes, static_cast<std::int32_t>(data.values.rows()));
  for (Eigen::Index v = 0; v < data.values.rows(); ++v) {
    const auto colour = colours.find(label_key(data, v, 0));
    append_big_endian(bytes, static_cast<std::int32_t>(v));
    append_big_endian(bytes, colour == colours.end() ? std::int32_t{0} : colour->second);
  }
  append_colour_table(bytes, data.labels);
  return bytes;
}

}  // namespace orbitutte
