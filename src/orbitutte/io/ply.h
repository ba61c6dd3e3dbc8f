// SPDX-License-Identifier: MIT
// The PLY container: elements of named, typed properties, as ASCII or as binary of either byte order.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace orbitutte {

enum class PlyType { int8, uint8, int16, uint16, int32, uint32, int64, uint64, float32, float64 };

/// One property of an element: `count` numbers, or `count` lists of numbers, as doubles. Some programs write
/// types of 64 bits, which Turk's format does not have; their numbers are rounded beyond 2^53.
struct PlyProperty {
  std::string name;
  PlyType type = PlyType::float64;
  bool is_list = false;
  /// Of lists.
  PlyType count_type = PlyType::uint8;
  /// All values, one element after the other.
  std::vector<double> values;
  /// Of lists: count + 1 offsets into values.
  std::vector<std::size_t> list_start;
};

struct PlyElement {
  std::string name;
  std::size_t count = 0;
  std::vector<PlyProperty> properties;

  /// Null if there is none.
  const PlyProperty* find(std::string_view property) const;
};

struct PlyFile {
  std::vector<std::string> comments;
  std::vector<PlyElement> elements;

  /// Null if there is none.
  const PlyElement* find(std::string_view element) const;
};

/// Throws MeshError naming the header line or the element if the data are cut short or make no sense. A
/// header that promises more than the bytes can hold is refused before memory is taken for it.
PlyFile parse_ply(std::string_view bytes);

/// Appends an element's values, without its header. Throws ArgumentError if a property does not have one
/// value for each.
void append_element(std::string& bytes, const PlyElement& element);

/// The bytes of a binary little-endian PLY file.
std::string serialize_ply(const PlyFile& file);

}  // namespace orbitutte
