// SPDX-License-Identifier: MIT
// What a mesh is embedded into.
#include <pybind11/stl.h>

#include "arrays.h"
#include "orbitutte/io/corner_file.h"
#include "orbitutte/orbifold/polygon.h"
#include "orbitutte/orbifold/signature.h"

namespace orbitutte::python {
namespace {

Target polygon(const std::vector<int>& vertices, const DoubleArray& positions) {
  const Points points = to_points(positions);
  std::vector<PolygonCorner> corners;
  for (std::size_t k = 0; k < vertices.size(); ++k)
    corners.push_back({vertices[k], points.row(static_cast<Eigen::Index>(k))});
  return polygon_target(corners);
}

}  // namespace

void bind_orbifold(py::module_& module) {
  py::class_<Target>(module, "Target")
      .def_static("parse", &parse_orbifold)
      .def_static("polygon", &polygon)
      .def_static("polygon_file", [](const std::string& path) { return polygon_target(read_corners(path)); })
      .def_readonly("signature", &Target::signature)
      .def_readonly("group_order", &Target::group_order)
      .def_property_readonly("mark_count", [](const Target& target) { return target.marks.size(); })
      .def_property_readonly("space", [](const Target& target) { return target.space.name(); })
      .def_property_readonly("corner_vertices", &corner_vertices);
}

}  // namespace orbitutte::python
