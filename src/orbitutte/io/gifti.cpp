// SPDX-License-Identifier: MIT
#include "orbitutte/io/gifti.h"

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
struct EncodedArray {
  std::string intent, name, type, encoding, endian, order, external_file, data, transform;
  std::vector<int> dimensions;
};

// Collects what the document says.
class GiftiDocument : public XmlReader {
 public:
  explicit GiftiDocument(std::string_view bytes) {
    read_xml(bytes, *this);
    if (!is_gifti_)
      throw MeshError("the XML document has no element GIFTI; check that the file is a GIfTI file");
  }

  void begin(const std::string& element, const XmlAttributes& attributes) override {
    is_gifti_ = is_gifti_ || element == "GIFTI";
    text_.clear();
    if (element == "DataArray") begin_array(attributes);
    if (element == "Label") {
      ValueLabel& label = labels.emplace_back();
      label.key = attributes.number("Key");
      label.colour = {attributes.number("Red", 0), attributes.number("Green", 0),
                      attributes.number("Blue", 0), attributes.number("Alpha", 1)};
    }
  }

  void end(const std::string& element) override {
    if (element == "DataArray") inside_array_ = false;
    if (element == "Name") name_ = text_;
    if (element == "Label" && !labels.empty()) labels.back().name = text_;
    if (!inside_array_) return;
    EncodedArray& array = arrays.back();
    if (element == "Value" && name_ == "Name") array.name = text_;
    if (element == "MatrixData") array.transform += text_;
    if (element == "Data") array.data = std::move(text_);
    text_.clear();
  }

  void text(std::string_view piece) override { text_ += piece; }

  std::vector<EncodedArray> arrays;
  std::vector<ValueLabel> labels;

 private:
  void begin_array(const XmlAttributes& attributes) {
    inside_array_ = true;
    EncodedArray& array = arrays.emplace_back();
    array.intent = attributes["Intent"];
    array.type = attributes["DataType"];
    array.encoding = attributes["Encoding"];
    array.endian = attributes["Endian"];
    array.order = attributes["ArrayIndexingOrder"];
    array.external_file = attributes["ExternalFileName"];
    const int count = std::clamp(attributes.number("Dimensionality"), 0, 6);
    for (int k = 0; k < count; ++k) array.dimensions.push_back(attributes.number(fmt::format("Dim{}", k)));
  }

  std::string text_, name_;
  bool is_gifti_ = false, inside_array_ = false;
};

// One array, number `index` of the file.
class Decoder {
 public:
  Decoder(const EncodedArray& array, std::size_t index) : array_(array), index_(index) {}

  GiftiArray run() const {
    GiftiArray result;
    result.intent = array_.intent;
    result.name = array_.name;
    set_shape(result);
    result.values =
        array_.encoding == "ASCII" ? numbers_of_text(count(result)) : numbers_of_bytes(count(result));
    if (array_.order == "ColumnMajorOrder") result.values = transposed(result);
    result.has_transform = states_transform();
    return result;
  }

 private:
  [[noreturn]] void refuse(std::string_view problem) const {
    throw MeshError(
        fmt::format("DataArray {} ({}): {}; export the file again", index_, shown(array_.intent), problem));
  }

  // All dimensions behind the first are columns.
  void set_shape(GiftiArray& result) const {
    constexpr std::size_t most = std::numeric_limits<int>::max();
    std::size_t columns = 1;
    for (const int size : array_.dimensions)
      if (size <= 0) refuse("its dimensions are missing or not positive");
    if (array_.dimensions.empty()) refuse("it has no dimensions");
    result.rows = array_.dimensions.front();
    for (std::size_t k = 1; k < array_.dimensions.size(); ++k)
      columns *= static_cast<std::size_t>(array_.dimensions[k]);
    if (columns > most || columns * static_cast<std::size_t>(result.rows) > most)
      refuse("it has more numbers than an int can count");
    result.columns = static_cast<int>(columns);
  }

  static std::size_t count(const GiftiArray& array) {
    return static_cast<std::size_t>(array.rows) * static_cast<std::size_t>(array.columns);
  }

  std::vector<double> numbers_of_text(std::size_t count) const {
    if (count > array_.data.size())
      refuse(fmt::format("it should hold {} numbers, which its text cannot", count));
    TextScanner in(array_.data, {});
    std::vector<double> values;
    values.reserve(count);
    double value = 0;
    while (in.find_word()) {
      const std::string_view word = in.word();
      if (parse_number(word, value) != NumberError::none)
        refuse(fmt::format("{} stands where a number belongs", in_quotes(word)));
      values.push_back(value);
    }
    if (values.size() != count)
      refuse(fmt::format("it holds {} numbers in place of {}", values.size(), count));
    return values;
  }

  std::vector<double> numbers_of_bytes(std::size_t count) const {
    const NumberType* const type = find_number_type(&NumberType::gifti, array_.type);
    if (!type) refuse(fmt::format("its DataType {} is not known", in_quotes(array_.type)));
    const std::string bytes = decoded(count * type->size);
    if (bytes.size() != count * type->size)
      refuse(fmt::format("it holds {} bytes in place of {}", bytes.size(), count * type->size));
    const std::endian order = array_.endian == "BigEndian" ? std::endian::big : std::endian::little;
    std::vector<double> values(count);
    for (std::size_t k = 0; k < count; ++k) values[k] = type->load(bytes.data() + k * type->size, order);
    return values;
  }

  std::string decoded(std::size_t size) const {
    if (array_.encoding == "ExternalFileBinary")
      refuse(
          fmt::format("its numbers are in the file {}, which is not read", in_quotes(array_.external_file)));
    if (array_.encoding == "Base64Binary") return from_base64(array_.data);
    if (array_.encoding == "GZipBase64Binary") return decompress(from_base64(array_.data), size);
    refuse(fmt::format("its Encoding {} is not known", in_quotes(array_.encoding)));
  }

  static std::vector<double> transposed(const GiftiArray& array) {
    std::vector<double> result(array.values.size());
    const std::size_t rows = array.rows, columns = array.columns;
    for (std::size_t i = 0; i < rows; ++i)
      for (std::size_t j = 0; j < columns; ++j) result[i * columns + j] = array.values[j * rows + i];
    return result;
  }

  bool states_transform() const {
    TextScanner in(array_.transform, {});
    for (int k = 0; in.find_word(); ++k) {
      double value = 0;
      if (parse_number(in.word(), value) != NumberError::none) return false;
      if (value != (k % 16 % 5 == 0 ? 1 : 0)) return true;
    }
    return false;
  }

  const EncodedArray& array_;
  std::size_t index_;
};

const GiftiArray& array_of(const GiftiFile& file, std::string_view intent, std::string_view what) {
  for (const GiftiArray& array : file.arrays)
    if (array.intent == intent && array.columns == 3) return array;
  throw MeshError(
      fmt::format("the file has no DataArray of three columns with the intent {}, so no {}; take the "
                  "surface's file (.surf.gii)",
                  intent, what));
}

// -1, which is no index, for what is no int.
int to_index(double value) {
  return value >= -2147483648.0 && value <= 2147483647.0 ? static_cast<int>(value) : -1;
}

// The numbers of an array as those of another type.
template <class T>
std::string bytes_of(const std::vector<double>& values) {
  std::string bytes;
  bytes.reserve(sizeof(T) * values.size());
  for (const double value : values) append_little_endian(bytes, static_cast<T>(value));
  return bytes;
}

std::string metadata(const GiftiArray& array) {
  if (array.name.empty()) return "    <MetaData/>\n";
  return fmt::format("    <MetaData><MD><Name>Name</Name><Value>{}</Value></MD></MetaData>\n",
                     xml_text(array.name));
}

void append_array(std::string& text, const GiftiArray& array) {
  const bool is_whole = array.intent == gifti_triangles || array.intent == gifti_labels;
  text += fmt::format(
      R"(  <DataArray Intent="{}" DataType="{}" ArrayIndexingOrder="RowMajorOrder" Dimensionality="{}" Dim0="{}" )",
      array.intent, is_whole ? "NIFTI_TYPE_INT32" : "NIFTI_TYPE_FLOAT32", array.columns == 1 ? 1 : 2,
      array.rows);
  if (array.columns != 1) text += fmt::format(R"(Dim1="{}" )", array.columns);
  text += R"(Encoding="GZipBase64Binary" Endian="LittleEndian" ExternalFileName="" ExternalFileOffset="0">)"
          "\n";
  text += metadata(array);
  if (array.intent == gifti_points)
    text +=
        "    <CoordinateSystemTransformMatrix>\n"
        "      <DataSpace><![CDATA[NIFTI_XFORM_UNKNOWN]]></DataSpace>\n"
        "      <TransformedSpace><![CDATA[NIFTI_XFORM_UNKNOWN]]></TransformedSpace>\n"
        "      <MatrixData>1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1</MatrixData>\n"
        "    </CoordinateSystemTransformMatrix>\n";
  const std::string bytes = is_whole ? bytes_of<std::int32_t>(array.values) : bytes_of<float>(array.values);
  text += fmt::format("    <Data>{}</Data>\n  </DataArray>\n", base64(compress(bytes)));
}

std::string label_table(const std::vector<ValueLabel>& labels) {
  if (labels.empty()) return "  <LabelTable/>\n";
  std::string text = "  <LabelTable>\n";
  for (const ValueLabel& label : labels)
    text += fmt::format("    <Label Key=\"{}\" Red=\"{}\" Green=\"{}\" Blue=\"{}\" Alpha=\"{}\">{}</Label>\n",
                        label.key, label.colour[0], label.colour[1], label.colour[2], label.colour[3],
                        xml_text(label.name));
  return text + "  </LabelTable>\n";
}

GiftiArray triples(std::string_view intent, int rows) {
  GiftiArray array;
  array.intent = intent;
  array.rows = rows;
  array.columns = 3;
  return array;
}

}  // namespace

GiftiFile read_gifti_file(std::string_view bytes) {
  GiftiDocument document(bytes);
  GiftiFile result;
  for (std::size_t k = 0; k < document.arrays.size(); ++k)
    result.arrays.push_back(Decoder(document.arrays[k], k).run());
  result.labels = std::move(document.labels);
  return result;
}

PolygonMesh read_gifti(std::string_view bytes) {
  const GiftiFile file = read_gifti_file(bytes);
  const GiftiArray& points = array_of(file, gifti_points, "points");
  const GiftiArray& triangles = array_of(file, gifti_triangles, "triangles");
  PolygonMesh mesh;
  mesh.V = to_points(points.values);
  mesh.face_start.reserve(triangles.rows + std::size_t{1});
  mesh.corners.reserve(triangles.values.size());
  for (int f = 0; f < triangles.rows; ++f) {
    for (std::size_t k = 0; k < 3; ++k)
      mesh.corners.push_back(to_index(triangles.values[3 * std::size_t(f) + k]));
    end_face(mesh);
  }
  if (points.has_transform)
    mesh.warnings.emplace_back(
        "the file states a transform to another space (CoordinateSystemTransformMatrix), which is not "
        "applied: "
        "positions are those of the file");
  return mesh;
}

std::string write_gifti_file(const GiftiFile& file) {
  std::string text = fmt::format(
      "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n"
      "<!DOCTYPE GIFTI SYSTEM \"http://www.nitrc.org/frs/download.php/115/gifti.dtd\">\n"
      "<GIFTI Version=\"1.0\" NumberOfDataArrays=\"{}\">\n  <MetaData/>\n{}",
      file.arrays.size(), label_table(file.labels));
  for (const GiftiArray& array : file.arrays) append_array(text, array);
  return text + "</GIFTI>\n";
}

std::string write_gifti(const Mesh& mesh) {
  GiftiFile file;
  file.arrays = {triples(gifti_points, static_cast<int>(mesh.V.rows())),
                 triples(gifti_triangles, static_cast<int>(mesh.F.rows()))};
  file.arrays[0].values.assign(mesh.V.data(), mesh.V.data() + mesh.V.size());
  file.arrays[1].values.assign(mesh.F.data(), mesh.F.data() + mesh.F.size());
  return write_gifti_file(file);
}

}  // namespace orbitutte
