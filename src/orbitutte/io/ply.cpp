// SPDX-License-Identifier: MIT
// PLY, after Greg Turk, "The PLY Polygon File Format", 1994.
#include "orbitutte/io/ply.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <type_traits>

#include "orbitutte/io/bytes.h"
#include "orbitutte/io/ply_header.h"
#include "orbitutte/io/text_scanner.h"
#include "orbitutte/types.h"

namespace orbitutte {

namespace {

// Is the value one that numbers of this type have?
template <class T>
bool holds(double value) {
  if (!std::is_integral_v<T>) return true;
  // For each type, the largest value plus one is a double; the largest value of 64 bits itself is not.
  const double one_too_many = std::ldexp(1.0, std::numeric_limits<T>::digits);
  return value == std::trunc(value) && value < one_too_many &&
         value >= static_cast<double>(std::numeric_limits<T>::min());
}

// Values are kept as doubles, which have fewer digits than whole numbers of 64 bits.
template <class Values, class T>
double as_double(const Values& in, T number, const TextItem& item, std::string_view property) {
  const auto value = static_cast<double>(number);
  if constexpr (std::is_integral_v<T> && std::numeric_limits<T>::digits > std::numeric_limits<double>::digits)
    if (!holds<T>(value) || static_cast<T>(value) != number)
      in.refuse(fmt::format("{} has the value {} as {}, more digits than a double has", shown(item), number,
                            in_quotes(property)));
  return value;
}

/// The values of ASCII data, one after the other. An element begins on a line of its own and may run over
/// several lines.
class AsciiValues {
 public:
  AsciiValues(std::string_view data, int first_line) : in_(data, {}, first_line) {}

  void begin(const TextItem& item) {
    if (in_.find_word()) return;
    in_.refuse(fmt::format("the text ends before {}", shown(item)));
  }

  double next(PlyType type, const TextItem& item, std::string_view property) {
    if (!in_.find_word()) in_.refuse(fmt::format("the text ends within {}", shown(item)));
    return visit_type(type, [&](auto number) -> double {
      using T = decltype(number);
      using Read = std::conditional_t<std::is_integral_v<T>, T, double>;  // floats with all their digits
      return as_double(*this, in_.number<Read>(item, property), item, property);
    });
  }

  void append_list(std::vector<double>& values, std::size_t length, PlyType type, const TextItem& item,
                   std::string_view property) {
    for (std::size_t i = 0; i < length; ++i) values.push_back(next(type, item, property));
  }

  void end(const TextItem& item) {
    if (!in_.find_word_in_line()) return;
    in_.refuse(fmt::format("{} follows after the last property of {}", in_quotes(in_.word()), shown(item)));
  }

  void end_of_file() {
    if (!in_.find_word()) return;
    in_.refuse(
        fmt::format("{} follows after the last element that the header promises", in_quotes(in_.word())));
  }

  [[noreturn]] void refuse(std::string_view problem) const { in_.refuse(problem); }

 private:
  TextScanner in_;
};

/// The values of binary data, one after the other.
class BinaryValues {
 public:
  BinaryValues(std::string_view bytes, std::size_t header_size, std::endian order)
      : bytes_(bytes), at_(header_size), order_(order) {}

  void begin(const TextItem&) {}

  double next(PlyType type, const TextItem& item, std::string_view property) {
    return visit_type(type, [&](auto number) -> double {
      return as_double(*this, load<decltype(number)>(take(sizeof(number), item, property), order_), item,
                       property);
    });
  }

  void append_list(std::vector<double>& values, std::size_t length, PlyType type, const TextItem& item,
                   std::string_view property) {
    visit_type(type, [&](auto number) {
      const char* bytes = take(length * sizeof(number), item, property);
      for (std::size_t i = 0; i < length; ++i) {
        const auto value = load<decltype(number)>(bytes + i * sizeof(number), order_);
        values.push_back(as_double(*this, value, item, property));
      }
    });
  }

  void end(const TextItem&) {}

  void end_of_file() {
    if (bytes_.find_first_not_of(" \t\r\n", at_) == bytes_.npos) return;
    refuse(
        fmt::format("{} bytes follow after the last element that the header promises", bytes_.size() - at_));
  }

  [[noreturn]] void refuse(std::string_view problem) const {
    throw MeshError(fmt::format("byte {}: {}; export the file again", at_, problem));
  }

 private:
  const char* take(std::size_t size, const TextItem& item, std::string_view property) {
    if (bytes_.size() - at_ < size) {
      refuse(fmt::format("the file ends within {}, property {}", shown(item), in_quotes(property)));
    }
    at_ += size;
    return bytes_.data() + at_ - size;
  }

  std::string_view bytes_;
  std::size_t at_;
  std::endian order_;
};

template <class Values>
void read_list(Values& in, const TextItem& item, PlyProperty& property) {
  constexpr double longest = std::numeric_limits<int>::max();
  const double length = in.next(property.count_type, item, "list length");
  if (length < 0 || length > longest) {
    in.refuse(fmt::format("{} has a list {} of length {}", shown(item), in_quotes(property.name), length));
  }
  in.append_list(property.values, static_cast<std::size_t>(length), property.type, item, property.name);
  property.list_start.push_back(property.values.size());
}

template <class Values>
void read_element(Values& in, PlyElement& element) {
  for (PlyProperty& property : element.properties) {
    if (property.is_list) {
      property.list_start.reserve(element.count + 1);
      property.list_start.push_back(0);
    } else {
      property.values.reserve(element.count);
    }
  }
  // Elements without properties take no bytes, so nothing has limited their count.
  const std::size_t count = element.properties.empty() ? 0 : element.count;
  for (std::size_t i = 0; i < count; ++i) {
    const TextItem item = {element.name, i};
    in.begin(item);
    for (PlyProperty& property : element.properties) {
      if (property.is_list) {
        read_list(in, item, property);
      } else {
        property.values.push_back(in.next(property.type, item, property.name));
      }
    }
    in.end(item);
  }
}

template <class Values>
void read_elements(Values in, PlyFile& file) {
  for (PlyElement& element : file.elements) read_element(in, element);
  in.end_of_file();
}

bool are_lists(const std::vector<std::size_t>& start, std::size_t count, std::size_t values) {
  return start.size() == count + 1 && start.front() == 0 && start.back() == values &&
         std::is_sorted(start.begin(), start.end());
}

void check_size(const PlyElement& element, const PlyProperty& property) {
  const std::size_t values = property.values.size();
  if (property.is_list ? are_lists(property.list_start, element.count, values) : values == element.count)
    return;
  throw ArgumentError(fmt::format("property '{}' does not have one value for each of {} elements '{}'",
                                  property.name, element.count, element.name));
}

void append(std::string& bytes, PlyType type, double value, const PlyProperty& property) {
  visit_type(type, [&](auto number) {
    using T = decltype(number);
    if (!holds<T>(value)) {
      throw ArgumentError(fmt::format("property '{}' has the value {}, which is not of type {}",
                                      property.name, value, ply_type_name(type)));
    }
    append_little_endian(bytes, static_cast<T>(value));
  });
}

void append_property(std::string& bytes, const PlyProperty& property, std::size_t i) {
  if (!property.is_list) return append(bytes, property.type, property.values[i], property);
  const std::size_t begin = property.list_start[i], end = property.list_start[i + 1];
  append(bytes, property.count_type, static_cast<double>(end - begin), property);
  for (std::size_t k = begin; k < end; ++k) append(bytes, property.type, property.values[k], property);
}

template <class Named>
const Named* find_named(const std::vector<Named>& all, std::string_view wanted) {
  const auto found =
      std::find_if(all.begin(), all.end(), [&](const Named& one) { return one.name == wanted; });
  return found == all.end() ? nullptr : &*found;
}

}  // namespace

const PlyProperty* PlyElement::find(std::string_view property) const {
  return find_named(properties, property);
}

const PlyElement* PlyFile::find(std::string_view element) const { return find_named(elements, element); }

PlyFile parse_ply(std::string_view bytes) {
  PlyHeader header = parse_ply_header(bytes);
  if (header.byte_order) {
    read_elements(BinaryValues(bytes, header.size, *header.byte_order), header.file);
  } else {
    read_elements(AsciiValues(bytes.substr(header.size), header.lines + 1), header.file);
  }
  return std::move(header.file);
}

void append_element(std::string& bytes, const PlyElement& element) {
  for (const PlyProperty& property : element.properties) check_size(element, property);
  const std::size_t count = element.properties.empty() ? 0 : element.count;
  for (std::size_t i = 0; i < count; ++i) {
    for (const PlyProperty& property : element.properties) append_property(bytes, property, i);
  }
}

std::string serialize_ply(const PlyFile& file) {
  std::string bytes = serialize_ply_header(file);
  for (const PlyElement& element : file.elements) append_element(bytes, element);
  return bytes;
}

}  // namespace orbitutte
