// SPDX-License-Identifier: MIT
// Maps between two surfaces.
#include "orbitutte/map/surface_map.h"

#include <pybind11/stl.h>

#include <cstdint>
#include <cstring>
#include <optional>

#include "arrays.h"
#include "held_embedding.h"
#include "orbitutte/export/map_files.h"
#include "orbitutte/export/texture_bake.h"
#include "orbitutte/io/texture_file.h"
#include "orbitutte/map/overlay_certificate.h"
#include "progress_hook.h"

namespace orbitutte::python {
namespace {

using Mesh = std::shared_ptr<SourceMesh>;
using HeldOverlay = std::shared_ptr<Overlay>;

// k x 2: vertices of A and of B.
std::vector<Landmark> to_landmarks(const IntArray& array) {
  const std::vector<int> values = to_vector(array);
  std::vector<Landmark> result;
  for (std::size_t k = 1; k < values.size(); k += 2) result.push_back({values[k - 1], values[k]});
  return result;
}

MapOptions map_options(const EmbedOptions& embed, const std::string& tile,
                       const std::pair<std::uint64_t, std::uint64_t>& cut_seeds) {
  MapOptions options;
  options.embed = embed;
  options.tile = parse_choice<TileShape>(tile, "tile");
  options.cut_a.seed = cut_seeds.first;
  options.cut_b.seed = cut_seeds.second;
  return options;
}

// (embedding of A, embedding of B, warnings)
py::tuple map_two(const std::pair<Mesh, Mesh>& meshes, const IntArray& landmarks, MapOptions options,
                  py::object listener) {
  const std::vector<Landmark> pairs = to_landmarks(landmarks);
  const Clock::time_point start = Clock::now();
  SurfaceMap map = with_listener(options.embed, std::move(listener), [&](const EmbedOptions& heard) {
    options.embed = heard;
    return map_between(*meshes.first->surface(), *meshes.second->surface(), pairs, options);
  });
  const double seconds = seconds_since(start);
  return py::make_tuple(hold(std::move(map.a), meshes.first, seconds),
                        hold(std::move(map.b), meshes.second, seconds), map.warnings);
}

// (triangle, barycentric, corners) of the vertices of one surface on the other.
py::tuple vertices_on(const HeldEmbedding& from, const HeldEmbedding& to) {
  VertexMap map;
  {
    const py::gil_scoped_release release;
    map = images_of_vertices(from.embedding, to.embedding);
  }
  return py::make_tuple(take(std::move(map.images.triangle)), take(std::move(map.images.barycentric)),
                        take(std::move(map.corners)));
}

// (triangle, barycentric)
py::tuple points_on(const HeldEmbedding& from, const HeldEmbedding& to, const IntArray& triangle,
                    const DoubleArray& barycentric) {
  const SurfacePoints points = {to_vector(triangle), to_points(barycentric), {}};
  SurfacePoints images;
  {
    const py::gil_scoped_release release;
    images = images_of_points(from.embedding, to.embedding, points);
  }
  return py::make_tuple(take(std::move(images.triangle)), take(std::move(images.barycentric)));
}

HeldOverlay overlay_of(const HeldEmbedding& a, const HeldEmbedding& b) {
  const py::gil_scoped_release release;
  return std::make_shared<Overlay>(overlay(a.embedding, b.embedding));
}

py::array points_of(const Points& V, const HeldEmbedding& held, const SurfacePoints& points) {
  return take(positions_on(V, held.embedding, points));
}

// n x 2: the triangles of A and of B.
py::tuple parents(const Overlay& overlay) {
  std::vector<int> a, b;
  for (const OverlayFace& face : overlay.parents) a.push_back(face.a), b.push_back(face.b);
  return py::make_tuple(take(std::move(a)), take(std::move(b)));
}

// The name and the sentence of every check that failed.
py::list failed_checks(const Overlay& overlay, const HeldEmbedding& a, const HeldEmbedding& b) {
  OverlayCertificate certificate;
  {
    const py::gil_scoped_release release;
    certificate = certify(overlay, a.embedding, b.embedding);
  }
  py::list result;
  for (const Check& check : certificate.checks)
    if (!check.passed) result.append(py::make_tuple(check.name, check.detail));
  return result;
}

using ByteArray = py::array_t<std::uint8_t, py::array::c_style>;

// height x width x 4.
PixelImage to_image(const ByteArray& array) {
  PixelImage image = {static_cast<int>(array.shape(1)), static_cast<int>(array.shape(0)), {}};
  image.pixels.resize(static_cast<std::size_t>(image.width) * image.height);
  std::memcpy(image.pixels.data(), array.data(), sizeof(Pixel) * image.pixels.size());
  return image;
}

py::array to_array(const PixelImage& image) {
  ByteArray array({image.height, image.width, 4});
  std::memcpy(array.mutable_data(), image.pixels.data(), sizeof(Pixel) * image.pixels.size());
  return array;
}

// k x 2, and a row for every corner.
TextureLayout to_layout(const DoubleArray& uv, const IntArray& of_corner) {
  TextureLayout layout = {Eigen::MatrixX2d(uv.shape(0), 2), to_vector(of_corner)};
  for (Eigen::Index k = 0; k < layout.uv.rows(); ++k) layout.uv.row(k) << uv.at(k, 0), uv.at(k, 1);
  for (const int row : layout.of_corner)
    if (row < 0 || row >= layout.uv.rows())
      throw ArgumentError("a corner has texture coordinates that do not exist");
  return layout;
}

py::tuple from_layout(TextureLayout layout) {
  py::array_t<double> uv({layout.uv.rows(), Eigen::Index(2)});
  for (Eigen::Index k = 0; k < layout.uv.rows(); ++k)
    for (int i = 0; i < 2; ++i) uv.mutable_at(k, i) = layout.uv(k, i);
  return py::make_tuple(uv, take(std::move(layout.of_corner)));
}

py::object read_layout(const std::string& path) {
  std::optional<TextureLayout> layout = read_texture_layout(path);
  return layout ? py::object(from_layout(std::move(*layout))) : py::none();
}

// The picture of B (height x width x 4) in the texture coordinates of A: both embeddings, both layouts.
using LayoutArrays = std::pair<DoubleArray, IntArray>;

py::array bake(const Overlay& overlay, const std::pair<HeldEmbedding*, HeldEmbedding*>& sides,
               const std::pair<LayoutArrays, LayoutArrays>& layouts, const ByteArray& picture,
               const std::pair<int, int>& size) {
  const PixelImage of_b = to_image(picture);
  const TextureLayout on_a = to_layout(layouts.first.first, layouts.first.second),
                      on_b = to_layout(layouts.second.first, layouts.second.second);
  PixelImage baked;
  {
    const py::gil_scoped_release release;
    const auto a = sides.first->source("a texture").surface(),
               b = sides.second->source("a texture").surface();
    baked = bake_texture(overlay, {*a, sides.first->embedding, on_a}, {*b, sides.second->embedding, on_b},
                         of_b, {size.first, size.second});
  }
  return to_array(baked);
}

}  // namespace

void bind_surface_map(py::module_& module) {
  py::class_<Overlay, HeldOverlay>(module, "Overlay")
      .def(py::init(&overlay_of))
      .def_property_readonly("corners", [](const Overlay& overlay) { return copy(overlay.faces.corners); })
      .def_property_readonly("start", [](const Overlay& overlay) { return copy(overlay.faces.start); })
      .def_property_readonly(
          "triangles", [](const Overlay& overlay) { return take(overlay_triangles(overlay).triangles); })
      .def_property_readonly("parents", &parents)
      .def("on_a", [](const Overlay& overlay, const DoubleArray& V,
                      const HeldEmbedding& a) { return points_of(to_points(V), a, overlay.on_a); })
      .def("on_b", [](const Overlay& overlay, const DoubleArray& V,
                      const HeldEmbedding& b) { return points_of(to_points(V), b, overlay.on_b); })
      .def("failed_checks", &failed_checks);
  py::class_<MapOptions>(module, "MapOptions").def(py::init(&map_options));
  module.def("map_two", &map_two);
  module.def("images_of_vertices", &vertices_on);
  module.def("images_of_points", &points_on);
  module.def("bake", &bake);
  module.def("new_texture_layout",
             [](const HeldEmbedding& held) { return from_layout(new_texture_layout(held.embedding)); });
  module.def("read_texture_layout", &read_layout);
  module.def("write_morph", [](const std::string& path, const IntArray& triangles, const DoubleArray& from,
                               const DoubleArray& to) {
    write_morph(path, {to_faces(triangles), to_points(from), to_points(to)});
  });
}

}  // namespace orbitutte::python
