// SPDX-License-Identifier: MIT
#include "command_arguments.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <numbers>

#include "orbitutte/choose.h"
#include "orbitutte/export/cut_triangles.h"
#include "orbitutte/inspect/mesh_repair.h"
#include "orbitutte/inspect/recognition.h"

namespace orbitutte::cli {
namespace {

const std::string best_word = "best";

// Radians, or a multiple of pi.
std::optional<double> parse_angle(const std::string& text) {
  const bool is_multiple = text.ends_with("pi");
  const std::string number = is_multiple ? text.substr(0, text.size() - 2) : text;
  const double unit = is_multiple ? std::numbers::pi : 1;
  if (is_multiple && number.empty()) return unit;
  double value = 0;
  const auto [stop, error] = std::from_chars(number.data(), number.data() + number.size(), value);
  if (error != std::errc() || stop != number.data() + number.size() || !std::isfinite(value))
    return std::nullopt;
  return value * unit;
}

// A target without marks leaves nothing to choose.
void leave_unmarked(Wish& wish) {
  if (!wish.cones.empty())
    throw ArgumentError(
        fmt::format("leave out --cones: {} marks no vertex; --points puts vertices at given points",
                    wish.target->signature));
  wish.word = ConesWord::none;
}

}  // namespace

std::vector<int> parse_cones(const std::string& text) {
  std::vector<int> cones;
  for (std::size_t from = 0; from <= text.size();) {
    const std::size_t end = std::min(text.find(',', from), text.size());
    int vertex = best_vertex;
    const auto [stop, error] = std::from_chars(text.data() + from, text.data() + end, vertex);
    const bool is_vertex = error == std::errc() && stop == text.data() + end && vertex >= 0;
    if (!is_vertex && text.substr(from, end - from) != best_word)
      throw ArgumentError(fmt::format(
          "--cones is '{}'; give vertices separated by commas, as in 12,40,7, 'best' in place of those that "
          "the program chooses, or 'extremities'",
          text));
    cones.push_back(is_vertex ? vertex : best_vertex);
    from = end + 1;
  }
  return cones;
}

std::vector<double> parse_angles(const std::string& text) {
  std::vector<double> angles;
  for (std::size_t from = 0; from <= text.size();) {
    const std::size_t end = std::min(text.find(',', from), text.size());
    const std::optional<double> angle = parse_angle(text.substr(from, end - from));
    if (!angle)
      throw ArgumentError(fmt::format(
          "--angles is '{}'; give radians or multiples of pi, separated by commas, as in 3.1,1.6pi,pi",
          text));
    angles.push_back(*angle);
    from = end + 1;
  }
  return angles;
}

ConesWord cones_word(const std::string& text) {
  if (text.empty() || text == best_word || text == "auto") return ConesWord::best;
  return text == "extremities" ? ConesWord::extremities : ConesWord::none;
}

bool Wish::is_choice() const {
  return !target || word == ConesWord::best ||
         std::find(cones.begin(), cones.end(), best_vertex) != cones.end();
}

Wish parse_wish(const std::string& orbifold, const std::string& cones) {
  Wish wish;
  if (!orbifold.empty() && orbifold != best_word) wish.target = parse_orbifold(orbifold);
  wish.word = cones_word(cones);
  if (wish.word == ConesWord::none) wish.cones = parse_cones(cones);
  if (wish.target && wish.target->marks.empty()) leave_unmarked(wish);
  return wish;
}

void mark_extremities(const Surface& surface, Wish& wish) {
  if (wish.word != ConesWord::extremities) return;
  wish.cones = choose_cones(surface, wish.target ? *wish.target : standard_target(surface.topology));
  wish.word = ConesWord::none;
}

MeshInput mesh_input(const std::string& path, const std::string& format) {
  MeshInput input = {path};
  if (!format.empty()) input.format = parse_choice<MeshFormat>(format, "--format");
  return input;
}

Surface read_embedded(const MeshInput& input, const Report& report) {
  PolygonMesh mesh = read_mesh(input);
  return make_surface(report.is_repaired ? repair_in_place(mesh).mesh : std::move(mesh));
}

Surface read_source(const MeshInput& input, const Report& report, Embedding& embedding) {
  Surface surface = read_embedded(input, report);
  if (embedding.polygons.start == surface.polygons.start)
    embedding.triangles = cut_triangles(surface, embedding);
  return surface;
}

void write_as_asked(const std::string& path, const VertexData& data) {
  try {
    write_vertex_data(path, data);
  } catch (const MeshError& error) {
    throw ArgumentError(error.what());
  }
}

}  // namespace orbitutte::cli
