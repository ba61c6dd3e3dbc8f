// SPDX-License-Identifier: MIT
// Values at vertices as text: a line for each vertex.
#include <fmt/compile.h>
#include <fmt/format.h>

#include <algorithm>
#include <iterator>

#include "orbitutte/io/text_scanner.h"
#include "orbitutte/io/vertex_data_formats.h"
#include "orbitutte/types.h"

namespace orbitutte {
namespace {

constexpr std::string_view byte_order_mark = "\xEF\xBB\xBF";

// Ends a line or a name.
bool is_line_break(char c) { return c == '\n' || c == '\r'; }

// Takes a line with its end; one that ends with "\r\n" is followed by an empty one.
std::string_view take_line(std::string_view& text) {
  const auto* const end = std::find_if(text.begin(), text.end(), is_line_break);
  const auto size = static_cast<std::size_t>(end - text.begin());
  const std::string_view line = text.substr(0, size);
  text.remove_prefix(std::min(size + 1, text.size()));
  return line;
}

bool begins_as_number(std::string_view word) {
  double value = 0;
  return parse_number(word, value) != NumberError::malformed;
}

// The line of names that the text begins with; empty if it begins with numbers.
std::string_view header_of(std::string_view text) {
  while (!text.empty()) {
    const std::string_view line = take_line(text);
    const std::size_t first = line.find_first_not_of(" \t");
    if (first == line.npos || line[first] == '#') continue;
    const std::string_view rest = line.substr(first);
    return begins_as_number(rest.substr(0, rest.find_first_of(" \t,;#"))) ? std::string_view() : rest;
  }
  return {};
}

// One name: between quotes, in which two quotes are one, or up to the next comma.
std::string take_name(std::string_view& line) {
  line.remove_prefix(std::min(line.find_first_not_of(" \t"), line.size()));
  std::string name;
  if (line.starts_with('"')) {
    for (line.remove_prefix(1); !line.empty(); line.remove_prefix(1)) {
      if (line.starts_with("\"\""))
        line.remove_prefix(1);
      else if (line.front() == '"')
        break;
      name += line.front();
    }
  } else {
    name = line.substr(0, line.find(','));
    name.erase(name.find_last_not_of(" \t") + 1);
  }
  const std::size_t comma = line.find(',');
  line.remove_prefix(std::min(comma, line.size()));
  return name;
}

std::vector<std::string> names_in(std::string_view line) {
  std::vector<std::string> names = {take_name(line)};
  while (line.starts_with(',')) {
    line.remove_prefix(1);
    names.push_back(take_name(line));
  }
  return names;
}

// Names that blanks separate, if no comma does.
std::vector<std::string> words_in(std::string_view line) {
  std::vector<std::string> words;
  for (TextScanner in(line, {}); in.find_word();) words.emplace_back(in.word());
  return words;
}

std::vector<std::string> header_names(std::string_view line) {
  return line.find_first_of(",\"") == line.npos ? words_in(line) : names_in(line);
}

// The numbers of all lines, and how many each line has.
struct TextRows {
  std::vector<double> values;
  std::size_t rows = 0, columns = 0;
};

TextRows read_rows(TextScanner& in) {
  TextRows result;
  while (in.find_word()) {
    const TextItem vertex = {"vertex", result.rows};
    const std::size_t before = result.values.size();
    do {
      result.values.push_back(in.number<double>(vertex, "value"));
    } while (in.find_word_in_line());
    const std::size_t columns = result.values.size() - before;
    if (result.rows > 0 && columns != result.columns)
      in.refuse(fmt::format("vertex {} has {} values, but those before it have {}", result.rows, columns,
                            result.columns));
    result.columns = columns;
    ++result.rows;
  }
  return result;
}

// As RFC 4180 has it, without line breaks.
std::string csv_name(std::string_view name) {
  std::string quoted = "\"";
  for (const char c : name) {
    if (c == '"') quoted += '"';
    quoted += is_line_break(c) ? ' ' : c;
  }
  return quoted += '"';
}

std::string write_lines(const VertexData& data, char separator) {
  std::string text;
  const auto out = std::back_inserter(text);
  for (Eigen::Index v = 0; v < data.values.rows(); ++v)
    for (Eigen::Index map = 0; map < data.values.cols(); ++map)
      fmt::format_to(out, FMT_COMPILE("{}{}"), data.values(v, map),
                     map + 1 == data.values.cols() ? '\n' : separator);
  return text;
}

}  // namespace

VertexData read_text_data(std::string_view text) {
  if (text.starts_with(byte_order_mark)) text.remove_prefix(byte_order_mark.size());
  const std::string_view header = header_of(text);
  std::vector<std::string> names;
  if (!header.empty()) names = header_names(header);
  std::string rows(text);
  const std::size_t behind_header =
      header.empty() ? 0 : static_cast<std::size_t>(header.end() - text.begin());
  std::fill_n(rows.begin(), behind_header, ' ');  // keeps positions, and lines as far as there is one
  std::replace(rows.begin(), rows.end(), ',', ' ');
  TextScanner in(rows, {.comment = '#'},
                 1 + static_cast<int>(std::count(
                         text.begin(), text.begin() + static_cast<std::ptrdiff_t>(behind_header), '\n')));
  const TextRows read = read_rows(in);
  if (read.rows == 0)
    throw MeshError("the file has no line of numbers; check that it is a file of values at vertices");
  if (!names.empty() && names.size() != read.columns)
    throw MeshError(fmt::format("the first line has {} names, but the others have {} values; mend the file",
                                names.size(), read.columns));
  VertexData data;
  data.values = Eigen::Map<const Eigen::Matrix<double, -1, -1, Eigen::RowMajor>>(
      read.values.data(), static_cast<Eigen::Index>(read.rows), static_cast<Eigen::Index>(read.columns));
  set_map_names(data, std::move(names));
  return data;
}

std::string write_text_data(const VertexData& data) { return write_lines(data, ' '); }

std::string write_csv(const VertexData& data) {
  std::string text;
  for (const std::string& name : data.names) {
    if (!text.empty()) text += ',';
    text += csv_name(name);
  }
  if (!text.empty()) text += '\n';
  return text + write_lines(data, ',');
}

}  // namespace orbitutte
