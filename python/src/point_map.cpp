// SPDX-License-Identifier: MIT
// Points from the surface to the sphere and back.
#include "orbitutte/map/point_map.h"

#include "arrays.h"
#include "held_embedding.h"
#include "orbitutte/map/alignment.h"

namespace orbitutte::python {
namespace {

// (triangle, barycentric, copy)
py::tuple locate(const PointLocator& locator, const DoubleArray& directions) {
  const Points rows = to_points(directions);
  SurfacePoints found;
  {
    const py::gil_scoped_release release;
    found = locator.locate(rows);
  }
  return py::make_tuple(take(std::move(found.triangle)), take(std::move(found.barycentric)),
                        take(std::move(found.copy)));
}

py::array map(const HeldEmbedding& held, const IntArray& triangle, const DoubleArray& barycentric,
              const IntArray& copy) {
  const SurfacePoints points = {to_vector(triangle), to_points(barycentric), to_vector(copy)};
  Points images;
  {
    const py::gil_scoped_release release;
    images = map_points(held.embedding, points);
  }
  return take(std::move(images));
}

// 3 x 3
py::array rotation_between(const HeldEmbedding& held, const DoubleArray& from, const DoubleArray& to) {
  return copy(best_rotation(held.embedding.target, to_points(from), to_points(to)).matrix());
}

}  // namespace

void bind_point_map(py::module_& module) {
  py::class_<PointLocator>(module, "PointLocator")
      .def(py::init([](const HeldEmbedding& held) {
        const py::gil_scoped_release release;
        return std::make_unique<PointLocator>(held.embedding);
      }))
      .def("locate", &locate);
  module.def("map_points", &map);
  module.def("rotation_between", &rotation_between);
}

}  // namespace orbitutte::python
