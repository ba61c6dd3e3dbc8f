// SPDX-License-Identifier: MIT
// NumPy's arrays as values at vertices.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "orbitutte/io/numpy_array.h"
#include "orbitutte/io/vertex_data_formats.h"
#include "orbitutte/types.h"

namespace orbitutte {
namespace {

using ByRows = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

// Numbers that a file of whole numbers can hold; NaN, where there is no label, is none.
bool are_whole(const std::vector<double>& values) {
  constexpr double bound = 9.2e18;  // below 2^63
  return std::all_of(values.begin(), values.end(),
                     [](double value) { return std::abs(value) < bound && value == std::floor(value); });
}

}  // namespace

VertexData read_npy(std::string_view bytes) {
  const NumpyArray array = parse_numpy_array(bytes);
  if (array.shape.empty() || array.shape.size() > 2)
    throw MeshError(
        fmt::format("the array has {} dimensions; save it with numpy.save, as an array of one or two",
                    array.shape.size()));
  VertexData data;
  data.values = Eigen::Map<const ByRows>(array.values.data(), array.shape[0],
                                         array.shape.size() == 2 ? array.shape[1] : 1);
  data.is_whole = array.is_whole;
  return data;
}

std::string write_npy(const VertexData& data) {
  NumpyArray array;
  array.shape = {static_cast<int>(data.values.rows())};
  if (data.values.cols() != 1) array.shape.push_back(static_cast<int>(data.values.cols()));
  const ByRows rows = data.values;
  array.values.assign(rows.data(), rows.data() + rows.size());
  array.is_whole = (data.is_whole || !data.labels.empty()) && are_whole(array.values);
  return serialize_numpy_array(array);
}

}  // namespace orbitutte
