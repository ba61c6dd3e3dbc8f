// SPDX-License-Identifier: MIT
// Meshes: from arrays, from and to files, and what they are.
#include <pybind11/stl.h>

#include <memory>

#include "arrays.h"
#include "orbitutte/cones/marked_cones.h"
#include "orbitutte/embed.h"
#include "orbitutte/inspect/inspection.h"
#include "orbitutte/io/mesh_io.h"
#include "orbitutte/orbifold/signature.h"
#include "orbitutte/report/inspection_json.h"
#include "orbitutte/samples/sample.h"
#include "source_mesh.h"

namespace orbitutte::python {
namespace {

using Release = py::call_guard<py::gil_scoped_release>;

std::shared_ptr<SourceMesh> from_triangles(const DoubleArray& V, const IntArray& F) {
  Mesh mesh = {to_points(V), to_faces(F)};
  const py::gil_scoped_release release;
  return std::make_shared<SourceMesh>(std::move(mesh));
}

std::shared_ptr<SourceMesh> from_polygons(const DoubleArray& V, const IntArray& corners,
                                          const IntArray& start) {
  PolygonMesh mesh = {to_points(V), to_vector(corners), to_vector(start)};
  const py::gil_scoped_release release;
  return std::make_shared<SourceMesh>(std::move(mesh));
}

std::shared_ptr<SourceMesh> from_file(const std::string& path) {
  return std::make_shared<SourceMesh>(read_mesh(path));
}

std::shared_ptr<SourceMesh> sample(const std::string& shape, int faces) {
  return std::make_shared<SourceMesh>(sample_mesh({parse_choice<SampleShape>(shape, "shape"), faces}));
}

std::string info(const SourceMesh& mesh) {
  const PolygonMesh polygons = mesh.polygons();
  const Inspection inspection = inspect(polygons);
  return inspection_json("", polygons, inspection, weak_places_if_sound(polygons, inspection));
}

py::tuple faces_of(const std::shared_ptr<SourceMesh>& mesh) {
  const py::object owner = py::cast(mesh);
  const auto [V, F, corners, start] = mesh->arrays();
  if (F) return py::make_tuple(view(*F, owner), py::none());
  return py::make_tuple(view(*corners, owner), view(*start, owner));
}

void write(const SourceMesh& mesh, const std::string& path) {
  const auto [V, F, corners, start] = mesh.arrays();
  if (F) return write_mesh(path, Mesh{*V, *F});
  write_mesh(path, PolygonMesh{*V, *corners, *start});
}

// As many as the target needs, or as standard_target does.
std::vector<int> extremities(const SourceMesh& mesh, const std::optional<Target>& target) {
  const Surface& surface = *mesh.surface();
  return choose_cones(surface, target ? *target : standard_target(surface.topology));
}

// The target with these angles, and the vertices of its marks; those may be none, which stands for
// extremities.
std::pair<Target, std::vector<int>> cones_with_angles(const SourceMesh& mesh, const std::string& signature,
                                                      const std::optional<std::vector<int>>& vertices,
                                                      const std::vector<double>& angles) {
  const Surface& surface = *mesh.surface();
  MarkedCones marked = vertices ? marked_cones(surface, signature, *vertices, angles)
                                : cones_at_extremities(surface, signature, angles);
  return {std::move(marked.target), std::move(marked.vertices)};
}

}  // namespace

void bind_mesh(py::module_& module) {
  py::class_<SourceMesh, std::shared_ptr<SourceMesh>>(module, "Mesh")
      .def(py::init(&from_triangles))
      .def(py::init(&from_polygons))
      .def_static("read", &from_file, Release())
      .def_static("sample", &sample, Release())
      .def_property_readonly(
          "positions",
          [](const std::shared_ptr<SourceMesh>& mesh) { return view(*mesh->arrays().V, py::cast(mesh)); })
      .def_property_readonly("faces", &faces_of, "(m x 3, None), or (corners, start) of polygons")
      .def_property_readonly("warnings", &SourceMesh::warnings)
      .def("info", &info, Release())
      .def("write", &write, Release())
      .def("extremities", &extremities, Release())
      .def("cones", &cones_with_angles, Release());
  module.def("families", &families_json);
}

}  // namespace orbitutte::python
