// SPDX-License-Identifier: MIT
#include "orbitutte/io/numpy_array.h"

#include <fmt/format.h>
#include <zlib.h>

#include <algorithm>
#include <cstdint>
#include <limits>

#include "orbitutte/io/bytes.h"
#include "orbitutte/io/compression.h"
#include "orbitutte/io/number_types.h"
#include "orbitutte/io/text_scanner.h"
#include "orbitutte/types.h"

namespace orbitutte {
namespace {

constexpr std::string_view npy_start = "\x93NUMPY";

[[noreturn]] void refuse_npy(std::string_view problem) {
  throw MeshError(fmt::format("{}; save it with numpy.save, as an array of numbers", problem));
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
std::vector<int> npy_shape(std::string_view entry) {
  std::string list(entry.substr(0, entry.find(')')));
  std::replace_if(
      list.begin(), list.end(), [](char c) { return c == '(' || c == ','; }, ' ');
  std::vector<int> shape;
  TextScanner in(list, {});
  while (in.find_word()) {
    const std::string_view word = in.word();
    int size = 0;
    if (parse_number(word, size) != NumberError::none || size < 0)
      refuse_npy(fmt::format("the shape has {} in place of a size", in_quotes(word)));
    shape.push_back(size);
  }
  return shape;
}

struct NpyType {
  const NumberType* type;
  std::endian order;
  bool is_whole;
};

// Of a type such as '<f8'.
NpyType npy_type(std::string_view entry) {
  const std::string_view word = entry.substr(0, entry.find_first_of(",}"));
  const bool is_plain = word.size() >= 5 && word.front() == '\'' && word.back() == '\'' && word[1] != '\'';
  const NumberType* const type =
      is_plain ? find_number_type(&NumberType::npy, word.substr(2, word.size() - 3)) : nullptr;
  if (!type) refuse_npy(fmt::format("the type {} of numbers is not known", in_quotes(word)));
  return {type, word[1] == '>' ? std::endian::big : std::endian::little, word[2] != 'f'};
}

// How many numbers a shape has, of which so many are there.
std::size_t npy_count(const std::vector<int>& shape, std::size_t room) {
  const auto refuse = [&](const std::string& numbers) {
    refuse_npy(fmt::format("the header promises {} numbers, but only {} follow", numbers, room));
  };
  std::size_t count = 1;
  for (const int size : shape) {
    if (size > 0 && count > room / static_cast<std::size_t>(size))
      refuse(fmt::format("{}", fmt::join(shape, " x ")));
    count *= static_cast<std::size_t>(size);
  }
  if (count > room) refuse("1");  // a scalar, which has no sizes
  return count;
}

// Where the number that comes next, row by row, lies in an array by columns.
class ColumnOrder {
 public:
  explicit ColumnOrder(const std::vector<int>& shape) : shape_(shape), index_(shape.size(), 0) {}

  std::size_t next() {
    std::size_t at = 0;
    for (std::size_t d = shape_.size(); d-- > 0;) at = at * shape_[d] + index_[d];
    for (std::size_t d = shape_.size(); d-- > 0;) {
      if (++index_[d] < static_cast<std::size_t>(shape_[d])) break;
      index_[d] = 0;
    }
    return at;
  }

 private:
  const std::vector<int>& shape_;
  std::vector<std::size_t> index_;
};

// ZIP (PKWARE's APPNOTE): for each file a local header and its bytes; then the directory, and its end.
constexpr std::uint32_t zip_local = 0x04034b50, zip_entry = 0x02014b50, zip_end = 0x06054b50;
constexpr std::uint16_t zip_version = 20, zip_stored = 0, zip_deflated = 8, zip_date = 0x21;  // 1980-01-01
constexpr std::size_t zip_local_size = 30, zip_entry_size = 46, zip_end_size = 22;

std::uint32_t crc_of(std::string_view bytes) {
  return static_cast<std::uint32_t>(crc32_z(0, reinterpret_cast<const Bytef*>(bytes.data()), bytes.size()));
}

[[noreturn]] void refuse_zip(std::string_view problem) {
  throw MeshError(fmt::format("{}; save it again with numpy.savez", problem));
}

template <class T>
T zip_number(std::string_view bytes, std::size_t at) {
  if (at > bytes.size() || sizeof(T) > bytes.size() - at) refuse_zip("the archive is cut short");
  return load<T>(bytes.data() + at, std::endian::little);
}

std::string_view zip_part(std::string_view bytes, std::size_t at, std::size_t size) {
  if (at > bytes.size() || size > bytes.size() - at) refuse_zip("the archive is cut short");
  return bytes.substr(at, size);
}

// What the directory says about a file.
struct ZipEntry {
  std::string name;
  std::uint16_t method;
  std::uint32_t crc, packed_size, size, offset;
};

// The contents of a file. As gzip has it, a packed one needs a header and the checksum at its end.
std::string zip_content(std::string_view bytes, const ZipEntry& entry) {
  if (zip_number<std::uint32_t>(bytes, entry.offset) != zip_local) refuse_zip("the archive is damaged");
  const std::size_t names = zip_number<std::uint16_t>(bytes, entry.offset + 26),
                    extra = zip_number<std::uint16_t>(bytes, entry.offset + 28);
  const std::string_view packed =
      zip_part(bytes, entry.offset + zip_local_size + names + extra, entry.packed_size);
  if (entry.method == zip_stored) {
    if (crc_of(packed) != entry.crc) refuse_zip("its bytes are damaged");
    return std::string(packed);
  }
  if (entry.method != zip_deflated) refuse_zip("it is compressed in a way that is not known");
  std::string stream("\x1f\x8b\x08\0\0\0\0\0\0\xff", 10);
  stream += packed;
  append_little_endian(stream, entry.crc, entry.size);
  return decompress(stream, entry.size);
}

std::vector<ZipEntry> zip_directory(std::string_view bytes) {
  const std::size_t end = bytes.rfind(std::string_view("PK\5\6", 4));
  if (end == bytes.npos || bytes.size() - end < zip_end_size) refuse_zip("the file is no ZIP archive");
  const int count = zip_number<std::uint16_t>(bytes, end + 10);
  std::size_t at = zip_number<std::uint32_t>(bytes, end + 16);
  std::vector<ZipEntry> entries;
  entries.reserve(count);
  for (int k = 0; k < count; ++k) {
    if (zip_number<std::uint32_t>(bytes, at) != zip_entry) refuse_zip("the archive's directory is damaged");
    const std::size_t names = zip_number<std::uint16_t>(bytes, at + 28),
                      more = zip_number<std::uint16_t>(bytes, at + 30) +
                             std::size_t{zip_number<std::uint16_t>(bytes, at + 32)};
    entries.push_back({std::string(zip_part(bytes, at + zip_entry_size, names)),
                       zip_number<std::uint16_t>(bytes, at + 10), zip_number<std::uint32_t>(bytes, at + 16),
                       zip_number<std::uint32_t>(bytes, at + 20), zip_number<std::uint32_t>(bytes, at + 24),
                       zip_number<std::uint32_t>(bytes, at + 42)});
    at += zip_entry_size + names + more;
  }
  return entries;
}

// The type in which numbers are written.
std::string_view written_type(const NumpyArray& array) {
  constexpr double least = std::numeric_limits<std::int32_t>::min(),
                   most = std::numeric_limits<std::int32_t>::max();
  if (!array.is_whole) return "<f8";
  return std::all_of(array.values.begin(), array.values.end(),
                     [](double value) { return value >= least && value <= most; })
             ? "<i4"
             : "<i8";
}

}  // namespace

NumpyArray parse_numpy_array(std::string_view bytes) {
  const NpyParts parts = split_npy(bytes);
  const NpyType numbers = npy_type(npy_entry(parts.header, "descr"));
  const bool by_columns = npy_entry(parts.header, "fortran_order").starts_with("True");
  NumpyArray array;
  array.shape = npy_shape(npy_entry(parts.header, "shape"));
  array.is_whole = numbers.is_whole;
  const std::size_t size = numbers.type->size;
  array.values.resize(npy_count(array.shape, parts.numbers.size() / size));
  ColumnOrder place(array.shape);
  for (std::size_t k = 0; k < array.values.size(); ++k)
    array.values[k] =
        numbers.type->load(parts.numbers.data() + (by_columns ? place.next() : k) * size, numbers.order);
  return array;
}

std::string serialize_numpy_array(const NumpyArray& array) {
  constexpr std::size_t before_header = 10, alignment = 64;
  const std::string_view type = written_type(array);
  std::string header = fmt::format("{{'descr': '{}', 'fortran_order': False, 'shape': ({}{}), }}", type,
                                   fmt::join(array.shape, ", "), array.shape.size() == 1 ? "," : "");
  header.append(alignment - 1 - (before_header + header.size()) % alignment, ' ');
  header += '\n';
  std::string bytes(npy_start);
  bytes += std::string_view("\x01\x00", 2);
  append_little_endian(bytes, static_cast<std::uint16_t>(header.size()));
  bytes += header;
  bytes.reserve(bytes.size() + sizeof(double) * array.values.size());
  for (const double value : array.values) {
    if (type == "<i4") {
      append_little_endian(bytes, static_cast<std::int32_t>(value));
    } else if (type == "<i8") {
      append_little_endian(bytes, static_cast<std::int64_t>(value));
    } else {
      append_little_endian(bytes, value);
    }
  }
  return bytes;
}

NumpyArchive parse_numpy_archive(std::string_view bytes) {
  NumpyArchive archive;
  for (const ZipEntry& entry : zip_directory(bytes)) {
    if (!entry.name.ends_with(".npy")) continue;
    const std::string name = entry.name.substr(0, entry.name.size() - 4);
    try {
      archive.emplace_back(name, parse_numpy_array(zip_content(bytes, entry)));
    } catch (const MeshError& error) {
      throw MeshError(fmt::format("the array '{}': {}", name, error.what()));
    }
  }
  return archive;
}

std::string serialize_numpy_archive(const NumpyArchive& archive) {
  std::string bytes, directory;
  for (const auto& [array_name, array] : archive) {
    const std::string content = serialize_numpy_array(array), name = fmt::format("{}.npy", array_name);
    if (bytes.size() + content.size() > std::numeric_limits<std::uint32_t>::max() / 2)
      throw MeshError("an .npz may have 2 GB; write the values as .npy, or take a coarser grid");
    const auto offset = static_cast<std::uint32_t>(bytes.size()), crc = crc_of(content),
               size = static_cast<std::uint32_t>(content.size());
    const auto name_size = static_cast<std::uint16_t>(name.size());
    const std::uint16_t none = 0;
    append_little_endian(bytes, zip_local, zip_version, none, zip_stored, none, zip_date, crc, size, size,
                         name_size, none);
    bytes += name;
    bytes += content;
    append_little_endian(directory, zip_entry, zip_version, zip_version, none, zip_stored, none, zip_date,
                         crc, size, size, name_size, none, none, none, none, std::uint32_t{0}, offset);
    directory += name;
  }
  const auto count = static_cast<std::uint16_t>(archive.size());
  const auto at = static_cast<std::uint32_t>(bytes.size()),
             size = static_cast<std::uint32_t>(directory.size());
  bytes += directory;
  append_little_endian(bytes, zip_end, std::uint16_t{0}, std::uint16_t{0}, count, count, size, at,
                       std::uint16_t{0});
  return bytes;
}

}  // namespace orbitutte
