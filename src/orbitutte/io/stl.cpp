// SPDX-License-Identifier: MIT
// STL: triangles without indices, as ASCII or binary. Corners at the same position are welded into one
// vertex.
#include <fmt/format.h>

#include <Eigen/Geometry>
#include <array>
#include <bit>
#include <cstdint>
#include <utility>

#include "orbitutte/io/bytes.h"
#include "orbitutte/io/mesh_formats.h"
#include "orbitutte/io/text_scanner.h"
#include "orbitutte/mesh/point_numbers.h"

namespace orbitutte {

namespace {

constexpr std::size_t title_size = 80;
constexpr std::size_t header_size = title_size + sizeof(std::uint32_t);
constexpr std::size_t vector_size = 3 * sizeof(float);
constexpr std::uint16_t no_attribute = 0;
constexpr std::size_t facet_size = 4 * vector_size + sizeof(no_attribute);  // normal, corners, attribute

using Position = PointNumbers::Point;

/// The facets of a file, with their corners welded.
class Facets {
 public:
  explicit Facets(std::size_t expected = 0) : welder_(expected / 2) {  // as many as closed surfaces have
    mesh_.corners.reserve(3 * expected);
    mesh_.face_start.reserve(expected + 1);
  }

  /// A facet with two corners at the same position has no area, and no place in a welded mesh: its other two
  /// edges are one. It is left out.
  void add(const std::array<Position, 3>& corners) {
    const auto& [a, b, c] = corners;
    if (a == b || b == c || c == a) {
      if (left_out_++ == 0) first_left_out_ = count_;
    } else {
      for (const Position& corner : corners) mesh_.corners.push_back(welder_.number_of(corner));
      end_face(mesh_);
    }
    ++count_;
  }

  /// Those left out included.
  std::size_t count() const { return count_; }

  PolygonMesh mesh() && {
    mesh_.V = to_points(welder_.coordinates());
    if (left_out_ > 0)
      mesh_.warnings.push_back(
          fmt::format("facet {} has two corners at the same point{}: it is left out, and the faces are "
                      "numbered without it",
                      first_left_out_, left_out_ > 1 ? fmt::format(" ({} such facets)", left_out_) : ""));
    return std::move(mesh_);
  }

 private:
  PointNumbers welder_;
  PolygonMesh mesh_;
  std::size_t count_ = 0, left_out_ = 0, first_left_out_ = 0;
};

bool equal_in_any_case(std::string_view word, std::string_view lower_case) {
  const auto equal = [](char a, char b) { return a == b || (a >= 'A' && a <= 'Z' && a - 'A' + 'a' == b); };
  return std::equal(word.begin(), word.end(), lower_case.begin(), lower_case.end(), equal);
}

/// Goes on to the next word, which must be the keyword.
void expect(TextScanner& in, std::string_view keyword, const TextItem& facet) {
  if (!in.find_word()) {
    in.refuse(fmt::format("the text ends within facet {}, where '{}' belongs", facet.number, keyword));
  }
  const std::string_view word = in.word();
  if (equal_in_any_case(word, keyword)) return;
  in.refuse(fmt::format("facet {} has {} where '{}' belongs", facet.number, in_quotes(word), keyword));
}

/// What follows the word `facet`.
void read_facet(TextScanner& in, Facets& facets) {
  const TextItem facet = {"facet", facets.count()};
  expect(in, "normal", facet);
  for (int axis = 0; axis < 3 && in.find_word(); ++axis) in.word();  // passed over: the corners tell it
  expect(in, "outer", facet);
  expect(in, "loop", facet);
  std::array<Position, 3> corners;
  for (Position& corner : corners) {
    expect(in, "vertex", facet);
    for (double& x : corner) x = in.number<double>(facet, "coordinate");
  }
  expect(in, "endloop", facet);
  expect(in, "endfacet", facet);
  facets.add(corners);
}

/// What follows the word `solid`, up to and including `endsolid`.
void read_solid(TextScanner& in, Facets& facets) {
  in.rest_of_line();  // its name
  for (;;) {
    if (!in.find_word()) in.refuse("the text ends before 'endsolid'");
    const std::string_view word = in.word();
    if (equal_in_any_case(word, "endsolid")) break;
    if (!equal_in_any_case(word, "facet")) {
      in.refuse(fmt::format("{} stands where 'facet' or 'endsolid' belongs", in_quotes(word)));
    }
    read_facet(in, facets);
  }
  in.rest_of_line();
}

PolygonMesh read_ascii(std::string_view text) {
  Facets facets;
  TextScanner in(text, {});
  while (in.find_word()) {
    const std::string_view word = in.word();
    if (!equal_in_any_case(word, "solid")) {
      in.refuse(fmt::format("{} stands where 'solid' belongs", in_quotes(word)));
    }
    read_solid(in, facets);
  }
  return std::move(facets).mesh();
}

std::uint32_t promised_facets(std::string_view bytes) {
  return load<std::uint32_t>(bytes.data() + title_size, std::endian::little);
}

std::uint64_t promised_size(std::string_view bytes) {
  return header_size + facet_size * std::uint64_t{promised_facets(bytes)};
}

/// Binary files may begin with the word `solid`, too. Then their size or a zero byte tells them from text.
bool is_ascii(std::string_view bytes) {
  if (bytes.size() >= header_size && bytes.size() == promised_size(bytes)) return false;
  TextScanner in(bytes, {});
  in.find_word();
  return equal_in_any_case(in.word(), "solid") && bytes.find('\0') == bytes.npos;
}

/// The bytes after the last facet, which must be there.
std::size_t bytes_behind(std::string_view bytes) { return bytes.size() - promised_size(bytes); }

/// Anything but further facets may follow the last one. Further facets mean that the header's count is
/// wrong.
bool may_be_facets(std::size_t size) { return size > 0 && size % facet_size == 0; }

void check_size(std::string_view bytes) {
  if (bytes.size() < header_size) {
    throw MeshError(fmt::format(
        "the file neither begins with 'solid' nor has the {} bytes of a binary STL header, but {} bytes; "
        "check that it is an STL file",
        header_size, bytes.size()));
  }
  const bool cut_short = bytes.size() < promised_size(bytes);
  if (!cut_short && !may_be_facets(bytes_behind(bytes))) return;
  throw MeshError(
      fmt::format("byte {}: the header promises {} triangles in {} bytes, but the file has {} bytes, so that "
                  "it is {}; export it again",
                  title_size, promised_facets(bytes), promised_size(bytes), bytes.size(),
                  cut_short ? "cut short" : "corrupt"));
}

Position load_position(const char* bytes) {
  Position position;
  for (double& x : position) {
    x = load<float>(bytes, std::endian::little);
    bytes += sizeof(float);
  }
  return position;
}

std::array<Position, 3> load_corners(std::string_view facet) {
  const char* const behind_normal = facet.data() + vector_size;
  return {load_position(behind_normal), load_position(behind_normal + vector_size),
          load_position(behind_normal + 2 * vector_size)};
}

PolygonMesh read_binary(std::string_view bytes) {
  check_size(bytes);
  Facets facets(promised_facets(bytes));
  for (std::string_view left = bytes.substr(header_size, promised_size(bytes) - header_size); !left.empty();
       left.remove_prefix(facet_size))
    facets.add(load_corners(left));
  PolygonMesh mesh = std::move(facets).mesh();
  if (const std::size_t behind = bytes_behind(bytes); behind > 0)
    mesh.warnings.push_back(fmt::format("{} {} ignored after the {} triangles that the header promises",
                                        behind, behind == 1 ? "byte is" : "bytes are",
                                        promised_facets(bytes)));
  return mesh;
}

void append_vector(std::string& bytes, const Eigen::Vector3f& vector) {
  append_little_endian(bytes, vector[0], vector[1], vector[2]);
}

void check_corners(const Mesh& mesh) {
  for (Eigen::Index f = 0; f < mesh.F.rows(); ++f) {
    for (const int v : mesh.F.row(f)) {
      if (v >= 0 && v < mesh.V.rows()) continue;
      throw MeshError(
          fmt::format("face {} has the index {}, but the mesh has {} vertices", f, v, mesh.V.rows()));
    }
  }
}

}  // namespace

PolygonMesh read_stl(std::string_view bytes) {
  return is_ascii(bytes) ? read_ascii(bytes) : read_binary(bytes);
}

std::string write_stl(const Mesh& mesh) {
  check_corners(mesh);
  std::string bytes = "orbitutte";
  bytes.resize(title_size, ' ');
  append_little_endian(bytes, static_cast<std::uint32_t>(mesh.F.rows()));
  bytes.reserve(header_size + facet_size * mesh.F.rows());
  for (const auto& face : mesh.F.rowwise()) {
    const Vector3 a = mesh.V.row(face[0]), b = mesh.V.row(face[1]), c = mesh.V.row(face[2]);
    const Vector3 normal = (b - a).cross(c - a).stableNormalized();
    append_vector(bytes, normal.cast<float>());
    for (const Vector3* corner : {&a, &b, &c}) append_vector(bytes, corner->cast<float>());
    append_little_endian(bytes, no_attribute);
  }
  return bytes;
}

}  // namespace orbitutte
