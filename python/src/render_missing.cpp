// SPDX-License-Identifier: MIT
// Stands in for render.cpp if the library is built without Embree and Cairo.
#include "bindings.h"
#include "orbitutte/types.h"

namespace orbitutte::python {

void bind_render(py::module_& module) {
  module.def("render", [](const py::args&) {
    throw ArgumentError("this module was built without pictures; build it with -D ORBITUTTE_RENDER=ON");
  });
}

}  // namespace orbitutte::python
