// SPDX-License-Identifier: MIT
// Values at vertices, in files of every format.
#include "orbitutte/io/vertex_data.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <rapidcheck/gtest.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <limits>
#include <string>
#include <vector>

#include "orbitutte/io/base64.h"
#include "orbitutte/io/bytes.h"
#include "orbitutte/io/compression.h"
#include "orbitutte/io/file.h"
#include "orbitutte/types.h"

namespace orbitutte::vertex_data_test {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

// Numbers that single precision has, so that every format keeps them.
VertexData measures(int vertices, int maps) {
  VertexData data;
  data.values.resize(vertices, maps);
  for (int v = 0; v < vertices; ++v)
    for (int map = 0; map < maps; ++map) data.values(v, map) = float(std::sin(1.7 * v + map) * 1e3);
  return data;
}

VertexData regions() {
  VertexData data;
  data.values.resize(5, 1);
  data.values << 2, 0, -1, 7, 2;
  data.labels = {{0, "unknown", {25 / 255.0, 5 / 255.0, 25 / 255.0, 1}},
                 {2, "insula \"<&>\"", {1, 192 / 255.0, 32 / 255.0, 1}},
                 {7, "gyrus", {0, 0, 1, 127 / 255.0}}};
  return data;
}

void expect_equal(const VertexData& a, const VertexData& b) {
  ASSERT_EQ(a.values.rows(), b.values.rows());
  ASSERT_EQ(a.values.cols(), b.values.cols());
  for (Eigen::Index k = 0; k < a.values.size(); ++k)
    EXPECT_TRUE(a.values(k) == b.values(k) || (std::isnan(a.values(k)) && std::isnan(b.values(k))));
  EXPECT_EQ(a.names, b.names);
}

struct Keeps {
  std::string ending;
  int maps;
  bool names, doubles;
};

class MeasuresComeBack : public testing::TestWithParam<Keeps> {};

TEST_P(MeasuresComeBack, FromTheirFile) {
  const Keeps& kept = GetParam();
  VertexData data = measures(23, kept.maps);
  data.values(3, 0) = std::numeric_limits<double>::quiet_NaN();
  data.values(4, 0) = std::numeric_limits<double>::infinity();
  if (kept.doubles) data.values(5, 0) = 1.0 / 3;
  if (kept.names)
    for (int map = 0; map < kept.maps; ++map) data.names.push_back(fmt::format("map, \"{}\" <&>", map));
  const VertexDataFormat format = vertex_data_format(kept.ending);
  expect_equal(parse_vertex_data(serialize_vertex_data(data, format), format), data);
}

INSTANTIATE_TEST_SUITE_P(Formats, MeasuresComeBack,
                         testing::Values(Keeps{"x.curv", 1, false, false},
                                         Keeps{"x.shape.gii", 3, true, false},
                                         Keeps{"x.func.gii", 1, true, false}, Keeps{"x.txt", 3, false, true},
                                         Keeps{"x.csv", 3, true, true}, Keeps{"x.csv", 1, false, true},
                                         Keeps{"x.npy", 3, false, true}, Keeps{"x.npy", 1, false, true}));

TEST(VertexData, LabelsComeBackWithTheirTable) {
  const VertexData data = regions();
  for (const VertexDataFormat format : {VertexDataFormat::annot, VertexDataFormat::label_gifti}) {
    const VertexData read = parse_vertex_data(serialize_vertex_data(data, format), format);
    expect_equal(read, data);
    ASSERT_EQ(read.labels.size(), data.labels.size());
    for (std::size_t k = 0; k < data.labels.size(); ++k) {
      EXPECT_EQ(read.labels[k].key, data.labels[k].key);
      EXPECT_EQ(read.labels[k].name, data.labels[k].name);
      for (int channel = 0; channel < 4; ++channel)
        EXPECT_NEAR(read.labels[k].colour[channel], data.labels[k].colour[channel], 1e-15);
    }
  }
}

struct ArrayKind {
  std::string encoding, order, endian, type;
};

class GiftiArrays
    : public testing::TestWithParam<std::tuple<const char*, const char*, const char*, const char*>> {};

template <class T>
void append(std::string& bytes, T number, bool is_big) {
  is_big ? append_big_endian(bytes, number) : append_little_endian(bytes, number);
}

// Bytes or text of an array whose numbers are 10 vertex + map, written here without the library's GIfTI code.
std::string encoded(const ArrayKind& kind, int rows, int columns) {
  std::string bytes, text;
  const bool by_columns = kind.order == "ColumnMajorOrder", is_big = kind.endian == "BigEndian";
  for (int k = 0; k < rows * columns; ++k) {
    const int row = by_columns ? k % rows : k / columns, column = by_columns ? k / rows : k % columns;
    const int number = 10 * row + column;
    text += fmt::format("{} ", number);
    if (kind.type == "NIFTI_TYPE_UINT8") append(bytes, std::uint8_t(number), is_big);
    if (kind.type == "NIFTI_TYPE_INT32") append(bytes, std::int32_t(number), is_big);
    if (kind.type == "NIFTI_TYPE_FLOAT32") append(bytes, float(number), is_big);
    if (kind.type == "NIFTI_TYPE_FLOAT64") append(bytes, double(number), is_big);
  }
  if (kind.encoding == "ASCII") return text;
  return base64(kind.encoding == "Base64Binary" ? bytes : compress(bytes));
}

TEST_P(GiftiArrays, OfEveryKindAreTheSame) {
  const auto [encoding, order, endian, type] = GetParam();
  const ArrayKind kind = {encoding, order, endian, type};
  constexpr int rows = 4, columns = 3;
  const std::string text = fmt::format(
      R"(<?xml version="1.0"?><GIFTI Version="1.0" NumberOfDataArrays="1"><LabelTable/><DataArray )"
      R"(Intent="NIFTI_INTENT_TIME_SERIES" DataType="{}" ArrayIndexingOrder="{}" Dimensionality="2" Dim0="{}" Dim1="{}" )"
      R"(Encoding="{}" Endian="{}" ExternalFileName="" ExternalFileOffset=""><Data>{}</Data></DataArray></GIFTI>)",
      type, order, rows, columns, encoding, endian, encoded(kind, rows, columns));
  const VertexData data = parse_vertex_data(text, VertexDataFormat::func_gifti);
  ASSERT_EQ(data.values.rows(), rows);
  ASSERT_EQ(data.values.cols(), columns);
  for (int row = 0; row < rows; ++row)
    for (int column = 0; column < columns; ++column) EXPECT_EQ(data.values(row, column), 10 * row + column);
}

INSTANTIATE_TEST_SUITE_P(Kinds, GiftiArrays,
                         testing::Combine(testing::Values("ASCII", "Base64Binary", "GZipBase64Binary"),
                                          testing::Values("RowMajorOrder", "ColumnMajorOrder"),
                                          testing::Values("LittleEndian", "BigEndian"),
                                          testing::Values("NIFTI_TYPE_UINT8", "NIFTI_TYPE_INT32",
                                                          "NIFTI_TYPE_FLOAT32", "NIFTI_TYPE_FLOAT64")));

TEST(VertexData, SurfacesInTheSameGiftiFileAreNoValues) {
  EXPECT_THAT(
      [] {
        const fs::path file = fs::path(ORBITUTTE_SOURCE_DIR) / "fuzz/corpus/gifti/text.gii";
        read_vertex_data(file.string());
      },
      testing::ThrowsMessage<MeshError>(HasSubstr("no DataArray but points and triangles")));
}

std::string three_bytes(int number) {
  return {static_cast<char>(number >> 16), static_cast<char>(number >> 8), static_cast<char>(number)};
}

TEST(Curv, OfTheOlderKindHoldsHundredths) {
  std::string bytes = three_bytes(2) + three_bytes(7);
  append_big_endian(bytes, std::int16_t{-250});
  append_big_endian(bytes, std::int16_t{7});
  const VertexData data = parse_vertex_data(bytes, VertexDataFormat::curv);
  ASSERT_EQ(data.values.rows(), 2);
  EXPECT_EQ(data.values(0), -2.5);
  EXPECT_EQ(data.values(1), 0.07);
}

std::string npy(const std::string& header, const std::string& numbers) {
  std::string bytes = "\x93NUMPY";
  bytes += std::string("\x01\x00", 2);
  append_little_endian(bytes, static_cast<std::uint16_t>(header.size()));
  return bytes + header + numbers;
}

TEST(Npy, OfBothOrdersAreTheSame) {
  std::string numbers, columns;
  for (const int k : {0, 1, 2, 10, 11, 12}) append_big_endian(numbers, static_cast<std::int16_t>(k));
  for (const int k : {0, 10, 1, 11, 2, 12}) append_little_endian(columns, static_cast<std::uint8_t>(k));
  const std::string rows_first = npy("{'descr': '>i2', 'fortran_order': False, 'shape': (2, 3), }", numbers);
  const std::string columns_first =
      npy("{'descr': '|u1', 'fortran_order': True, 'shape': (2, 3), }", columns);
  const VertexData a = parse_vertex_data(rows_first, VertexDataFormat::npy),
                   b = parse_vertex_data(columns_first, VertexDataFormat::npy);
  EXPECT_EQ(a.values, (Eigen::MatrixXd(2, 3) << 0, 1, 2, 10, 11, 12).finished());
  EXPECT_EQ(a.values, b.values);
}

TEST(Text, ManyLayoutsAreTheSame) {
  for (const std::string text :
       {"1 2\n3 4\n", "1,2\r\n3, 4", "\xEF\xBB\xBF# made by hand\n\n1\t2 # end\n3 4\n", "a b\n1 2\n3 4",
        "\"a\",b\r\n1,2\r\n3,4\r\n", "# x\na , b\n1 2\n3 4\n"}) {
    const VertexData data = parse_vertex_data(text, VertexDataFormat::csv);
    EXPECT_EQ(data.values, (Eigen::MatrixXd(2, 2) << 1, 2, 3, 4).finished()) << text;
    if (text.find('a') < text.find('1') && text.find("made") == text.npos) {
      EXPECT_EQ(data.names, (std::vector<std::string>{"a", "b"})) << text;
    }
  }
}

struct BadData {
  std::string bytes;
  VertexDataFormat format;
  std::string message;
};

class DataRefused : public testing::TestWithParam<BadData> {};

TEST_P(DataRefused, WithASentenceThatNamesTheFault) {
  try {
    parse_vertex_data(GetParam().bytes, GetParam().format);
    FAIL() << "was read";
  } catch (const MeshError& error) {
    EXPECT_THAT(error.what(), HasSubstr(GetParam().message));
  }
}

const std::string big_count = "\x7F\xFF\xFF\xFF", zero_count = std::string(4, '\0');

INSTANTIATE_TEST_SUITE_P(
    Files, DataRefused,
    testing::Values(
        BadData{"", VertexDataFormat::csv, "empty"},
        BadData{"1 2\n3\n", VertexDataFormat::text, "line 2: vertex 1 has 1"},
        BadData{"1\nx\n", VertexDataFormat::csv, "line 2: vertex 1 has the value 'x'"},
        BadData{"a,b\n1\n", VertexDataFormat::csv, "2 names"},
        BadData{"a\n", VertexDataFormat::csv, "no line of numbers"},
        BadData{"\xFF\xFF", VertexDataFormat::curv, "byte 0"},
        BadData{"\xFF\xFF\xFF" + big_count + zero_count + std::string("\0\0\0\1", 4), VertexDataFormat::curv,
                "the number of vertices is 2147483647, but only 0 bytes follow"},
        BadData{"\xFF\xFF\xFF" + zero_count + zero_count + zero_count, VertexDataFormat::curv, "0 values"},
        BadData{big_count, VertexDataFormat::annot, "2147483647"},
        BadData{zero_count, VertexDataFormat::annot, "no colour table"},
        BadData{"x", VertexDataFormat::npy, "numpy.save"},
        BadData{npy("{'descr': '<f8', 'fortran_order': False, 'shape': (9, 99), }", "12345678"),
                VertexDataFormat::npy, "promises 9 x 99 numbers, but only 1 follow"},
        BadData{npy("{'descr': '<c8', 'fortran_order': False, 'shape': (1,), }", "12345678"),
                VertexDataFormat::npy, "'<c8'"},
        BadData{npy("{'descr': '<f8', 'fortran_order': False, 'shape': (), }", "12345678"),
                VertexDataFormat::npy, "0 dimensions"}));

std::string refusal_of(const VertexData& data, VertexDataFormat format) {
  try {
    serialize_vertex_data(data, format);
  } catch (const MeshError& error) {
    return error.what();
  }
  return {};
}

TEST(VertexData, IsNotWrittenIntoFormatsThatCannotHoldIt) {
  EXPECT_THAT(refusal_of(measures(3, 2), VertexDataFormat::curv), HasSubstr("one map, but there are 2"));
  EXPECT_THAT(refusal_of(measures(3, 1), VertexDataFormat::annot), HasSubstr("no table of labels"));
  EXPECT_THAT(refusal_of(measures(3, 1), VertexDataFormat::label_gifti),
              HasSubstr("vertex 1, which is no whole"));
  VertexData data = regions();
  data.labels[0].colour = data.labels[1].colour;
  EXPECT_THAT(refusal_of(data, VertexDataFormat::annot), HasSubstr("the same colour"));
  data = regions();
  data.labels[0].key = -3;
  EXPECT_THAT(refusal_of(data, VertexDataFormat::annot), HasSubstr("key -3"));
  data = measures(3, 2);
  data.names = {"one"};
  EXPECT_THAT(refusal_of(data, VertexDataFormat::csv), HasSubstr("1 names for 2 maps"));
}

TEST(VertexData, FilesKnowTheirEndings) {
  EXPECT_EQ(vertex_data_format("folder.x/LH.Thickness.gz"), VertexDataFormat::curv);
  EXPECT_EQ(vertex_data_format("lh.aparc.annot"), VertexDataFormat::annot);
  EXPECT_EQ(vertex_data_format("a.LABEL.gii"), VertexDataFormat::label_gifti);
  EXPECT_EQ(vertex_data_format("a.gii"), VertexDataFormat::shape_gifti);
  EXPECT_FALSE(is_vertex_data_path("lh.pial"));
  EXPECT_THROW(vertex_data_format("thickness"), ArgumentError);
  const fs::path folder = fs::temp_directory_path() / ("orbitutte_values_" + std::to_string(::getpid()));
  fs::create_directory(folder);
  for (const char* name : {"lh.sulc", "lh.sulc.gz", "a.func.gii.gz", "a.csv"}) {
    const std::string path = (folder / name).string();
    write_vertex_data(path, measures(11, 1));
    expect_equal(read_vertex_data(path), measures(11, 1));
  }
  write_file((folder / "bad.csv").string(), "1\ny\n");
  EXPECT_THAT([&] { read_vertex_data((folder / "bad.csv").string()); },
              testing::ThrowsMessage<MeshError>(HasSubstr("bad.csv: line 2")));
  fs::remove_all(folder);
}

RC_GTEST_PROP(VertexData, NamesComeBackWhateverTheyHold, (const std::string& name)) {
  VertexData data = measures(2, 1);
  data.names = {"x" + name};
  const auto came_back = [&](VertexDataFormat format) {
    return parse_vertex_data(serialize_vertex_data(data, format), format).names.at(0);
  };
  // What XML and lines cannot hold is replaced, and what has been replaced stays.
  for (const VertexDataFormat format : {VertexDataFormat::shape_gifti, VertexDataFormat::csv}) {
    const std::string once = came_back(format);
    data.names = {once};
    RC_ASSERT(came_back(format) == once);
  }
}

}  // namespace
}  // namespace orbitutte::vertex_data_test
