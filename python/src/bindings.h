// SPDX-License-Identifier: MIT
// What the parts of the compiled module share. Each bind_... adds its part; the package around it,
// python/orbitutte, checks arguments and is what users see.
#pragma once

#include <pybind11/pybind11.h>

namespace orbitutte::python {

namespace py = pybind11;

void bind_errors(py::module_& module);
void bind_mesh(py::module_& module);
void bind_orbifold(py::module_& module);
void bind_cones(py::module_& module);
void bind_embedding(py::module_& module);
void bind_solver(py::module_& module);
void bind_point_map(py::module_& module);
void bind_surface_map(py::module_& module);
void bind_resample(py::module_& module);
void bind_render(py::module_& module);

}  // namespace orbitutte::python
