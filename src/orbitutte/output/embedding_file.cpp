// SPDX-License-Identifier: MIT
#include "orbitutte/output/embedding_file.h"

#include <fmt/format.h>

#include <cmath>

#include "orbitutte/mesh/file.h"
#include "orbitutte/mesh/ply.h"

namespace orbitutte {
namespace {

PlyProperty column(std::string name, PlyType type, std::vector<double> values) {
  PlyProperty property;
  property.name = std::move(name);
  property.type = type;
  property.values = std::move(values);
  return property;
}

const PlyProperty& require(const PlyElement& element, const char* property, bool is_list) {
  const PlyProperty* found = element.find(property);
  if (!found || found->is_list != is_list)
    throw MeshError(
        fmt::format("the element '{}' has no {} property '{}'; is this an embedding written by orbitutte?",
                    element.name, is_list ? "list" : "scalar", property));
  return *found;
}

const PlyElement& require(const PlyFile& file, const char* element) {
  const PlyElement* found = file.find(element);
  if (!found)
    throw MeshError(
        fmt::format("there is no element '{}'; is this an embedding written by orbitutte?", element));
  return *found;
}

int to_index(double value, std::size_t limit, const char* what, std::size_t of) {
  if (!(value >= 0) || value >= static_cast<double>(limit) || value != std::floor(value))
    throw MeshError(fmt::format("{} {} names the vertex {}; there are {}", what, of, value, limit));
  return static_cast<int>(value);
}

Embedding to_embedding(const PlyFile& file) {
  const PlyElement &vertex = require(file, "vertex"), &face = require(file, "face");
  Embedding embedding;
  embedding.positions.resize(static_cast<Eigen::Index>(vertex.count), 3);
  for (int k = 0; k < 3; ++k) {
    const std::vector<double>& values = require(vertex, k == 0 ? "x" : k == 1 ? "y" : "z", false).values;
    for (std::size_t v = 0; v < vertex.count; ++v)
      embedding.positions(static_cast<Eigen::Index>(v), k) = values[v];
  }
  const std::vector<double>& source = require(vertex, "source_vertex", false).values;
  for (std::size_t v = 0; v < vertex.count; ++v)
    embedding.source_vertex.push_back(to_index(source[v], vertex.count, "the source of cut vertex", v));
  const PlyProperty& corners = require(face, "vertex_indices", true);
  embedding.faces.resize(static_cast<Eigen::Index>(face.count), 3);
  for (std::size_t f = 0; f < face.count; ++f) {
    if (corners.list_start[f + 1] - corners.list_start[f] != 3)
      throw MeshError(fmt::format("face {} is no triangle", f));
    for (std::size_t k = 0; k < 3; ++k)
      embedding.faces(static_cast<Eigen::Index>(f), static_cast<Eigen::Index>(k)) =
          to_index(corners.values[3 * f + k], vertex.count, "face", f);
  }
  return embedding;
}

}  // namespace

std::string serialize_embedding(const Embedding& embedding) {
  PlyFile file;
  file.comments = {fmt::format("orbitutte embedding {}", embedding.signature)};
  PlyElement vertex = {"vertex", static_cast<std::size_t>(embedding.positions.rows()), {}};
  for (int k = 0; k < 3; ++k) {
    const Eigen::VectorXd values = embedding.positions.col(k);
    vertex.properties.push_back(
        column(std::string(1, static_cast<char>('x' + k)), PlyType::float64, {values.begin(), values.end()}));
  }
  vertex.properties.push_back(column("source_vertex", PlyType::int32,
                                     {embedding.source_vertex.begin(), embedding.source_vertex.end()}));
  PlyElement face = {"face", static_cast<std::size_t>(embedding.faces.rows()), {}};
  const auto corners = embedding.faces.reshaped<Eigen::RowMajor>();
  PlyProperty lists = column("vertex_indices", PlyType::int32, {corners.begin(), corners.end()});
  lists.is_list = true;
  for (std::size_t f = 0; f <= face.count; ++f) lists.list_start.push_back(3 * f);
  face.properties.push_back(std::move(lists));
  file.elements = {std::move(vertex), std::move(face)};
  return serialize_ply(file);
}

Embedding read_embedding(const std::string& path) {
  const std::string bytes = read_file(path);
  try {
    return to_embedding(parse_ply(bytes));
  } catch (const MeshError& error) {
    throw MeshError(fmt::format("{}: {}", path, error.what()));
  }
}

}  // namespace orbitutte
