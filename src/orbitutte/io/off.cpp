// SPDX-License-Identifier: MIT
// OFF, text and binary, after the Geomview manual, section 4.2.5.
#include <fmt/compile.h>
#include <fmt/format.h>

#include <cstdint>
#include <iterator>
#include <optional>

#include "orbitutte/io/big_endian_bytes.h"
#include "orbitutte/io/mesh_formats.h"
#include "orbitutte/io/text_colours.h"
#include "orbitutte/io/text_scanner.h"

namespace orbitutte {

namespace {

constexpr TextScanner::Syntax off_syntax = {.comment = '#'};

/// What the keyword says about the columns after a vertex's coordinates.
struct Columns {
  bool has_normals = false;
  /// After the normals.
  bool has_colours = false;
};

struct Header {
  Columns columns;
  int vertices = 0;
  int faces = 0;
};

bool take_prefix(std::string_view& word, std::string_view prefix) {
  if (!word.starts_with(prefix)) return false;
  word.remove_prefix(prefix.size());
  return true;
}

/// What the first word says.
struct Keyword {
  Columns columns;
  /// Of vertices, if there is no blank before it, as in ModelNet's "OFF6 8 0"
  std::string_view count;
};

bool is_digits(std::string_view word) { return word.find_first_not_of("0123456789") == word.npos; }

/// The keyword is OFF after any of the prefixes ST (texture), C (colour) and N (normal), in this order.
/// Nothing if the word is something else.
std::optional<Keyword> parse_keyword(std::string_view word) {
  take_prefix(word, "ST");
  Keyword keyword;
  keyword.columns.has_colours = take_prefix(word, "C");
  keyword.columns.has_normals = take_prefix(word, "N");
  if (!take_prefix(word, "OFF") && !take_prefix(word, "off")) return std::nullopt;
  if (!is_digits(word)) return std::nullopt;
  keyword.count = word;
  return keyword;
}

bool names_other_dimension(std::string_view word) {
  return word.ends_with("OFF") && word.find_first_of("4n") != word.npos;
}

int to_count(const TextScanner& in, std::string_view word, std::string_view things) {
  int count = 0;
  if (parse_number(word, count) == NumberError::none && count >= 0) return count;
  if (word.empty()) in.refuse(fmt::format("the header lacks the number of {}", things));
  in.refuse(fmt::format("the header has {} where the number of {} belongs", in_quotes(word), things));
}

/// Throws MeshError if the rest of the text cannot hold so much, before memory is taken for it.
void check_promise(const TextScanner& in, const Header& counts) {
  constexpr std::size_t least_vertex = std::string_view("0 0 0\n").size();
  constexpr std::size_t least_face = std::string_view("0\n").size();
  const std::size_t least = counts.vertices * least_vertex + counts.faces * least_face;
  if (least <= in.bytes_left() + 1) return;  // the last line may lack its line break
  in.refuse(fmt::format("the header promises {} vertices and {} faces, but only {} bytes follow",
                        counts.vertices, counts.faces, in.bytes_left()));
}

/// The keyword, which may be missing, and the counts of vertices, faces and edges on its line or the next.
/// After a keyword the count of edges may be missing.
Header read_header(TextScanner& in) {
  in.find_word();
  std::string_view word = in.word();
  if (names_other_dimension(word)) {
    in.refuse(fmt::format("{} announces points of a dimension other than three", in_quotes(word)));
  }
  const std::optional<Keyword> keyword = parse_keyword(word);
  if (keyword) word = keyword->count;
  if (word.empty()) {
    in.find_word();
    word = in.word();
  }
  Header counts;
  if (keyword) counts.columns = keyword->columns;
  counts.vertices = to_count(in, word, "vertices");
  counts.faces = to_count(in, in.word(), "faces");
  const std::string_view edges = in.word();
  if (!keyword || !edges.empty()) to_count(in, edges, "edges");
  if (in.find_word_in_line()) in.refuse("the header has more than three counts");
  check_promise(in, counts);
  return counts;
}

/// Goes to where the item, one of `count`, begins.
void find_item(TextScanner& in, const TextItem& item, int count) {
  if (in.find_word()) return;
  in.refuse(fmt::format("the text ends before {}, but the header promises {}", shown(item), count));
}

/// Where one item ends and the next begins.
enum class Layout {
  /// Every item has a line; what follows it there are columns, which may be ignored.
  lines,
  /// Numbers without such columns, in any lines.
  stream
};

/// Takes a number of the item; in a stream, from whichever line has the next one.
template <class T>
T next_number(TextScanner& in, Layout layout, const TextItem& item, std::string_view what) {
  if (layout == Layout::stream) in.find_word();
  return in.number<T>(item, what);
}

/// What follows the coordinates. Texture coordinates are ignored, and so is everything that the keyword does
/// not name.
void read_columns(TextScanner& in, const TextItem& vertex, const Columns& columns, TextColours& colours) {
  if (columns.has_normals)
    for (int axis = 0; axis < 3; ++axis) in.word();
  const NextWords further = take_next_words(in);
  if (columns.has_colours && !further[0].empty()) colours.add(in, vertex, further);
}

void read_vertices(TextScanner& in, const Header& header, Layout layout, PolygonMesh& mesh) {
  mesh.V.resize(header.vertices, 3);
  TextColours colours;
  for (int v = 0; v < header.vertices; ++v) {
    const TextItem vertex = {"vertex", static_cast<std::size_t>(v)};
    find_item(in, vertex, header.vertices);
    for (int axis = 0; axis < 3; ++axis)
      mesh.V(v, axis) = next_number<double>(in, layout, vertex, "coordinate");
    if (layout == Layout::lines) read_columns(in, vertex, header.columns, colours);
  }
  give_colours(colours.colours(header.vertices), mesh);
}

void read_faces(TextScanner& in, int count, Layout layout, PolygonMesh& mesh) {
  mesh.face_start.reserve(count + std::size_t{1});
  mesh.corners.reserve(3 * static_cast<std::size_t>(count));
  for (int f = 0; f < count; ++f) {
    const TextItem face = {"face", static_cast<std::size_t>(f)};
    find_item(in, face, count);
    const int degree = in.number<int>(face, "number of corners");
    if (degree < 0) in.refuse(fmt::format("face {} has {} corners", f, degree));
    for (int corner = 0; corner < degree; ++corner)
      mesh.corners.push_back(next_number<int>(in, layout, face, "index"));
    if (layout == Layout::lines) in.skip_words();  // colours
    end_face(mesh);
  }
}

/// Everything after the header, to the end of the text.
PolygonMesh read_items(TextScanner in, const Header& header, Layout layout) {
  PolygonMesh mesh;
  read_vertices(in, header, layout, mesh);
  read_faces(in, header.faces, layout, mesh);
  if (in.find_word()) {
    in.refuse(fmt::format("{} follows after the {} vertices and {} faces that the header promises",
                          in_quotes(in.word()), header.vertices, header.faces));
  }
  return mesh;
}

/// Nothing if the text is not such a stream to its last number.
std::optional<PolygonMesh> read_stream(const TextScanner& in, const Header& header) {
  if (header.columns.has_normals || header.columns.has_colours) return std::nullopt;
  try {
    return read_items(in, header, Layout::stream);
  } catch (const MeshError&) {
    return std::nullopt;
  }
}

/// What stands before the numbers of a binary file.
struct BinaryOff {
  Columns columns;
  /// Texture coordinates, behind the colours.
  bool has_texture = false;
  std::string_view numbers;
};

/// Nothing if the word BINARY does not follow the keyword.
std::optional<BinaryOff> parse_binary_start(std::string_view text) {
  TextScanner in(text, off_syntax);
  in.find_word();
  const std::string_view word = in.word();
  const std::optional<Keyword> keyword = parse_keyword(word);
  if (!keyword || !keyword->count.empty() || in.word() != "BINARY") return std::nullopt;
  const std::size_t end = text.find('\n', static_cast<std::size_t>(word.data() - text.data()));
  const std::string_view numbers = end == text.npos ? std::string_view() : text.substr(end + 1);
  return BinaryOff{keyword->columns, word.starts_with("ST"), numbers};
}

void read_binary_vertices(BigEndianBytes& in, const BinaryOff& start, int count, PolygonMesh& mesh) {
  const auto take = [&] { return static_cast<double>(in.take<float>("a number of a vertex")); };
  mesh.V.resize(count, 3);
  Points colours(start.columns.has_colours ? count : 0, 3);
  for (int v = 0; v < count; ++v) {
    for (double& x : mesh.V.row(v)) x = take();
    if (start.columns.has_normals)
      for (int axis = 0; axis < 3; ++axis) take();
    if (start.columns.has_colours) {
      for (double& channel : colours.row(v)) channel = take();
      take();  // alpha
    }
    if (start.has_texture)
      for (int axis = 0; axis < 2; ++axis) take();
  }
  if (start.columns.has_colours) give_colours(colours_of_numbers(colours), mesh);
}

void read_binary_faces(BigEndianBytes& in, int count, PolygonMesh& mesh) {
  mesh.face_start.reserve(count + std::size_t{1});
  for (int f = 0; f < count; ++f) {
    const int degree = in.take_count("the number of a face's corners", sizeof(std::int32_t));
    for (int k = 0; k < degree; ++k) mesh.corners.push_back(in.take<std::int32_t>("a corner"));
    end_face(mesh);
    const int colours = in.take_count("the number of a face's colours", sizeof(float));
    for (int k = 0; k < colours; ++k) in.take<float>("a colour");
  }
}

PolygonMesh read_binary_off(const BinaryOff& start) {
  constexpr std::size_t least_vertex = 3 * sizeof(float), least_face = 2 * sizeof(std::int32_t);
  BigEndianBytes in(start.numbers, " behind the first line");
  const auto vertices = in.take<std::int32_t>("the number of vertices"),
             faces = in.take<std::int32_t>("the number of faces");
  in.take<std::int32_t>("the number of edges");
  in.require_room(vertices, "the number of vertices", least_vertex);
  in.require_room(faces, "the number of faces", least_face);
  PolygonMesh mesh;
  read_binary_vertices(in, start, vertices, mesh);
  read_binary_faces(in, faces, mesh);
  if (in.bytes_left() > 0) in.refuse("bytes follow after the last face");
  return mesh;
}

}  // namespace

PolygonMesh read_off(std::string_view text) {
  if (const std::optional<BinaryOff> start = parse_binary_start(text)) return read_binary_off(*start);
  TextScanner in(text, off_syntax);
  const Header header = read_header(in);
  try {
    return read_items(in, header, Layout::lines);
  } catch (const MeshError&) {
    if (std::optional<PolygonMesh> mesh = read_stream(in, header)) return std::move(*mesh);
    throw;
  }
}

std::string write_off(const Mesh& mesh) {
  std::string text = room_for_text(mesh);
  const auto out = std::back_inserter(text);
  fmt::format_to(out, "OFF\n{} {} 0\n", mesh.V.rows(), mesh.F.rows());
  for (const auto& position : mesh.V.rowwise()) {
    fmt::format_to(out, FMT_COMPILE("{} {} {}\n"), position[0], position[1], position[2]);
  }
  for (const auto& face : mesh.F.rowwise()) {
    fmt::format_to(out, FMT_COMPILE("3 {} {} {}\n"), face[0], face[1], face[2]);
  }
  return text;
}

}  // namespace orbitutte
