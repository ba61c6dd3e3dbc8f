// SPDX-License-Identifier: MIT
// Values from a surface to a grid and back.
#include "orbitutte/resample/resample.h"

#include <pybind11/eigen.h>
#include <pybind11/stl.h>

#include "arrays.h"
#include "held_embedding.h"

namespace orbitutte::python {
namespace {

py::array array_of(const Eigen::VectorXd& values) {
  return copy(std::vector<double>(values.data(), values.data() + values.size()));
}

using ByRows = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

py::array as_array(const ByRows& values) {
  py::array_t<double> array({values.rows(), values.cols()});
  std::copy(values.data(), values.data() + values.size(), array.mutable_data());
  return array;
}

// rows x maps, by a function such as `apply`.
py::array applied(const SparseTable& table, const DoubleArray& values,
                  Eigen::MatrixXd (*function)(const SparseTable&, const Eigen::MatrixXd&)) {
  const Eigen::MatrixXd given = Eigen::Map<const ByRows>(values.data(), values.shape(0), values.shape(1));
  Eigen::MatrixXd result;
  {
    const py::gil_scoped_release release;
    result = function(table, given);
  }
  return as_array(result);
}

Grid grid_by_name(const HeldEmbedding& held, const std::string& text) {
  const GridRequest request = parse_grid(text);
  const py::gil_scoped_release release;
  return make_grid(request, held.embedding);
}

SparseTable resample_table(const HeldEmbedding& held, const Grid& grid, const std::string& kind,
                           const std::string& direction) {
  const ResampleKind choice = parse_choice<ResampleKind>(kind, "kind");
  const py::gil_scoped_release release;
  return direction == "grid" ? table_to_grid(held.embedding, grid, choice)
                             : table_to_surface(held.embedding, grid, choice);
}

// rows x maps.
py::array labels_by_areas(const SparseTable& table, const DoubleArray& labels, const Eigen::VectorXd& rows,
                          const Eigen::VectorXd& columns) {
  const Eigen::MatrixXd given = Eigen::Map<const ByRows>(labels.data(), labels.shape(0), labels.shape(1));
  Eigen::MatrixXd result;
  {
    const py::gil_scoped_release release;
    result = labels_keeping_areas(table, given, {rows, columns});
  }
  return as_array(result);
}

// k x maps; the tables are linear.
py::array least_squares(const SparseTable& to_surface, const SparseTable& to_grid,
                        const DoubleArray& values) {
  const Eigen::MatrixXd given = Eigen::Map<const ByRows>(values.data(), values.shape(0), values.shape(1));
  Eigen::MatrixXd result;
  {
    const py::gil_scoped_release release;
    result = least_squares_values(to_surface, to_grid, given);
  }
  return as_array(result);
}

// (to the grid, to the surface, areas of cells, areas of vertices)
py::tuple conservative(const HeldEmbedding& held, const Grid& grid) {
  const Surface& surface = *held.source("a conservative table").surface();
  ConservativeTables tables;
  Eigen::VectorXd areas;
  {
    const py::gil_scoped_release release;
    areas = surface.vertex_areas();
    tables = conservative_tables(held.embedding, grid, areas);
  }
  return py::make_tuple(std::move(tables.to_grid), std::move(tables.to_surface), array_of(tables.cell_areas),
                        array_of(areas));
}

}  // namespace

void bind_resample(py::module_& module) {
  py::class_<Grid>(module, "Grid")
      .def_property_readonly("kind", [](const Grid& grid) { return name_of(grid.kind); })
      .def_property_readonly("points", [](const Grid& grid) { return take(Points(grid.points)); })
      .def_property_readonly("areas", [](const Grid& grid) { return array_of(grid.areas); })
      .def_property_readonly("shape", [](const Grid& grid) { return grid.shape; })
      .def_property_readonly("triangles", [](const Grid& grid) { return take(Triangles(grid.triangles)); })
      .def("padded_points", [](const Grid& grid, int margin) { return take(padded_points(grid, margin)); })
      .def("padded_shape", [](const Grid& grid, int margin) { return padded_shape(grid, margin); });
  py::class_<SparseTable>(module, "SparseTable")
      .def_property_readonly("columns", [](const SparseTable& table) { return table.columns; })
      .def_property_readonly("indptr", [](const SparseTable& table) { return copy(table.start); })
      .def_property_readonly("indices", [](const SparseTable& table) { return copy(table.index); })
      .def_property_readonly("weights", [](const SparseTable& table) { return copy(table.weight); })
      .def("apply",
           [](const SparseTable& table, const DoubleArray& values) { return applied(table, values, &apply); })
      .def("apply_to_labels", [](const SparseTable& table, const DoubleArray& values) {
        return applied(table, values, &apply_to_labels);
      });
  module.def("make_grid", &grid_by_name);
  module.def("sphere_grid",
             [](const DoubleArray& V, const IntArray& F) { return sphere_grid(to_points(V), to_faces(F)); });
  module.def("resample_table", &resample_table);
  module.def("conservative_tables", &conservative);
  module.def("least_squares_values", &least_squares);
  module.def("labels_keeping_areas", &labels_by_areas);
}

}  // namespace orbitutte::python
