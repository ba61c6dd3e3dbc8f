// SPDX-License-Identifier: MIT
// The header of a PLY file, and the types that it names.
#pragma once

#include <bit>
#include <optional>

#include "orbitutte/io/ply.h"

namespace orbitutte {

struct PlyHeader {
  /// None: the data are ASCII.
  std::optional<std::endian> byte_order;
  /// The elements, still without values.
  PlyFile file;
  /// In bytes; the data begin after it.
  std::size_t size = 0;
  int lines = 0;
};

/// Throws MeshError naming the line at fault, or the element if the header promises more of it than the
/// bytes hold.
PlyHeader parse_ply_header(std::string_view bytes);

/// The header of a binary little-endian file of these elements, up to and including the line break after
/// `end_header`.
std::string serialize_ply_header(const PlyFile& file);

/// The value of visit(T{}), where T is the C++ type of the same name.
template <class Visit>
auto visit_type(PlyType type, Visit visit) {
  switch (type) {
    case PlyType::int8:
      return visit(std::int8_t{});
    case PlyType::uint8:
      return visit(std::uint8_t{});
    case PlyType::int16:
      return visit(std::int16_t{});
    case PlyType::uint16:
      return visit(std::uint16_t{});
    case PlyType::int32:
      return visit(std::int32_t{});
    case PlyType::uint32:
      return visit(std::uint32_t{});
    case PlyType::int64:
      return visit(std::int64_t{});
    case PlyType::uint64:
      return visit(std::uint64_t{});
    case PlyType::float32:
      return visit(float{});
    case PlyType::float64:
      break;
  }
  return visit(double{});
}

inline std::size_t size_of(PlyType type) {
  return visit_type(type, [](auto number) { return sizeof(number); });
}

inline bool is_integer(PlyType type) { return type != PlyType::float32 && type != PlyType::float64; }

/// The name of a type in headers: "uchar".
std::string_view ply_type_name(PlyType type);

}  // namespace orbitutte
