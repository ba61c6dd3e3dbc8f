// SPDX-License-Identifier: MIT
// NumPy arrays from and to the library's plain values. The package hands over C-contiguous arrays of the
// right type.
#pragma once

#include <pybind11/numpy.h>

#include <vector>

#include "bindings.h"
#include "orbitutte/types.h"

namespace orbitutte::python {

using DoubleArray = py::array_t<double, py::array::c_style>;
using IntArray = py::array_t<int, py::array::c_style>;

/// Copies. n x 3 each; the caller has checked the shape.
Points to_points(const DoubleArray& array);
Triangles to_faces(const IntArray& array);
std::vector<int> to_vector(const IntArray& array);

/// Read-only views of a part of `owner`'s C++ object. They keep `owner` alive.
py::array view(const Points& points, const py::handle& owner);
py::array view(const Triangles& faces, const py::handle& owner);
py::array view(const std::vector<int>& values, const py::handle& owner);

/// Read-only copies.
py::array copy(const Matrix3& matrix);
/// k x 3 x 3.
py::array copy(const std::vector<Matrix3>& matrices);
py::array copy(const std::vector<int>& values);
py::array copy(const std::vector<double>& values);

/// An array that takes over the values, and with them their memory.
py::array take(Points&& points);
py::array take(Triangles&& faces);
py::array take(std::vector<int>&& values);

}  // namespace orbitutte::python
