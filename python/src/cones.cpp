// SPDX-License-Identifier: MIT
// Cones of fitted angles.
#include <pybind11/stl.h>

#include "bindings.h"
#include "orbitutte/cones/cone_wishes.h"
#include "source_mesh.h"

namespace orbitutte::python {
namespace {

FittedCones fitted_cones(const SourceMesh& mesh, const ConeWishes& wishes) {
  const std::shared_ptr<const Surface> surface = mesh.surface();
  const py::gil_scoped_release others_run;
  return find_cones(*surface, wishes);
}

}  // namespace

void bind_cones(py::module_& module) {
  py::class_<ConeWishes>(module, "ConeWishes")
      .def(py::init<>())
      .def_readwrite("count", &ConeWishes::count)
      .def_readwrite("sigma", &ConeWishes::sigma)
      .def_readwrite("kept", &ConeWishes::kept)
      .def_readwrite("are_orders", &ConeWishes::are_orders)
      .def_property(
          "area", [](const ConeWishes& wishes) { return wishes.fit.area; },
          [](ConeWishes& wishes, const std::optional<double>& area) { wishes.fit.area = area; })
      .def_property(
          "greatest", [](const ConeWishes& wishes) { return wishes.fit.greatest_angle; },
          [](ConeWishes& wishes, const std::optional<double>& share) { wishes.fit.greatest_angle = share; });
  py::class_<FittedCones>(module, "FittedCones")
      .def_readonly("vertices", &FittedCones::vertices)
      .def_property_readonly("angles", [](const FittedCones& cones) { return cones.fit.angles; })
      .def_property_readonly("area", [](const FittedCones& cones) { return cones.fit.area; })
      .def_property_readonly("sigma", [](const FittedCones& cones) { return cones.fit.sigma; });
  module.def("fitted_cones", &fitted_cones);
}

}  // namespace orbitutte::python
