// SPDX-License-Identifier: MIT
// NumPy's files of one array (.npy), after numpy.lib.format, versions 1.0 to 3.0.
#include <fmt/format.h>

#include <charconv>
#include <limits>

#include "orbitutte/io/bytes.h"
#include "orbitutte/io/number_types.h"
#include "orbitutte/io/text_scanner.h"
#include "orbitutte/io/vertex_data_formats.h"
#include "orbitutte/types.h"

namespace orbitutte {
namespace {

constexpr std::string_view npy_start = "\x93NUMPY";

[[noreturn]] void refuse_npy(std::string_view problem) {
  throw MeshError(fmt::format("{}; save it with numpy.save, as an array of one or two dimensions", problem));
}

// The dictionary of the header, a Python expression, and the bytes of the numbers.
struct NpyParts {
  std::string_view header, numbers;
};

NpyParts split_npy(std::string_view bytes) {
  if (!bytes.starts_with(npy_start)) refuse_npy("the file does not begin as NumPy's files do");
  if (bytes.size() < 12) refuse_npy("the file ends within its first bytes");
  const bool is_short = bytes[6] == 1;
  const std::size_t begin = is_short ? 10 : 12;
  const std::size_t size = is_short ? load<std::uint16_t>(&bytes[8], std::endian::little)
                                    : load<std::uint32_t>(&bytes[8], std::endian::little);
  if (size > bytes.size() - begin)
    refuse_npy(fmt::format("the header has {} bytes, but only {} follow", size, bytes.size() - begin));
  return {bytes.substr(begin, size), bytes.substr(begin + size)};
}

// What follows the key of the dictionary and its colon.
std::string_view npy_entry(std::string_view header, std::string_view key) {
  const std::size_t at = header.find(fmt::format("'{}'", key));
  const std::size_t colon = header.find(':', at);
  const std::size_t value = header.find_first_not_of(" ", colon == header.npos ? colon : colon + 1);
  if (at == header.npos || colon == header.npos || value == header.npos)
    refuse_npy(fmt::format("the header has no '{}'", key));
  return header.substr(value);
}

// The numbers between the parentheses.
std::vector<Eigen::Index> npy_shape(std::string_view entry) {
  std::string list(entry.substr(0, entry.find(')')));
  std::replace_if(
      list.begin(), list.end(), [](char c) { return c == '(' || c == ','; }, ' ');
  std::vector<Eigen::Index> shape;
  TextScanner in(list, {});
  while (in.find_word()) {
    const std::string_view word = in.word();
    int size = 0;
    if (parse_number(word, size) != NumberError::none || size < 0)
      refuse_npy(fmt::format("the shape has {} in place of a size", in_quotes(word)));
    shape.push_back(size);
  }
  if (shape.empty() || shape.size() > 2) refuse_npy(fmt::format("the array has {} dimensions", shape.size()));
  if (shape.size() == 1) shape.push_back(1);
  return shape;
}

struct NpyType {
  const NumberType* type;
  std::endian order;
};

// Of a type such as '<f8'.
NpyType npy_type(std::string_view entry) {
  const std::string_view word = entry.substr(0, entry.find_first_of(",}"));
  const bool is_plain = word.size() >= 5 && word.front() == '\'' && word.back() == '\'' && word[1] != '\'';
  const NumberType* const type =
      is_plain ? find_number_type(&NumberType::npy, word.substr(2, word.size() - 3)) : nullptr;
  if (!type) refuse_npy(fmt::format("the type {} of numbers is not known", in_quotes(word)));
  return {type, word[1] == '>' ? std::endian::big : std::endian::little};
}

}  // namespace

VertexData read_npy(std::string_view bytes) {
  const NpyParts parts = split_npy(bytes);
  const NpyType numbers = npy_type(npy_entry(parts.header, "descr"));
  const bool by_columns = npy_entry(parts.header, "fortran_order").starts_with("True");
  const std::vector<Eigen::Index> shape = npy_shape(npy_entry(parts.header, "shape"));
  const std::size_t size = numbers.type->size;
  const auto room = static_cast<Eigen::Index>(parts.numbers.size() / size);
  if (shape[1] > 0 && shape[0] > room / shape[1])
    refuse_npy(
        fmt::format("the header promises {} x {} numbers, but only {} follow", shape[0], shape[1], room));
  VertexData data;
  data.values.resize(shape[0], shape[1]);
  for (Eigen::Index i = 0; i < shape[0]; ++i)
    for (Eigen::Index j = 0; j < shape[1]; ++j) {
      const auto at = static_cast<std::size_t>(by_columns ? j * shape[0] + i : i * shape[1] + j);
      data.values(i, j) = numbers.type->load(parts.numbers.data() + at * size, numbers.order);
    }
  return data;
}

std::string write_npy(const VertexData& data) {
  constexpr std::size_t before_header = 10, alignment = 64;
  const Eigen::Index rows = data.values.rows(), columns = data.values.cols();
  std::string header = fmt::format("{{'descr': '<f8', 'fortran_order': False, 'shape': ({},{}), }}", rows,
                                   columns == 1 ? "" : fmt::format(" {}", columns));
  header.append(alignment - 1 - (before_header + header.size()) % alignment, ' ');
  header += '\n';
  std::string bytes(npy_start);
  bytes += std::string_view("\x01\x00", 2);
  append_little_endian(bytes, static_cast<std::uint16_t>(header.size()));
  bytes += header;
  bytes.reserve(bytes.size() + sizeof(double) * static_cast<std::size_t>(data.values.size()));
  for (Eigen::Index i = 0; i < rows; ++i)
    for (Eigen::Index j = 0; j < columns; ++j) append_little_endian(bytes, data.values(i, j));
  return bytes;
}

}  // namespace orbitutte
