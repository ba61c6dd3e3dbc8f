// SPDX-License-Identifier: MIT
#include "orbitutte/io/ply_header.h"

#include <fmt/format.h>

#include "orbitutte/io/text_scanner.h"
#include "orbitutte/types.h"

namespace orbitutte {

namespace {

struct TypeRow {
  PlyType type;
  std::string_view name;
  std::string_view other_name;
};

constexpr TypeRow types[] = {{PlyType::int8, "char", "int8"},        {PlyType::uint8, "uchar", "uint8"},
                             {PlyType::int16, "short", "int16"},     {PlyType::uint16, "ushort", "uint16"},
                             {PlyType::int32, "int", "int32"},       {PlyType::uint32, "uint", "uint32"},
                             {PlyType::int64, "int64", "longlong"},  {PlyType::uint64, "uint64", "ulonglong"},
                             {PlyType::float32, "float", "float32"}, {PlyType::float64, "double", "float64"}};

std::string_view trimmed(std::string_view text) {
  constexpr std::string_view blanks = " \t\r\n";
  const std::size_t begin = text.find_first_not_of(blanks);
  return begin == text.npos ? "" : text.substr(begin, text.find_last_not_of(blanks) + 1 - begin);
}

/// The size of the header up to and including the line break after `end_header`. All lines end like the
/// first one, so data that begin with the byte of a line break stay whole.
std::size_t size_of_header(std::string_view bytes) {
  const std::size_t first_end = bytes.find_first_of("\r\n");
  if (first_end == bytes.npos || trimmed(bytes.substr(0, first_end)) != "ply") {
    throw MeshError("line 1: the file does not begin with a line 'ply'; check that it is a PLY file");
  }
  const bool ends_with_return = bytes[first_end] == '\r' && !bytes.substr(first_end).starts_with("\r\n");
  const char line_end = ends_with_return ? '\r' : '\n';
  for (std::size_t begin = 0; begin < bytes.size();) {
    const std::size_t end = std::min(bytes.find(line_end, begin), bytes.size());
    if (trimmed(bytes.substr(begin, end - begin)) == "end_header") return std::min(end + 1, bytes.size());
    begin = end + 1;
  }
  throw MeshError("the header has no line 'end_header', so it is cut short; export the file again");
}

PlyType to_type(const TextScanner& in, std::string_view word) {
  for (const TypeRow& row : types) {
    if (word == row.name || word == row.other_name) return row.type;
  }
  in.refuse(fmt::format("{} is not a type of PLY properties", in_quotes(word)));
}

std::string read_name(TextScanner& in, std::string_view owner) {
  const std::string_view word = in.word();
  if (word.empty()) in.refuse(fmt::format("the {} has no name", owner));
  return std::string(word);
}

void read_format(TextScanner& in, PlyHeader& header) {
  const std::string_view word = in.word();
  if (word == "ascii") {
    header.byte_order = std::nullopt;
  } else if (word == "binary_little_endian") {
    header.byte_order = std::endian::little;
  } else if (word == "binary_big_endian") {
    header.byte_order = std::endian::big;
  } else {
    in.refuse(fmt::format("the format {} is none of ascii, binary_little_endian and binary_big_endian",
                          in_quotes(word)));
  }
}

PlyElement read_element(TextScanner& in) {
  PlyElement element;
  element.name = read_name(in, "element");
  const std::string_view count = in.word();
  if (count.empty()) in.refuse(fmt::format("the element {} has no count", in_quotes(element.name)));
  if (parse_number(count, element.count) != NumberError::none) {
    in.refuse(fmt::format("the element {} has the count {}, which is not a count", in_quotes(element.name),
                          in_quotes(count)));
  }
  return element;
}

PlyProperty read_property(TextScanner& in) {
  PlyProperty property;
  std::string_view type = in.word();
  property.is_list = type == "list";
  if (property.is_list) {
    property.count_type = to_type(in, in.word());
    if (!is_integer(property.count_type)) in.refuse("the length of a list has a type that is not an integer");
    type = in.word();
  }
  property.type = to_type(in, type);
  property.name = read_name(in, "property");
  return property;
}

/// Reads the line that the keyword begins.
void read_line(TextScanner& in, std::string_view keyword, PlyHeader& header) {
  PlyFile& file = header.file;
  if (keyword == "format") {
    read_format(in, header);
  } else if (keyword == "comment") {
    file.comments.emplace_back(trimmed(in.rest_of_line()));
  } else if (keyword == "element") {
    file.elements.push_back(read_element(in));
  } else if (keyword == "property") {
    if (file.elements.empty()) in.refuse("a property stands before the first element");
    file.elements.back().properties.push_back(read_property(in));
  } else if (keyword != "ply" && keyword != "obj_info" && keyword != "end_header") {
    in.refuse(fmt::format("{} is not a keyword of PLY headers", in_quotes(keyword)));
  }
  in.rest_of_line();
}

/// The bytes that one element takes at least.
std::size_t least_size(const PlyElement& element, bool is_binary) {
  std::size_t size = 0;
  for (const PlyProperty& property : element.properties) {
    const std::size_t digit_and_blank = 2;
    size += is_binary ? size_of(property.is_list ? property.count_type : property.type) : digit_and_blank;
  }
  return size;
}

void check_promises(const PlyHeader& header, std::size_t data_size) {
  const bool is_binary = header.byte_order.has_value();
  std::size_t left = is_binary ? data_size : data_size + 1;  // the last line may lack its line break
  for (const PlyElement& element : header.file.elements) {
    const std::size_t least = least_size(element, is_binary);
    if (least == 0) continue;
    if (element.count > left / least) {
      throw MeshError(
          fmt::format("the header promises {} elements {}, more than the rest of the file can hold, so that "
                      "the file is cut short "
                      "or its header wrong; export it again",
                      element.count, in_quotes(element.name)));
    }
    left -= element.count * least;
  }
}

std::string in_one_line(std::string text) {
  for (char& c : text) {
    if (c == '\n' || c == '\r') c = ' ';
  }
  return text;
}

}  // namespace

std::string_view ply_type_name(PlyType type) { return types[static_cast<int>(type)].name; }

PlyHeader parse_ply_header(std::string_view bytes) {
  PlyHeader header;
  header.size = size_of_header(bytes);
  bool has_format = false;
  TextScanner in(bytes.substr(0, header.size), {});
  while (in.find_word()) {
    const std::string_view keyword = in.word();
    has_format = has_format || keyword == "format";
    read_line(in, keyword, header);
  }
  if (!has_format) in.refuse("the header has no line 'format'");
  header.lines = in.line() - 1;
  check_promises(header, bytes.size() - header.size);
  return header;
}

std::string serialize_ply_header(const PlyFile& file) {
  std::string text = "ply\nformat binary_little_endian 1.0\n";
  for (const std::string& comment : file.comments) text += fmt::format("comment {}\n", in_one_line(comment));
  for (const PlyElement& element : file.elements) {
    text += fmt::format("element {} {}\n", element.name, element.count);
    for (const PlyProperty& property : element.properties) {
      const std::string list =
          property.is_list ? fmt::format("list {} ", ply_type_name(property.count_type)) : "";
      text += fmt::format("property {}{} {}\n", list, ply_type_name(property.type), property.name);
    }
  }
  return text + "end_header\n";
}

}  // namespace orbitutte
