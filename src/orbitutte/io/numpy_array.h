// SPDX-License-Identifier: MIT
// NumPy's files: .npy of one array, after numpy.lib.format, versions 1.0 to 3.0; .npz of several, a ZIP
// archive of such files.
#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace orbitutte {

struct NumpyArray {
  std::vector<int> shape;

  /// Row by row: the last index runs first.
  std::vector<double> values;

  /// Are they whole numbers by their type? They are written as int32, or as int64 if one of them needs it;
  /// others as float64.
  bool is_whole = false;
};

/// The array in the bytes of an .npy: of whole and floating numbers of any size from 4 bytes (whole ones: 1
/// byte), both byte orders and both index orders. Throws MeshError naming what makes no sense.
NumpyArray parse_numpy_array(std::string_view bytes);

std::string serialize_numpy_array(const NumpyArray& array);

/// Arrays with their names.
using NumpyArchive = std::vector<std::pair<std::string, NumpyArray>>;

/// The arrays of an .npz, stored or compressed. Throws MeshError naming the array that is damaged, or what of
/// the archive makes no sense; archives beyond 4 GB are refused.
NumpyArchive parse_numpy_archive(std::string_view bytes);

/// The bytes of an .npz; not compressed, and the same whenever they are written.
std::string serialize_numpy_archive(const NumpyArchive& archive);

}  // namespace orbitutte
