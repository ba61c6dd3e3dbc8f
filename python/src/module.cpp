// SPDX-License-Identifier: MIT
#include "bindings.h"
#include "orbitutte/memory.h"
#include "orbitutte/options.h"
#include "orbitutte/version.h"

namespace {

using namespace orbitutte;

// As `orbitutte --version` has it.
pybind11::dict build() {
  pybind11::dict facts;
  facts["version"] = version;
  facts["commit"] = commit;
  facts["backend"] = name_of(available_backends().front());
  facts["blas"] = blas_description();
  return facts;
}

}  // namespace

PYBIND11_MODULE(_orbitutte, module) {
  module.doc() = "The compiled part of orbitutte. Use the package 'orbitutte', which checks arguments.";
  module.attr("__version__") = version;
  module.def("build", build);
  module.def("keep_freed_memory", keep_freed_memory);
  module.def("use_huge_pages", use_huge_pages);
  python::bind_errors(module);
  python::bind_mesh(module);
  python::bind_orbifold(module);
  python::bind_cones(module);
  python::bind_embedding(module);
  python::bind_solver(module);
  python::bind_point_map(module);
  python::bind_surface_map(module);
  python::bind_resample(module);
  python::bind_render(module);
}
