// SPDX-License-Identifier: MIT
#include "map_products.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <set>
#include <string_view>
#include <system_error>
#include <utility>

#include "orbitutte/export/carried_files.h"
#include "orbitutte/export/map_files.h"
#include "orbitutte/export/overlay_pieces.h"
#include "orbitutte/export/texture_bake.h"
#include "orbitutte/io/curve_file.h"
#include "orbitutte/io/file.h"
#include "orbitutte/io/texture_file.h"
#include "orbitutte/page/map_page.h"

namespace orbitutte::cli {
namespace {

namespace fs = std::filesystem;

const std::vector<std::string> morph_endings = {".obj", ".off", ".ply", ".stl", ".vtk"};

// "values_on_a.shape.gii" for a file of that kind; nothing for no file.
std::string on_a(const std::string& what, const std::string& path) {
  return path.empty() ? "" : what + "_on_a" + vertex_data_ending(path);
}

// An option that reads a file, and what is written into the folder for it.
struct CarryingOption {
  std::string name, path, content;
  std::vector<std::string> files;
};

std::vector<CarryingOption> carrying_options(const MapArguments& arguments) {
  std::vector<CarryingOption> given;
  for (CarryingOption& option : std::vector<CarryingOption>{
           {"--texture",
            arguments.texture,
            "the texture of B",
            {"texture.png", "textured_a.obj", "textured_a.mtl"}},
           {"--values", arguments.values, "the values of B", {on_a("values", arguments.values)}},
           {"--labels", arguments.labels, "the labels of B", {on_a("labels", arguments.labels)}},
           {"--curves", arguments.curves, "the curves of B", {"curves_on_a.obj"}}})
    if (!option.path.empty()) given.push_back(std::move(option));
  return given;
}

bool is_glb(const std::string& path) { return ending_of(path) == ".glb"; }

// The values at the vertices of B that an option names; none if there is no file.
VertexData values_of_b(const std::string& option, const std::string& path, const Surface& b) {
  if (path.empty()) return {};
  VertexData data = read_vertex_data(path);
  if (data.values.rows() != b.V.rows())
    throw MeshError(fmt::format("{} has {} rows, but B has {} vertices; it needs one for each", option,
                                data.values.rows(), b.V.rows()));
  return data;
}

// Throws MeshError naming a label that is no whole number.
void require_labels(const VertexData& data) {
  const Eigen::MatrixXd rounded = data.values.array().round();
  for (Eigen::Index v = 0; v < rounded.rows(); ++v)
    for (Eigen::Index map = 0; map < rounded.cols(); ++map)
      if (!(data.values(v, map) == rounded(v, map)))
        throw MeshError(
            fmt::format("--labels has {} at vertex {}; labels are whole numbers, --values takes others",
                        data.values(v, map), v));
}

std::pair<int, int> ascending(int v, int w) { return {std::min(v, w), std::max(v, w)}; }

// Two vertices that follow each other must share a triangle.
void require_curves_on(const Surface& b, const std::vector<std::vector<int>>& curves) {
  std::set<std::pair<int, int>> edges;
  for (int t = 0; t < b.triangle_count(); ++t)
    for (int k = 0; k < 3; ++k) edges.insert(ascending(b.triangles(t, k), b.triangles(t, (k + 1) % 3)));
  for (std::size_t c = 0; c < curves.size(); ++c)
    for (std::size_t k = 1; k < curves[c].size(); ++k)
      if (!edges.contains(ascending(curves[c][k - 1], curves[c][k])))
        throw MeshError(
            fmt::format("--curves: curve {}, counted from 0, goes from vertex {} to vertex {} of B, "
                        "which share no triangle",
                        c, curves[c][k - 1], curves[c][k]));
}

TextureLayout layout_of_b(const std::string& path) {
  std::optional<TextureLayout> layout = read_texture_layout(path);
  if (!layout)
    throw MeshError(fmt::format(
        "{}: B has no texture coordinates, which --texture needs; use an OBJ with 'vt' lines{}", path,
        ending_of(path) == ".glb" || ending_of(path) == ".gltf" ? " (those of glTF are not read)" : ""));
  return std::move(*layout);
}

// All of a text as a number of pixels; 0 if it is none.
int pixels_in(std::string_view text) {
  int pixels = 0;
  const auto [stop, error] = std::from_chars(text.data(), text.data() + text.size(), pixels);
  return error == std::errc() && stop == text.data() + text.size() ? pixels : 0;
}

// "1024" or "1024x512".
TextureSize parse_texture_size(std::string_view text) {
  const std::size_t cross = text.find('x');
  const std::string_view width = text.substr(0, cross),
                         height = cross == text.npos ? width : text.substr(cross + 1);
  const TextureSize size = {pixels_in(width), pixels_in(height)};
  if (size.width > 0 && size.height > 0) return size;
  throw ArgumentError(fmt::format("--texture-size is '{}'; give pixels, as in 2048 or 2048x1024", text));
}

// That of B's picture; of a new chart, which is a square, its longer side.
TextureSize texture_size(const MapArguments& arguments, const CarriedInputs& carried) {
  if (!arguments.texture_size.empty()) return parse_texture_size(arguments.texture_size);
  if (carried.layout_of_a) return {carried.texture->width, carried.texture->height};
  const int side = std::max(carried.texture->width, carried.texture->height);
  return {side, side};
}

// Paths and bytes, so that nothing is written if something cannot be made.
using ProductBytes = std::vector<std::pair<std::string, std::string>>;

void add_texture(const MapArguments& arguments, const CarriedInputs& carried, const MappedSurfaces& mapped,
                 const fs::path& folder, ProductBytes& products) {
  const TextureLayout layout =
      carried.layout_of_a ? *carried.layout_of_a : new_texture_layout(mapped.map.a.embedding);
  const PixelImage baked = bake_texture(mapped.composed.overlay, {mapped.a, mapped.map.a.embedding, layout},
                                        {mapped.b, mapped.map.b.embedding, *carried.layout_of_b},
                                        *carried.texture, texture_size(arguments, carried));
  products.emplace_back((folder / "texture.png").string(), png_bytes(baked));
  products.emplace_back((folder / "textured_a.mtl").string(), textured_material("texture.png"));
  products.emplace_back((folder / "textured_a.obj").string(),
                        textured_obj(mapped.a, layout, "textured_a.mtl"));
}

std::string carried_curves(const std::vector<std::vector<int>>& curves, const MappedSurfaces& mapped) {
  const Embedding &a = mapped.map.a.embedding, &b = mapped.map.b.embedding;
  std::vector<Points> images;
  images.reserve(curves.size());
  for (const std::vector<int>& curve : curves)
    images.push_back(positions_on(mapped.a.V, a, image_of_polyline(b, a, points_at_vertices(b, curve))));
  return curves_obj(images);
}

VertexData carried_labels(const VertexMap& a_to_b, VertexData data) {
  Eigen::MatrixXd on_a(a_to_b.count(), data.values.cols());
  for (Eigen::Index map = 0; map < on_a.cols(); ++map) {
    const Eigen::VectorXi column = data.values.col(map).cast<int>();
    const std::vector<int> labels = transfer_labels(a_to_b, {column.begin(), column.end()});
    for (Eigen::Index v = 0; v < on_a.rows(); ++v) on_a(v, map) = labels[v];
  }
  data.values = on_a;
  return data;
}

// Values as on B's triangles; labels, which cannot be added, as at the nearest corner.
VertexData carried_values(const VertexMap& a_to_b, VertexData data) {
  if (data.labels.empty()) {
    data.values = transfer(a_to_b, data.values);
    data.is_whole = false;
    return data;
  }
  return carried_labels(a_to_b, std::move(data));
}

void add_carried(const MapArguments& arguments, const CarriedInputs& carried, const MappedSurfaces& mapped,
                 const fs::path& folder, ProductBytes& products) {
  const VertexMap& a_to_b = mapped.composed.a_to_b;
  if (!arguments.values.empty())
    products.emplace_back(
        (folder / on_a("values", arguments.values)).string(),
        serialize_vertex_data(carried_values(a_to_b, carried.values), vertex_data_format(arguments.values)));
  if (!arguments.labels.empty())
    products.emplace_back(
        (folder / on_a("labels", arguments.labels)).string(),
        serialize_vertex_data(carried_labels(a_to_b, carried.labels), vertex_data_format(arguments.labels)));
  if (!carried.curves.empty())
    products.emplace_back((folder / "curves_on_a.obj").string(), carried_curves(carried.curves, mapped));
}

// Vertices that no face uses are grey.
Points colours_on_a(const MappedSurfaces& mapped) {
  const Eigen::MatrixXd colours = transfer(mapped.composed.a_to_b, shown_colours(mapped.b));
  return colours.unaryExpr([](double channel) { return std::isnan(channel) ? 0.5 : channel; });
}

std::string file_name(const std::string& path) { return fs::path(path).filename().string(); }

std::string page_of(const MapArguments& arguments, const MappedSurfaces& mapped) {
  return map_page(
      {mapped.a, mapped.b, mapped.map, mapped.composed, file_name(arguments.a), file_name(arguments.b)});
}

void write_morph_as_asked(const MapArguments& arguments, const MappedSurfaces& mapped) {
  const ComposedMap& composed = mapped.composed;
  const Morph morph = morph_of(composed.overlay, composed.overlay_on_a, composed.overlay_on_b);
  if (is_glb(arguments.morph)) return write_morph(arguments.morph, morph);
  write_morph_frames(arguments.morph, morph, arguments.frames);
}

}  // namespace

CarriedInputs::CarriedInputs(const MapArguments& arguments, const Surface& a, const Surface& b) {
  if (!arguments.texture.empty()) {
    layout_of_b = cli::layout_of_b(arguments.b);
    texture_triangles(b, *layout_of_b);
    if (!arguments.new_chart) layout_of_a = read_texture_layout(arguments.a);
    if (layout_of_a) texture_triangles(a, *layout_of_a);
    texture = read_image(arguments.texture);
  }
  values = values_of_b("--values", arguments.values, b);
  labels = values_of_b("--labels", arguments.labels, b);
  require_labels(labels);
  if (!arguments.curves.empty()) {
    curves = read_curves(arguments.curves);
    require_curves_on(b, curves);
  }
}

std::vector<OutputFile> files_of_products(const MapArguments& arguments, const std::string& folder) {
  std::vector<OutputFile> files;
  files.reserve(16 + static_cast<std::size_t>(arguments.frames));
  for (const CarryingOption& option : carrying_options(arguments))
    for (const std::string& name : option.files)
      files.push_back({option.name, option.content, (fs::path(folder) / name).string(), {ending_of(name)}});
  if (arguments.frames != 0)
    for (const std::string& path : frame_paths(arguments.morph, arguments.frames))
      files.push_back({"--morph", "the morph", path, morph_endings});
  if (!arguments.picture.empty()) files.push_back({"--picture", "the picture", arguments.picture, {".png"}});
  if (!arguments.page.empty()) files.push_back({"--page", "the page", arguments.page, {".html", ".htm"}});
  if (!arguments.colours.empty())
    files.push_back({"--colours", "the mesh with colours", arguments.colours, {".ply", ".obj"}});
  if (arguments.frames == 0 && !arguments.morph.empty())
    files.push_back({"--morph", "the morph", arguments.morph, {".glb"}});
  return files;
}

std::vector<InputFile> inputs_of_products(const MapArguments& arguments) {
  const std::vector<CarryingOption> carrying = carrying_options(arguments);
  std::vector<InputFile> files;
  files.reserve(carrying.size());
  for (const CarryingOption& option : carrying) files.push_back({option.content, option.path});
  return files;
}

bool wants_products(const MapArguments& arguments) {
  return !carrying_options(arguments).empty() || !arguments.picture.empty() || !arguments.page.empty() ||
         !arguments.colours.empty() || !arguments.morph.empty();
}

void require_sound_products(const MapArguments& arguments) {
  const std::vector<CarryingOption> carrying = carrying_options(arguments);
  if (!carrying.empty() && arguments.output.empty() && arguments.from.empty())
    throw ArgumentError(
        fmt::format("{} writes into the folder of -o, and none was given", carrying.front().name));
  if (arguments.texture.empty() && (arguments.new_chart || !arguments.texture_size.empty()))
    throw ArgumentError(fmt::format("{} belongs to --texture, which was not given",
                                    arguments.new_chart ? "--new-chart" : "--texture-size"));
  if (!arguments.texture_size.empty()) require_texture_size(parse_texture_size(arguments.texture_size));
  if (arguments.frames == 0 && !arguments.morph.empty() && !is_glb(arguments.morph))
    throw ArgumentError(
        "--morph writes one .glb, or else --frames says how many meshes; give it, or change the ending");
  if (arguments.frames != 0 && (arguments.morph.empty() || is_glb(arguments.morph)))
    throw ArgumentError("--frames belongs to --morph with the name of a mesh, such as --morph frame.ply");
  if (arguments.frames != 0) frame_paths(arguments.morph, arguments.frames);
  if (!arguments.picture.empty()) require_pictures(arguments.view, arguments.up);
  if (arguments.picture.empty() && !(arguments.view.empty() && arguments.up.empty()))
    throw ArgumentError("--view and --up belong to --picture, which was not given");
}

void write_products(const MapArguments& arguments, const std::string& folder, const CarriedInputs& carried,
                    const MappedSurfaces& mapped) {
  ProductBytes products;
  if (carried.texture) add_texture(arguments, carried, mapped, folder, products);
  add_carried(arguments, carried, mapped, folder, products);
  if (!arguments.colours.empty())
    products.emplace_back(arguments.colours,
                          coloured_mesh(arguments.colours, mapped.a, colours_on_a(mapped)));
  if (!arguments.page.empty()) products.emplace_back(arguments.page, page_of(arguments, mapped));
  if (!arguments.picture.empty()) products.emplace_back(arguments.picture, map_picture(arguments, mapped));
  for (const auto& [path, bytes] : products) write_file(path, bytes);
  if (!arguments.morph.empty()) write_morph_as_asked(arguments, mapped);
}

}  // namespace orbitutte::cli
