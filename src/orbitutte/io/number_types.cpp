// SPDX-License-Identifier: MIT
#include "orbitutte/io/number_types.h"

#include <algorithm>
#include <cstdint>
#include <iterator>

#include "orbitutte/io/bytes.h"
#include "orbitutte/io/file_ending.h"

namespace orbitutte {
namespace {

template <class T>
double load_as_double(const char* bytes, std::endian order) {
  return static_cast<double>(load<T>(bytes, order));
}

// VTK calls the indices in its legacy files vtkIdType, but writes them as int.
constexpr NumberType number_types[] = {
    {"NIFTI_TYPE_FLOAT32", "float", "Float32", "f4", 4, load_as_double<float>},
    {"NIFTI_TYPE_FLOAT64", "double", "Float64", "f8", 8, load_as_double<double>},
    {"NIFTI_TYPE_INT8", "char signed_char", "Int8", "i1", 1, load_as_double<std::int8_t>},
    {"NIFTI_TYPE_UINT8", "unsigned_char", "UInt8", "u1 b1", 1, load_as_double<std::uint8_t>},
    {"NIFTI_TYPE_INT16", "short", "Int16", "i2", 2, load_as_double<std::int16_t>},
    {"NIFTI_TYPE_UINT16", "unsigned_short", "UInt16", "u2", 2, load_as_double<std::uint16_t>},
    {"NIFTI_TYPE_INT32", "int vtkIdType", "Int32", "i4", 4, load_as_double<std::int32_t>},
    {"NIFTI_TYPE_UINT32", "unsigned_int", "UInt32", "u4", 4, load_as_double<std::uint32_t>},
    {"NIFTI_TYPE_INT64", "long vtktypeint64", "Int64", "i8", 8, load_as_double<std::int64_t>},
    {"NIFTI_TYPE_UINT64", "unsigned_long vtktypeuint64", "UInt64", "u8", 8, load_as_double<std::uint64_t>}};

}  // namespace

const NumberType* find_number_type(std::string_view NumberType::*names, std::string_view name) {
  const auto* const type =
      std::find_if(std::begin(number_types), std::end(number_types),
                   [&](const NumberType& known) { return !name.empty() && has_word(known.*names, name); });
  return type == std::end(number_types) ? nullptr : type;
}

}  // namespace orbitutte
