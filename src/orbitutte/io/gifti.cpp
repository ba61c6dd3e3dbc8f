// SPDX-License-Identifier: MIT
#include "orbitutte/io/gifti.h"

#include <expat.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <memory>
#include <new>

#include "orbitutte/io/base64.h"
#include "orbitutte/io/bytes.h"
#include "orbitutte/io/compression.h"
#include "orbitutte/io/mesh_formats.h"
#include "orbitutte/io/text_scanner.h"

namespace orbitutte {
namespace {

// A DataArray as it stands in the file.
struct EncodedArray {
  std::string intent, name, type, encoding, endian, order, external_file, data, transform;
  std::vector<int> dimensions;
};

std::string attribute(const char** attributes, std::string_view name) {
  for (; *attributes; attributes += 2)
    if (name == attributes[0]) return attributes[1];
  return {};
}

// 0 if it is no number.
int to_int(std::string_view text) {
  int value = 0;
  return parse_number(text, value) == NumberError::none ? value : 0;
}

struct FreeParser {
  void operator()(XML_Parser parser) const { XML_ParserFree(parser); }
};

// Collects what the document says. Nothing is thrown through the parser, which is C: what fails there is
// memory alone, and is thrown afterwards.
class Document {
 public:
  explicit Document(std::string_view bytes) {
    const std::unique_ptr<std::remove_pointer_t<XML_Parser>, FreeParser> parser(XML_ParserCreate(nullptr));
    if (!parser) throw std::bad_alloc();
    parser_ = parser.get();
    XML_SetUserData(parser_, this);
    XML_SetElementHandler(parser_, on_begin, on_end);
    XML_SetCharacterDataHandler(parser_, on_text);
    constexpr std::size_t part = 1 << 24;
    do {
      const std::string_view next = bytes.substr(0, part);
      bytes.remove_prefix(next.size());
      if (XML_Parse(parser_, next.data(), static_cast<int>(next.size()), bytes.empty()) == XML_STATUS_ERROR)
        refuse();
    } while (!bytes.empty());
    if (!is_gifti_)
      throw MeshError("the XML document has no element GIFTI; check that the file is a GIfTI file");
  }

  std::vector<EncodedArray> arrays;
  std::vector<GiftiLabel> labels;

 private:
  [[noreturn]] void refuse() const {
    if (ran_out_of_memory_) throw std::bad_alloc();
    throw MeshError(fmt::format("line {}: the file is no XML: {}; export it again",
                                XML_GetCurrentLineNumber(parser_),
                                XML_ErrorString(XML_GetErrorCode(parser_))));
  }

  void begin(const std::string& element, const char** attributes) {
    is_gifti_ = is_gifti_ || element == "GIFTI";
    text_.clear();
    if (element == "DataArray") {
      inside_array_ = true;
      EncodedArray& array = arrays.emplace_back();
      array.intent = attribute(attributes, "Intent");
      array.type = attribute(attributes, "DataType");
      array.encoding = attribute(attributes, "Encoding");
      array.endian = attribute(attributes, "Endian");
      array.order = attribute(attributes, "ArrayIndexingOrder");
      array.external_file = attribute(attributes, "ExternalFileName");
      const int count = std::clamp(to_int(attribute(attributes, "Dimensionality")), 0, 6);
      for (int k = 0; k < count; ++k)
        array.dimensions.push_back(to_int(attribute(attributes, fmt::format("Dim{}", k))));
    }
    if (element == "Label") labels.push_back({to_int(attribute(attributes, "Key")), {}});
  }

  void end(const std::string& element) {
    if (element == "DataArray") inside_array_ = false;
    if (element == "Name") name_ = text_;
    if (element == "Label" && !labels.empty()) labels.back().text = text_;
    if (!inside_array_) return;
    EncodedArray& array = arrays.back();
    if (element == "Value" && name_ == "Name") array.name = text_;
    if (element == "MatrixData") array.transform += text_;
    if (element == "Data") array.data = std::move(text_);
    text_.clear();
  }

  template <class Step>
  void guarded(const Step& step) {
    try {
      step();
    } catch (const std::bad_alloc&) {
      ran_out_of_memory_ = true;
      XML_StopParser(parser_, XML_FALSE);
    }
  }

  static void on_begin(void* self, const char* element, const char** attributes) {
    auto& document = *static_cast<Document*>(self);
    document.guarded([&] { document.begin(element, attributes); });
  }
  static void on_end(void* self, const char* element) {
    auto& document = *static_cast<Document*>(self);
    document.guarded([&] { document.end(element); });
  }
  static void on_text(void* self, const char* text, int length) {
    auto& document = *static_cast<Document*>(self);
    document.guarded([&] { document.text_.append(text, static_cast<std::size_t>(length)); });
  }

  XML_Parser parser_ = nullptr;
  std::string text_, name_;
  bool is_gifti_ = false, inside_array_ = false, ran_out_of_memory_ = false;
};

template <class T>
double load_number(const char* bytes, std::endian order) {
  return static_cast<double>(load<T>(bytes, order));
}

struct NumberType {
  std::string_view name;
  std::size_t size;
  double (*load)(const char*, std::endian);
};

constexpr NumberType number_types[] = {{"NIFTI_TYPE_FLOAT32", 4, load_number<float>},
                                       {"NIFTI_TYPE_FLOAT64", 8, load_number<double>},
                                       {"NIFTI_TYPE_INT32", 4, load_number<std::int32_t>},
                                       {"NIFTI_TYPE_UINT32", 4, load_number<std::uint32_t>},
                                       {"NIFTI_TYPE_INT64", 8, load_number<std::int64_t>},
                                       {"NIFTI_TYPE_INT16", 2, load_number<std::int16_t>},
                                       {"NIFTI_TYPE_UINT16", 2, load_number<std::uint16_t>},
                                       {"NIFTI_TYPE_INT8", 1, load_number<std::int8_t>},
                                       {"NIFTI_TYPE_UINT8", 1, load_number<std::uint8_t>}};

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
    const auto* const type = std::find_if(std::begin(number_types), std::end(number_types),
                                          [&](const NumberType& known) { return known.name == array_.type; });
    if (type == std::end(number_types))
      refuse(fmt::format("its DataType {} is not known", in_quotes(array_.type)));
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

constexpr std::string_view points_intent = "NIFTI_INTENT_POINTSET",
                           triangles_intent = "NIFTI_INTENT_TRIANGLE";

// What is written of an array before and after its numbers.
struct WrittenArray {
  std::string_view intent, type;
  Eigen::Index rows;
};

template <class T, class Matrix>
void append_array(std::string& text, const WrittenArray& array, const Matrix& numbers) {
  std::string bytes;
  bytes.reserve(sizeof(T) * static_cast<std::size_t>(numbers.size()));
  for (Eigen::Index i = 0; i < numbers.rows(); ++i)
    append_little_endian(bytes, static_cast<T>(numbers(i, 0)), static_cast<T>(numbers(i, 1)),
                         static_cast<T>(numbers(i, 2)));
  text += fmt::format(
      R"(  <DataArray Intent="{}" DataType="{}" ArrayIndexingOrder="RowMajorOrder" Dimensionality="2" Dim0="{}" )"
      R"(Dim1="3" Encoding="GZipBase64Binary" Endian="LittleEndian" ExternalFileName="" ExternalFileOffset="0">)"
      "\n    <MetaData/>\n",
      array.intent, array.type, array.rows);
  if (array.intent == points_intent)
    text +=
        "    <CoordinateSystemTransformMatrix>\n"
        "      <DataSpace><![CDATA[NIFTI_XFORM_UNKNOWN]]></DataSpace>\n"
        "      <TransformedSpace><![CDATA[NIFTI_XFORM_UNKNOWN]]></TransformedSpace>\n"
        "      <MatrixData>1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1</MatrixData>\n"
        "    </CoordinateSystemTransformMatrix>\n";
  text += fmt::format("    <Data>{}</Data>\n  </DataArray>\n", base64(compress(bytes)));
}

}  // namespace

GiftiFile read_gifti_file(std::string_view bytes) {
  Document document(bytes);
  GiftiFile result;
  for (std::size_t k = 0; k < document.arrays.size(); ++k)
    result.arrays.push_back(Decoder(document.arrays[k], k).run());
  result.labels = std::move(document.labels);
  return result;
}

PolygonMesh read_gifti(std::string_view bytes) {
  const GiftiFile file = read_gifti_file(bytes);
  const GiftiArray& points = array_of(file, points_intent, "points");
  const GiftiArray& triangles = array_of(file, triangles_intent, "triangles");
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

std::string write_gifti(const Mesh& mesh) {
  std::string text =
      "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n"
      "<!DOCTYPE GIFTI SYSTEM \"http://www.nitrc.org/frs/download.php/115/gifti.dtd\">\n"
      "<GIFTI Version=\"1.0\" NumberOfDataArrays=\"2\">\n  <MetaData/>\n  <LabelTable/>\n";
  append_array<float>(text, {points_intent, "NIFTI_TYPE_FLOAT32", mesh.V.rows()}, mesh.V);
  append_array<std::int32_t>(text, {triangles_intent, "NIFTI_TYPE_INT32", mesh.F.rows()}, mesh.F);
  return text + "</GIFTI>\n";
}

}  // namespace orbitutte
