// SPDX-License-Identifier: MIT
// Maps between two surfaces.
#include "orbitutte/map/surface_map.h"

#include <pybind11/stl.h>

#include <cstdint>

#include "arrays.h"
#include "held_embedding.h"
#include "orbitutte/export/map_files.h"
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
  module.def("write_morph", [](const std::string& path, const IntArray& triangles, const DoubleArray& from,
                               const DoubleArray& to) {
    write_morph(path, {to_faces(triangles), to_points(from), to_points(to)});
  });
}

}  // namespace orbitutte::python
