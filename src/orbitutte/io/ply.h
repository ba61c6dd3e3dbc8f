// SPDX-License-Identifier: MIT
// The PLY container: elements of named, typed properties, as ASCII or as binary of either byte order.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace orbitutte {

enum class PlyType { int8, uint8, int16, uint16, int32, uint32, int64, uint64, float32, float64 };

/// One property of an element: `count` numbers, or `count` lists of numbers, as doubles. Those of the types
/// of 64 bits, which Turk's format does not have but programs write, are rounded if they are beyond 2^53.
struct PlyProperty {
  std::string name;
  PlyType type = PlyType::float64;
  bool is_list = false;
  PlyType count_type = PlyType::uint8;  ///< of lists
  std::vector<double> values;           ///< all values, one element after the other
  std::vector<std::size_t> list_start;  ///< of lists: count + 1 offsets into values
};

struct PlyElement {
  std::string name;
  std::size_t count = 0;
  std::vector<PlyProperty> properties;

  const PlyProperty* find(std::string_view property) const;  ///< null where there is none
};

struct PlyFile {
  std::vector<std::string> comments;
  std::vector<PlyElement> elements;

  const PlyElement* find(std::string_view element) const;  ///< null where there is none
};

/// Throws MeshError naming the header line, or the element, where the data are cut short or make no sense.
/// A header that promises more than the bytes can hold is refused before memory is taken for it.
PlyFile parse_ply(std::string_view bytes);

/// Appends an element's values, without its header. Throws ArgumentError if a property does not have one
/// value for each.
void append_element(std::string& bytes, const PlyElement& element);

/// The bytes of a binary little-endian PLY file.
std::string serialize_ply(const PlyFile& file);

}  // namespace orbitutte
