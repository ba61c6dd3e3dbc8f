// SPDX-License-Identifier: MIT
#include "orbitutte/io/vertex_data.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <iterator>
#include <optional>

#include "orbitutte/io/compression.h"
#include "orbitutte/io/file.h"
#include "orbitutte/io/file_ending.h"
#include "orbitutte/io/vertex_data_formats.h"
#include "orbitutte/types.h"

namespace orbitutte {
namespace {

struct VertexDataRow {
  VertexDataFormat format;
  // Separated by blanks.
  std::string_view endings;
  VertexData (*read)(std::string_view);
  std::string (*write)(const VertexData&);
};

// A file has the format of the first row one of whose endings its name has.
constexpr VertexDataRow vertex_data_formats[] = {
    {VertexDataFormat::label_gifti, ".label.gii", read_gifti_data, write_label_gifti},
    {VertexDataFormat::func_gifti, ".func.gii", read_gifti_data, write_func_gifti},
    {VertexDataFormat::shape_gifti, ".shape.gii .gii", read_gifti_data, write_shape_gifti},
    {VertexDataFormat::curv, ".curv .thickness .sulc .area .volume .avg_curv .jacobian_white", read_curv,
     write_curv},
    {VertexDataFormat::annot, ".annot", read_annot, write_annot},
    {VertexDataFormat::csv, ".csv", read_text_data, write_csv},
    {VertexDataFormat::text, ".txt", read_text_data, write_text_data},
    {VertexDataFormat::npy, ".npy", read_npy, write_npy}};

const VertexDataRow& row_of(VertexDataFormat format) {
  return *std::find_if(std::begin(vertex_data_formats), std::end(vertex_data_formats),
                       [format](const VertexDataRow& known) { return known.format == format; });
}

// A row, and the one of its endings that a name has.
struct NamedFormat {
  VertexDataFormat format;
  std::string_view ending;
};

std::optional<NamedFormat> format_of_path(const std::string& path) {
  const std::string name = lower_case(std::filesystem::path(without_gz(path)).filename().string());
  for (const VertexDataRow& known : vertex_data_formats) {
    std::string_view endings = known.endings;
    while (!endings.empty()) {
      const std::size_t end = std::min(endings.find(' '), endings.size());
      if (name.ends_with(endings.substr(0, end))) return NamedFormat{known.format, endings.substr(0, end)};
      endings.remove_prefix(std::min(end + 1, endings.size()));
    }
  }
  return std::nullopt;
}

// The same; throws ArgumentError if there is none.
NamedFormat known_format(const std::string& path) {
  if (const std::optional<NamedFormat> found = format_of_path(path)) return *found;
  std::string endings;
  for (const VertexDataRow& known : vertex_data_formats)
    fmt::format_to(std::back_inserter(endings), "{} ", known.endings);
  endings.pop_back();
  throw ArgumentError(fmt::format(
      "{}: the ending names no known format of values at vertices; use one of {}, each also with .gz", path,
      endings));
}

// Throws MeshError if the names are not one for each map.
void require_consistent(const VertexData& data) {
  if (!data.names.empty() && static_cast<Eigen::Index>(data.names.size()) != data.values.cols())
    throw MeshError(fmt::format("there are {} names for {} maps; give each map one name, or none a name",
                                data.names.size(), data.values.cols()));
}

}  // namespace

VertexDataFormat vertex_data_format(const std::string& path) { return known_format(path).format; }

std::string vertex_data_ending(const std::string& path) { return std::string(known_format(path).ending); }

bool is_vertex_data_path(const std::string& path) { return format_of_path(path).has_value(); }

VertexData parse_vertex_data(std::string_view bytes, VertexDataFormat format) {
  if (bytes.empty()) throw MeshError("the file is empty; export it again");
  return row_of(format).read(bytes);
}

std::string serialize_vertex_data(const VertexData& data, VertexDataFormat format) {
  require_consistent(data);
  return row_of(format).write(data);
}

VertexData read_vertex_data(const std::string& path) {
  const VertexDataFormat format = vertex_data_format(path);
  const std::string bytes = read_file(path);
  return naming_file(
      path, [&] { return parse_vertex_data(is_compressed(path) ? decompress(bytes) : bytes, format); });
}

void write_vertex_data(const std::string& path, const VertexData& data) {
  const VertexDataFormat format = vertex_data_format(path);
  write_compressed_as_named(path, naming_file(path, [&] { return serialize_vertex_data(data, format); }));
}

int label_key(const VertexData& data, Eigen::Index vertex, Eigen::Index map) {
  const double value = data.values(vertex, map);
  if (!(value >= -2147483648.0 && value <= 2147483647.0) || value != std::floor(value))
    throw MeshError(fmt::format(
        "map {} has the value {} at vertex {}, which is no whole number, as labels are; write measures as "
        ".shape.gii",
        map, value, vertex));
  return static_cast<int>(value);
}

void set_map_names(VertexData& data, std::vector<std::string> names) {
  if (std::all_of(names.begin(), names.end(), [](const std::string& name) { return name.empty(); }))
    names.clear();
  data.names = std::move(names);
}

}  // namespace orbitutte
