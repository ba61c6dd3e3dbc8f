// SPDX-License-Identifier: MIT
// The types of numbers in binary files, and what each format calls them.
#pragma once

#include <bit>
#include <cstddef>
#include <string_view>

namespace orbitutte {

struct NumberType {
  /// Names by GIfTI, legacy VTK, VTK's XML and NumPy (without byte order). Several names are separated by
  /// blanks.
  std::string_view gifti, legacy_vtk, vtk_xml, npy;

  /// Of a number, in bytes.
  std::size_t size;

  /// The number whose bytes begin there, aligned or not.
  double (*load)(const char* bytes, std::endian order);
};

/// The type with this name among those of a format, such as find_number_type(&NumberType::gifti,
/// "NIFTI_TYPE_FLOAT32"); nullptr if there is none.
const NumberType* find_number_type(std::string_view NumberType::*names, std::string_view name);

}  // namespace orbitutte
