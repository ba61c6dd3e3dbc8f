// SPDX-License-Identifier: MIT
#include "arrays.h"

#include <algorithm>
#include <memory>

namespace orbitutte::python {
namespace {

py::array read_only(py::array array) {
  array.attr("setflags")(py::arg("write") = false);
  return array;
}

// An array of rows of three over memory that `owner` keeps.
template <typename Matrix>
py::array rows(const Matrix& matrix, const py::handle& owner) {
  return py::array_t<typename Matrix::Scalar>({matrix.rows(), matrix.cols()}, matrix.data(), owner);
}

// Deletes the value when the last array over it is gone.
template <typename Value>
std::pair<Value*, py::capsule> owned(Value&& value) {
  auto held = std::make_unique<Value>(std::move(value));
  Value* const pointer = held.release();
  return {pointer, py::capsule(pointer, [](void* p) { delete static_cast<Value*>(p); })};
}

}  // namespace

Points to_points(const DoubleArray& array) {
  Points points(array.shape(0), 3);
  std::copy_n(array.data(), array.size(), points.data());
  return points;
}

Triangles to_faces(const IntArray& array) {
  Triangles faces(array.shape(0), 3);
  std::copy_n(array.data(), array.size(), faces.data());
  return faces;
}

std::vector<int> to_vector(const IntArray& array) { return {array.data(), array.data() + array.size()}; }

py::array view(const Points& points, const py::handle& owner) { return read_only(rows(points, owner)); }

py::array view(const Triangles& faces, const py::handle& owner) { return read_only(rows(faces, owner)); }

py::array view(const std::vector<int>& values, const py::handle& owner) {
  return read_only(py::array_t<int>(static_cast<py::ssize_t>(values.size()), values.data(), owner));
}

py::array copy(const Matrix3& matrix) { return copy(std::vector{matrix}).attr("__getitem__")(0); }

py::array copy(const std::vector<Matrix3>& matrices) {
  py::array_t<double> array({static_cast<py::ssize_t>(matrices.size()), py::ssize_t(3), py::ssize_t(3)});
  double* next = array.mutable_data();
  for (const Matrix3& M : matrices)
    for (int i = 0; i < 3; ++i)
      for (int k = 0; k < 3; ++k) *next++ = M(i, k);
  return read_only(array);
}

py::array copy(const std::vector<int>& values) {
  return read_only(py::array_t<int>(static_cast<py::ssize_t>(values.size()), values.data()));
}

py::array copy(const std::vector<double>& values) {
  return read_only(py::array_t<double>(static_cast<py::ssize_t>(values.size()), values.data()));
}

py::array take(Points&& points) {
  const auto [held, owner] = owned(std::move(points));
  return rows(*held, owner);
}

py::array take(Triangles&& faces) {
  const auto [held, owner] = owned(std::move(faces));
  return rows(*held, owner);
}

py::array take(std::vector<int>&& values) {
  const auto [held, owner] = owned(std::move(values));
  return py::array_t<int>(static_cast<py::ssize_t>(held->size()), held->data(), owner);
}

}  // namespace orbitutte::python
