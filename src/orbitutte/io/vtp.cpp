// SPDX-License-Identifier: MIT
// VTK's XML files of polygonal data (VTK File Formats, "XML File Formats"): arrays as text, base64 or raw
// bytes, inside their elements or appended, compressed by zlib or not.
#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <limits>

#include "orbitutte/io/base64.h"
#include "orbitutte/io/bytes.h"
#include "orbitutte/io/compression.h"
#include "orbitutte/io/mesh_formats.h"
#include "orbitutte/io/number_types.h"
#include "orbitutte/io/text_scanner.h"
#include "orbitutte/io/xml.h"

namespace orbitutte {
namespace {

// A DataArray as it stands in the file.
struct VtpArray {
  std::string name, type, format, text;
  int components = 1, offset = 0;
};

struct VtpPiece {
  int points = 0;
  std::vector<VtpArray> positions, polygons, strips;
};

std::vector<VtpArray>* arrays_in(VtpPiece& piece, const std::string& section) {
  if (section == "Points") return &piece.positions;
  if (section == "Polys") return &piece.polygons;
  return section == "Strips" ? &piece.strips : nullptr;
}

// Collects what the document says.
class VtpDocument : public XmlReader {
 public:
  void begin(const std::string& element, const XmlAttributes& attributes) override {
    if (array_) ++depth_;  // what is known of the array, such as its range
    if (depth_ > 0) return;
    if (element == "VTKFile") {
      type = attributes["type"];
      is_big_endian = attributes["byte_order"] == "BigEndian";
      has_long_headers = attributes["header_type"] == "UInt64";
      compressor = attributes["compressor"];
    }
    if (element == "Piece") pieces.emplace_back().points = attributes.number("NumberOfPoints");
    if (element == "DataArray") {
      begin_array(attributes);
    } else {
      section_ = element;
    }
  }

  void end(const std::string& element) override {
    if (depth_ > 0) {
      --depth_;
    } else if (element == "DataArray") {
      array_ = nullptr;
    } else {
      section_.clear();
    }
  }

  void text(std::string_view piece) override {
    if (array_ && depth_ == 0) array_->text += piece;
  }

  std::string type, compressor;
  bool is_big_endian = false, has_long_headers = false;
  std::vector<VtpPiece> pieces;

 private:
  void begin_array(const XmlAttributes& attributes) {
    std::vector<VtpArray>* const arrays = pieces.empty() ? nullptr : arrays_in(pieces.back(), section_);
    if (!arrays) return;
    array_ = &arrays->emplace_back();
    array_->name = attributes["Name"];
    array_->type = attributes["type"];
    array_->format = attributes["format"];
    array_->components = attributes.number("NumberOfComponents");
    array_->offset = attributes.number("offset");
  }

  std::string section_;
  VtpArray* array_ = nullptr;
  int depth_ = 0;  // below the array
};

// The document, and the bytes that are appended to it, which need not be XML.
struct VtpParts {
  std::string document;
  std::string_view appended;
  bool is_raw = false;
};

VtpParts split_appended(std::string_view bytes) {
  const std::size_t begin = bytes.find("<AppendedData");
  const std::size_t end = begin == bytes.npos ? begin : bytes.find('>', begin);
  const std::size_t mark = end == bytes.npos ? end : bytes.find('_', end);
  if (mark == bytes.npos) return {std::string(bytes), {}, false};
  VtpParts parts;
  parts.is_raw = bytes.substr(begin, end - begin).find("raw") != bytes.npos;
  parts.appended = bytes.substr(mark + 1);
  parts.document = fmt::format("{}</VTKFile>", bytes.substr(0, begin));
  return parts;
}

// Runs of bytes, one after the other, raw or each in base64 of its own.
class VtpRuns {
 public:
  VtpRuns(std::string_view text, bool is_raw) : text_(text), is_raw_(is_raw) {}

  // The first bytes of the next run.
  std::string peek(std::size_t size) const {
    if (is_raw_) return std::string(text_.substr(0, size));
    std::string bytes = from_base64(text_.substr(0, std::min(text_.size(), encoded(size))));
    bytes.resize(std::min(bytes.size(), size));
    return bytes;
  }

  // Takes the next run, which has so many bytes; may be fewer at the end of the text.
  std::string take(std::size_t size) {
    std::string bytes = peek(size);
    text_.remove_prefix(std::min(text_.size(), is_raw_ ? size : encoded(size)));
    return bytes;
  }

  std::size_t most_bytes() const { return text_.size(); }

 private:
  // The characters of so many bytes.
  static std::size_t encoded(std::size_t size) { return (size + 2) / 3 * 4; }

  std::string_view text_;
  bool is_raw_;
};

class VtpReader {
 public:
  explicit VtpReader(std::string_view bytes) : parts_(split_appended(bytes)) {
    read_xml(parts_.document, document_);
  }

  PolygonMesh run() {
    if (document_.type != "PolyData")
      throw MeshError(
          fmt::format("the data set is {}, but only PolyData is read; extract the surface and save that",
                      in_quotes(document_.type)));
    if (!document_.compressor.empty() && document_.compressor != "vtkZLibDataCompressor")
      throw MeshError(
          fmt::format("the file is compressed by {}, which is not read; save it with zlib or uncompressed",
                      in_quotes(document_.compressor)));
    for (const VtpPiece& piece : document_.pieces) add_piece(piece);
    mesh_.V = to_points(coordinates_);
    return std::move(mesh_);
  }

 private:
  [[noreturn]] static void refuse(const VtpArray& array, std::string_view problem) {
    throw MeshError(fmt::format("DataArray {}: {}; save the file again", in_quotes(array.name), problem));
  }

  static const VtpArray& array_named(const std::vector<VtpArray>& arrays, std::string_view name) {
    for (const VtpArray& array : arrays)
      if (array.name == name) return array;
    throw MeshError(fmt::format("the polygons lack the DataArray '{}'; save the file again", name));
  }

  void add_piece(const VtpPiece& piece) {
    const int first = checked_count(coordinates_.size() / 3, "vertices");
    if (piece.points > 0) {
      if (piece.positions.empty()) throw MeshError("the file has no positions of its points; save it again");
      const std::vector<double> positions = numbers(piece.positions.front());
      if (positions.size() != 3 * static_cast<std::size_t>(piece.points))
        refuse(piece.positions.front(),
               fmt::format("it holds {} numbers for {} points", positions.size(), piece.points));
      coordinates_.insert(coordinates_.end(), positions.begin(), positions.end());
    }
    add_cells(piece.polygons, [&](const std::vector<int>& cell) { add_face(cell, first); });
    add_cells(piece.strips, [&](const std::vector<int>& cell) {
      for (std::size_t k = 0; k + 2 < cell.size(); ++k)  // every second triangle of a strip is turned
        add_face({cell[k + k % 2], cell[k + 1 - k % 2], cell[k + 2]}, first);
    });
  }

  void add_face(const std::vector<int>& cell, int first) {
    for (const int corner : cell) mesh_.corners.push_back(corner < 0 ? corner : first + corner);
    end_face(mesh_);
  }

  template <class Add>
  void add_cells(const std::vector<VtpArray>& arrays, const Add& add) const {
    if (arrays.empty()) return;
    const VtpArray &corner_array = array_named(arrays, "connectivity"),
                   &end_array = array_named(arrays, "offsets");
    const std::vector<double> corners = numbers(corner_array), ends = numbers(end_array);
    std::vector<int> cell;
    std::size_t at = 0;
    for (std::size_t c = 0; c < ends.size(); ++c) {
      if (!(ends[c] >= static_cast<double>(at)) || ends[c] > static_cast<double>(corners.size()))
        refuse(end_array, fmt::format("the cell {} ends at {}, which does not fit", c, ends[c]));
      cell.clear();
      for (; at < static_cast<std::size_t>(ends[c]); ++at) cell.push_back(index(corner_array, corners[at]));
      add(cell);
    }
  }

  // Half of what an int holds, so that indices of pieces can be added up.
  static int index(const VtpArray& array, double value) {
    constexpr double most = 0x1p30;
    if (value >= -most && value <= most) return static_cast<int>(value);
    refuse(array, fmt::format("{} is no index of a point", value));
  }

  std::vector<double> numbers(const VtpArray& array) const {
    if (array.format == "ascii") return numbers_of_text(array);
    const NumberType* const type = find_number_type(&NumberType::vtk_xml, array.type);
    if (!type) refuse(array, fmt::format("its type {} is not known", in_quotes(array.type)));
    const std::string bytes = bytes_of_array(array);
    std::vector<double> values(bytes.size() / type->size);
    for (std::size_t k = 0; k < values.size(); ++k)
      values[k] = type->load(bytes.data() + k * type->size, order());
    return values;
  }

  static std::vector<double> numbers_of_text(const VtpArray& array) {
    std::vector<double> values;
    TextScanner in(array.text, {});
    while (in.find_word()) {
      const std::string_view word = in.word();
      if (parse_number(word, values.emplace_back()) != NumberError::none)
        refuse(array, fmt::format("{} stands where a number belongs", in_quotes(word)));
    }
    return values;
  }

  std::string bytes_of_array(const VtpArray& array) const {
    if (array.format == "binary") {
      std::string text = array.text;
      text.erase(std::remove_if(text.begin(), text.end(),
                                [](char c) { return c == ' ' || c == '\n' || c == '\r' || c == '\t'; }),
                 text.end());
      return decoded(array, VtpRuns(text, false));
    }
    if (array.format != "appended")
      refuse(array, fmt::format("its format {} is not known", in_quotes(array.format)));
    if (array.offset < 0 || static_cast<std::size_t>(array.offset) > parts_.appended.size())
      refuse(array, fmt::format("its offset {} lies behind the appended data", array.offset));
    return decoded(array,
                   VtpRuns(parts_.appended.substr(static_cast<std::size_t>(array.offset)), parts_.is_raw));
  }

  std::string decoded(const VtpArray& array, VtpRuns runs) const {
    return document_.compressor.empty() ? uncompressed_bytes(array, runs) : compressed_bytes(array, runs);
  }

  std::size_t header_size() const { return document_.has_long_headers ? 8 : 4; }
  std::endian order() const { return document_.is_big_endian ? std::endian::big : std::endian::little; }

  // The number that begins at byte `at` of the header. Throws MeshError if the bytes end before.
  std::uint64_t header_number(const VtpArray& array, const std::string& bytes, std::size_t number) const {
    const std::size_t at = number * header_size();
    if (bytes.size() < at + header_size()) refuse(array, "its data are cut short");
    return document_.has_long_headers ? load<std::uint64_t>(bytes.data() + at, order())
                                      : load<std::uint32_t>(bytes.data() + at, order());
  }

  // A length, and so many bytes.
  std::string uncompressed_bytes(const VtpArray& array, VtpRuns& runs) const {
    const std::uint64_t size = header_number(array, runs.peek(header_size()), 0);
    if (size > runs.most_bytes())
      refuse(array, fmt::format("it promises {} bytes, more than the file has", size));
    std::string bytes = runs.take(header_size() + size);
    if (bytes.size() != header_size() + size) refuse(array, "its data are cut short");
    return bytes.erase(0, header_size());
  }

  // The number of blocks, their size, that of the last one if it is smaller, the sizes of the compressed
  // blocks, and, in another run, the blocks.
  std::string compressed_bytes(const VtpArray& array, VtpRuns& runs) const {
    const std::string start = runs.peek(3 * header_size());
    const std::uint64_t blocks = header_number(array, start, 0), size = header_number(array, start, 1),
                        last = header_number(array, start, 2);
    if (blocks > runs.most_bytes() / header_size())
      refuse(array, fmt::format("it promises {} blocks, more than the file has", blocks));
    const std::string header = runs.take((3 + blocks) * header_size());
    std::vector<std::size_t> packed;
    packed.reserve(blocks);
    std::size_t total = 0;
    for (std::uint64_t k = 0; k < blocks; ++k) {
      packed.push_back(header_number(array, header, 3 + k));
      if (packed.back() > runs.most_bytes() - total)
        refuse(array, fmt::format("block {} is larger than the file", k));
      total += packed.back();
    }
    const std::string data = runs.take(total);
    if (data.size() != total) refuse(array, "its data are cut short");
    std::string bytes;
    std::size_t at = 0;
    for (std::uint64_t k = 0; k < blocks; at += packed[k], ++k)
      bytes +=
          decompress(std::string_view(data).substr(at, packed[k]), k + 1 == blocks && last > 0 ? last : size);
    return bytes;
  }

  VtpParts parts_;
  VtpDocument document_;
  std::vector<double> coordinates_;
  PolygonMesh mesh_;
};

// Base64 of a length and so many bytes.
template <class T, class Values>
std::string vtp_array(std::string_view attributes, const Values& values) {
  std::string bytes;
  append_little_endian(bytes, static_cast<std::uint64_t>(sizeof(T) * values.size()));
  for (const auto value : values) append_little_endian(bytes, static_cast<T>(value));
  return fmt::format("<DataArray {} format=\"binary\">{}</DataArray>\n", attributes, base64(bytes));
}

}  // namespace

PolygonMesh read_vtp(std::string_view bytes) { return VtpReader(bytes).run(); }

std::string write_vtp_polygons(const PolygonMesh& mesh) {
  const std::vector<double> positions(mesh.V.data(), mesh.V.data() + mesh.V.size());
  const std::vector<int> ends(mesh.face_start.begin() + 1, mesh.face_start.end());
  return fmt::format(
      "<?xml version=\"1.0\"?>\n"
      "<VTKFile type=\"PolyData\" version=\"1.0\" byte_order=\"LittleEndian\" header_type=\"UInt64\">\n"
      "<PolyData>\n<Piece NumberOfPoints=\"{}\" NumberOfVerts=\"0\" NumberOfLines=\"0\" NumberOfStrips=\"0\" "
      "NumberOfPolys=\"{}\">\n<Points>\n{}</Points>\n<Polys>\n{}{}</Polys>\n</Piece>\n</PolyData>\n</"
      "VTKFile>\n",
      mesh.vertex_count(), mesh.face_count(),
      vtp_array<double>("type=\"Float64\" Name=\"Points\" NumberOfComponents=\"3\"", positions),
      vtp_array<std::int32_t>("type=\"Int32\" Name=\"connectivity\"", mesh.corners),
      vtp_array<std::int32_t>("type=\"Int32\" Name=\"offsets\"", ends));
}

std::string write_vtp(const Mesh& mesh) { return write_vtp_polygons(to_polygon_mesh(mesh)); }

}  // namespace orbitutte
