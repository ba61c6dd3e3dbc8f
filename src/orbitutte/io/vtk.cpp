// SPDX-License-Identifier: MIT
// VTK's legacy files of polygonal data (VTK File Formats, "Simple Legacy Formats"), text and binary, with the
// cells of versions before 5 (counts among indices) and of 5.1 (OFFSETS and CONNECTIVITY).
#include <fmt/compile.h>
#include <fmt/format.h>

#include <algorithm>
#include <iterator>

#include "orbitutte/io/mesh_formats.h"
#include "orbitutte/io/number_types.h"
#include "orbitutte/io/text_scanner.h"

namespace orbitutte {
namespace {

bool is_vtk_blank(char c) { return c == ' ' || c == '\n' || c == '\r' || c == '\t'; }

// Reads a file from its beginning, words of text and runs of binary numbers in turn.
class VtkReader {
 public:
  explicit VtkReader(std::string_view bytes) : bytes_(bytes) {}

  PolygonMesh run() {
    read_header();
    while (true) {
      const std::string_view keyword = word();
      if (keyword.empty() || is(keyword, "POINT_DATA") || is(keyword, "CELL_DATA")) break;
      read_section(keyword);
    }
    if (!has_points_) refuse("the file has no POINTS");
    return std::move(mesh_);
  }

 private:
  [[noreturn]] void refuse(std::string_view problem) const {
    const auto line = 1 + std::count(bytes_.begin(), bytes_.begin() + static_cast<std::ptrdiff_t>(at_), '\n');
    throw MeshError(fmt::format("line {}: {}; mend the file or export it again", line, problem));
  }

  static bool is(std::string_view word, std::string_view keyword) {
    return std::equal(word.begin(), word.end(), keyword.begin(), keyword.end(),
                      [](char a, char b) { return (a >= 'a' && a <= 'z' ? a - 'a' + 'A' : a) == b; });
  }

  std::string_view line() {
    const std::size_t end = std::min(bytes_.find('\n', at_), bytes_.size());
    const std::string_view result = bytes_.substr(at_, end - at_);
    at_ = std::min(end + 1, bytes_.size());
    return result;
  }

  // Empty at the end.
  std::string_view word() {
    while (at_ < bytes_.size() && is_vtk_blank(bytes_[at_])) ++at_;
    const std::size_t begin = at_;
    while (at_ < bytes_.size() && !is_vtk_blank(bytes_[at_])) ++at_;
    return bytes_.substr(begin, at_ - begin);
  }

  template <class T>
  T number(std::string_view what) {
    T value{};
    const std::string_view text = word();
    if (parse_number(text, value) == NumberError::none) return value;
    if (text.empty()) refuse(fmt::format("the file ends where {} belongs", what));
    refuse(fmt::format("{} stands where {} belongs", in_quotes(text), what));
  }

  std::size_t count(std::string_view what) {
    const auto value = number<long long>(what);
    if (value < 0 || static_cast<std::size_t>(value) > bytes_.size() - at_ + 1)
      refuse(fmt::format("{} is {}, but only {} bytes follow", what, value, bytes_.size() - at_));
    return static_cast<std::size_t>(value);
  }

  void read_header() {
    if (!bytes_.starts_with("# vtk DataFile"))
      refuse("the file does not begin with '# vtk DataFile Version', as legacy VTK files do");
    line();
    line();  // the title
    const std::string_view encoding = word();
    is_binary_ = is(encoding, "BINARY");
    if (!is_binary_ && !is(encoding, "ASCII"))
      refuse(fmt::format("{} stands where ASCII or BINARY belongs", in_quotes(encoding)));
    if (!is(word(), "DATASET")) refuse("the word DATASET is missing");
    const std::string_view kind = word();
    if (!is(kind, "POLYDATA"))
      refuse(fmt::format("the data set is {}, but only POLYDATA is read; extract the surface and save that",
                         in_quotes(kind)));
  }

  void read_section(std::string_view keyword) {
    if (is(keyword, "POINTS")) return read_points();
    if (is(keyword, "POLYGONS")) return read_cells([&](const std::vector<int>& cell) { add_polygon(cell); });
    if (is(keyword, "TRIANGLE_STRIPS"))
      return read_cells([&](const std::vector<int>& cell) { add_strip(cell); });
    if (is(keyword, "VERTICES") || is(keyword, "LINES")) return read_cells([](const std::vector<int>&) {});
    if (is(keyword, "METADATA")) return skip_metadata();
    if (is(keyword, "FIELD")) return skip_field();
    refuse(fmt::format("{} stands where POINTS or POLYGONS belongs", in_quotes(keyword)));
  }

  // Up to an empty line.
  void skip_metadata() {
    line();
    while (at_ < bytes_.size() && line().find_first_not_of("\r \t") != std::string_view::npos) {
    }
  }

  void skip_field() {
    word();  // its name
    const std::size_t arrays = count("the number of arrays");
    for (std::size_t k = 0; k < arrays; ++k) {
      word();
      const std::size_t components = count("the number of components"),
                        tuples = count("the number of tuples");
      if (components > 0 && tuples > bytes_.size() / components) refuse("an array is larger than the file");
      numbers(components * tuples, word());
    }
  }

  // So many numbers of a type.
  std::vector<double> numbers(std::size_t size, std::string_view type_name) {
    std::vector<double> result(size);
    const NumberType* const type = find_number_type(&NumberType::legacy_vtk, type_name);
    if (!type) refuse(fmt::format("the type {} of numbers is not known", in_quotes(type_name)));
    if (!is_binary_) {
      for (double& value : result) value = number<double>("a number");
      return result;
    }
    line();  // the rest of the keyword's
    if (size > (bytes_.size() - at_) / type->size) refuse("the binary numbers are cut short");
    for (std::size_t k = 0; k < size; ++k)
      result[k] = type->load(bytes_.data() + at_ + k * type->size, std::endian::big);
    at_ += size * type->size;
    return result;
  }

  void read_points() {
    const std::size_t points = count("the number of points");
    if (points > bytes_.size() / 3) refuse(fmt::format("the file cannot hold {} points", points));
    mesh_.V = to_points(numbers(3 * points, word()));
    has_points_ = true;
  }

  int index(double value) const {
    if (value >= -2147483648.0 && value <= 2147483647.0) return static_cast<int>(value);
    refuse(fmt::format("{} is no index of a point", value));
  }

  template <class Add>
  void read_cells(const Add& add) {
    const std::size_t first = count("the number of cells"), second = count("the size of the cells");
    const std::size_t before = at_;
    if (is(word(), "OFFSETS")) return read_offset_cells({first, second}, add);
    at_ = before;
    const std::vector<double> list = numbers(second, "int");
    std::vector<int> cell;
    std::size_t at = 0;
    for (std::size_t c = 0; c < first; ++c) {
      const double degree = at < list.size() ? list[at++] : -1;
      if (!(degree >= 0) || degree > static_cast<double>(list.size() - at))
        refuse(fmt::format("cell {} does not fit into the {} numbers of the cells", c, second));
      cell.clear();
      for (int k = 0; k < static_cast<int>(degree); ++k) cell.push_back(index(list[at++]));
      add(cell);
    }
  }

  struct OffsetCounts {
    std::size_t offsets, corners;
  };

  template <class Add>
  void read_offset_cells(const OffsetCounts& counts, const Add& add) {
    const std::vector<double> offsets = numbers(counts.offsets, word());
    if (!is(word(), "CONNECTIVITY")) refuse("the word CONNECTIVITY is missing");
    const std::vector<double> corners = numbers(counts.corners, word());
    std::vector<int> cell;
    for (std::size_t c = 0; c + 1 < offsets.size(); ++c) {
      if (!(offsets[c] >= 0) || offsets[c + 1] < offsets[c] ||
          offsets[c + 1] > static_cast<double>(corners.size()))
        refuse(fmt::format("the offsets of cell {} do not fit", c));
      cell.clear();
      for (auto k = static_cast<std::size_t>(offsets[c]); k < static_cast<std::size_t>(offsets[c + 1]); ++k)
        cell.push_back(index(corners[k]));
      add(cell);
    }
  }

  void add_polygon(const std::vector<int>& cell) {
    mesh_.corners.insert(mesh_.corners.end(), cell.begin(), cell.end());
    end_face(mesh_);
  }

  // Every second triangle of a strip is turned.
  void add_strip(const std::vector<int>& cell) {
    for (std::size_t k = 0; k + 2 < cell.size(); ++k) {
      const std::size_t turn = k % 2;
      add_polygon({cell[k + turn], cell[k + 1 - turn], cell[k + 2]});
    }
  }

  std::string_view bytes_;
  std::size_t at_ = 0;
  bool is_binary_ = false, has_points_ = false;
  PolygonMesh mesh_;
};

}  // namespace

PolygonMesh read_vtk(std::string_view bytes) { return VtkReader(bytes).run(); }

std::string write_vtk_polygons(const PolygonMesh& mesh) {
  std::string text = "# vtk DataFile Version 3.0\norbitutte\nASCII\nDATASET POLYDATA\n";
  const auto out = std::back_inserter(text);
  fmt::format_to(out, "POINTS {} double\n", mesh.vertex_count());
  for (const auto& position : mesh.V.rowwise())
    fmt::format_to(out, FMT_COMPILE("{} {} {}\n"), position[0], position[1], position[2]);
  fmt::format_to(out, "POLYGONS {} {}\n", mesh.face_count(),
                 static_cast<std::size_t>(mesh.face_count()) + mesh.corners.size());
  for (int f = 0; f < mesh.face_count(); ++f) {
    fmt::format_to(out, FMT_COMPILE("{}"), mesh.face_degree(f));
    for (int k = mesh.face_start[f]; k < mesh.face_start[f + 1]; ++k)
      fmt::format_to(out, FMT_COMPILE(" {}"), mesh.corners[k]);
    text += '\n';
  }
  return text;
}

std::string write_vtk(const Mesh& mesh) { return write_vtk_polygons(to_polygon_mesh(mesh)); }

}  // namespace orbitutte
