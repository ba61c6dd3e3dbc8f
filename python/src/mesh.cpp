// SPDX-License-Identifier: MIT
// Meshes: from arrays, from and to files, and what they are.
#include <pybind11/eigen.h>
#include <pybind11/stl.h>

#include <memory>

#include "arrays.h"
#include "orbitutte/cones/marked_cones.h"
#include "orbitutte/embed.h"
#include "orbitutte/inspect/inspection.h"
#include "orbitutte/io/mesh_io.h"
#include "orbitutte/io/vertex_data.h"
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

// What is no UTF-8 is replaced.
py::str text(const std::string& bytes) {
  return py::reinterpret_steal<py::str>(
      PyUnicode_DecodeUTF8(bytes.data(), static_cast<Py_ssize_t>(bytes.size()), "replace"));
}

// (values, names, labels, whole), as write_values takes them; a label is (key, name, colour).
py::tuple read_values(const std::string& path) {
  VertexData data;
  {
    const py::gil_scoped_release release;
    data = read_vertex_data(path);
  }
  py::list labels;
  for (const ValueLabel& label : data.labels)
    labels.append(py::make_tuple(label.key, text(label.name), label.colour));
  return py::make_tuple(data.values, data.names, labels, data.is_whole);
}

using Label = std::tuple<int, std::string, std::array<double, 4>>;

void write_values(const std::string& path, const Eigen::MatrixXd& values,
                  const std::vector<std::string>& names, const std::vector<Label>& labels, bool is_whole) {
  VertexData data = {values, names, {}, is_whole};
  data.labels.reserve(labels.size());
  for (const auto& [key, name, colour] : labels) data.labels.push_back({key, name, colour});
  write_vertex_data(path, data);
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
      .def(
          "repaired",
          [](const SourceMesh& mesh) {
            auto repaired = [&] {
              const py::gil_scoped_release release;
              return mesh.repaired();
            }();
            return py::make_tuple(std::move(repaired.first), copy(repaired.second));
          },
          "(mesh, what became of each vertex)")
      .def("info", &info, Release())
      .def("write", &write, Release())
      .def("extremities", &extremities, Release())
      .def("cones", &cones_with_angles, Release());
  module.def("read_values", &read_values);
  module.def("write_values", &write_values, Release());
  module.def("families", &families_json);
}

}  // namespace orbitutte::python
