// SPDX-License-Identifier: MIT
#include "orbitutte/io/ply.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <ostream>
#include <string>

#include "orbitutte/types.h"

namespace orbitutte::ply_test {
namespace {

using testing::ElementsAre;
using testing::EndsWith;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;

/// The bytes of numbers, as this machine stores them.
template <class... Numbers>
std::string native(Numbers... numbers) {
  std::string bytes;
  (bytes.append(reinterpret_cast<const char*>(&numbers), sizeof(numbers)), ...);
  return bytes;
}

/// The bytes of numbers, in the order in which this machine does not store them.
template <class... Numbers>
std::string swapped(Numbers... numbers) {
  std::string bytes;
  const auto append = [&](const std::string& number) { bytes.append(number.rbegin(), number.rend()); };
  (append(native(numbers)), ...);
  return bytes;
}

constexpr bool is_little = std::endian::native == std::endian::little;
const std::string native_format = is_little ? "binary_little_endian" : "binary_big_endian";
const std::string swapped_format = is_little ? "binary_big_endian" : "binary_little_endian";

std::string header(const std::string& format, const std::string& elements) {
  return "ply\nformat " + format + " 1.0\n" + elements + "end_header\n";
}

std::string refusal_of_ply(const std::string& bytes) {
  try {
    parse_ply(bytes);
  } catch (const MeshError& error) {
    return error.what();
  }
  return "no MeshError";
}

const std::string all_types =
    "element thing 2\nproperty char a\nproperty uchar b\nproperty short c\nproperty ushort d\n"
    "property int e\nproperty uint f\nproperty float g\nproperty double h\n";

void expect_extremes(const PlyFile& file) {
  const PlyElement* thing = file.find("thing");
  ASSERT_NE(thing, nullptr);
  EXPECT_THAT(thing->find("a")->values, ElementsAre(-128, 127));
  EXPECT_THAT(thing->find("b")->values, ElementsAre(0, 255));
  EXPECT_THAT(thing->find("c")->values, ElementsAre(-32768, 32767));
  EXPECT_THAT(thing->find("d")->values, ElementsAre(0, 65535));
  EXPECT_THAT(thing->find("e")->values, ElementsAre(-2147483648.0, 2147483647));
  EXPECT_THAT(thing->find("f")->values, ElementsAre(0, 4294967295.0));
  EXPECT_THAT(thing->find("g")->values, ElementsAre(-0.5, 0.25));
  EXPECT_THAT(thing->find("h")->values, ElementsAre(-1e-300, 1e300));
  EXPECT_EQ(thing->find("i"), nullptr);
  EXPECT_EQ(file.find("other"), nullptr);
}

TEST(Ply, AsciiHoldsTheExtremesOfEveryType) {
  expect_extremes(parse_ply(header("ascii", all_types) +
                            "-128 0 -32768 0 -2147483648 0 -0.5 -1e-300\n"
                            "127 255 32767 65535 2147483647 4294967295 .25 1e+300\n"));
}

using std::int16_t, std::int32_t, std::int8_t, std::uint16_t, std::uint32_t, std::uint8_t;

TEST(Ply, BothByteOrdersHoldTheExtremesOfEveryType) {
  const auto low = [](auto write) {
    return write(int8_t{-128}, uint8_t{0}, int16_t{-32768}, uint16_t{0}, std::numeric_limits<int32_t>::min(),
                 uint32_t{0}, -0.5f, -1e-300);
  };
  const auto high = [](auto write) {
    return write(int8_t{127}, uint8_t{255}, int16_t{32767}, uint16_t{65535},
                 std::numeric_limits<int32_t>::max(), std::numeric_limits<uint32_t>::max(), .25f, 1e300);
  };
  const auto as_native = [](auto... numbers) { return native(numbers...); };
  const auto as_swapped = [](auto... numbers) { return swapped(numbers...); };
  expect_extremes(parse_ply(header(native_format, all_types) + low(as_native) + high(as_native)));
  expect_extremes(parse_ply(header(swapped_format, all_types) + low(as_swapped) + high(as_swapped)));
}

TEST(Ply, BothNamesOfATypeMeanTheSame) {
  const std::string other_names =
      "element thing 2\nproperty int8 a\nproperty uint8 b\nproperty int16 c\nproperty uint16 d\n"
      "property int32 e\nproperty uint32 f\nproperty float32 g\nproperty float64 h\n";
  expect_extremes(parse_ply(header("ascii", other_names) +
                            "-128 0 -32768 0 -2147483648 0 -0.5 -1e-300\n"
                            "127 255 32767 65535 2147483647 4294967295 .25 1e+300\n"));
}

const std::string lists = "element face 3\nproperty list uchar int vertex_indices\nproperty uchar flag\n";

void expect_lists(const PlyFile& file) {
  const PlyProperty& indices = *file.find("face")->find("vertex_indices");
  EXPECT_TRUE(indices.is_list);
  EXPECT_THAT(indices.list_start, ElementsAre(0, 3, 3, 5));
  EXPECT_THAT(indices.values, ElementsAre(0, 1, 2, 7, -1));
  EXPECT_THAT(file.find("face")->find("flag")->values, ElementsAre(1, 2, 3));
}

TEST(Ply, ListsMayDifferInLengthAndBeEmpty) {
  expect_lists(parse_ply(header("ascii", lists) + "3 0 1 2 1\n0 2\n2 7 -1 3\n"));
  const auto bytes = [](auto write) {
    return write(uint8_t{3}, 0, 1, 2, uint8_t{1}, uint8_t{0}, uint8_t{2}, uint8_t{2}, 7, -1, uint8_t{3});
  };
  expect_lists(parse_ply(header(native_format, lists) + bytes([](auto... n) { return native(n...); })));
  expect_lists(parse_ply(header(swapped_format, lists) + bytes([](auto... n) { return swapped(n...); })));
}

TEST(Ply, AsciiElementsMayGoOnOverSeveralLines) {
  expect_lists(parse_ply(header("ascii", lists) + "3 0 1\n2\n1\n\n0 2\n2\n7 -1 3"));
}

TEST(Ply, CommentsAreKeptAndObjInfoIsPassedOver) {
  const PlyFile file = parse_ply(
      "ply\ncomment  by hand \nformat ascii 1.0\nobj_info scanned 1994\n\nelement a "
      "0\ncomment\nend_header\n");
  EXPECT_THAT(file.comments, ElementsAre("by hand", ""));
  EXPECT_THAT(file.elements, SizeIs(1));
}

TEST(Ply, HeadersMayEndTheirLinesInAnyWay) {
  for (const std::string end : {"\n", "\r\n", "\r"}) {
    // The first byte of the data is that of a line break.
    const std::string bytes = "ply" + end + "format " + native_format + " 1.0" + end + "element a 1" + end +
                              "property uint x" + end + "end_header" + end + native(uint32_t{0x0A0A0A0A});
    EXPECT_THAT(parse_ply(bytes).find("a")->find("x")->values, ElementsAre(0x0A0A0A0A));
  }
}

TEST(Ply, AsciiFloatsKeepAllTheirDigits) {
  const PlyFile file = parse_ply(header("ascii", "element a 1\nproperty float x\n") + "0.1234567890123456\n");
  EXPECT_THAT(file.find("a")->find("x")->values, ElementsAre(0.1234567890123456));
}

TEST(Ply, ElementsWithoutPropertiesTakeNoRoom) {
  const std::string elements = "element none 18446744073709551615\nelement a 1\nproperty int x\n";
  EXPECT_THAT(parse_ply(header("ascii", elements) + "5\n").find("a")->find("x")->values, ElementsAre(5));
  EXPECT_THAT(parse_ply(header(native_format, elements) + native(5)).find("a")->find("x")->values,
              ElementsAre(5));
}

TEST(Ply, BlanksBehindBinaryDataAreNoData) {
  const std::string bytes = header(native_format, "element a 1\nproperty int x\n") + native(5);
  EXPECT_THAT(parse_ply(bytes + "\r\n").find("a")->find("x")->values, ElementsAre(5));
}

TEST(Ply, WholeNumbersOf64BitsKeepAllTheirDigitsOrAreRefused) {
  const auto read = [](const std::string& type, const std::string& number) {
    return parse_ply(header("ascii", "element a 1\nproperty " + type + " x\n") + number + "\n");
  };
  EXPECT_THAT(read("int64", "-9223372036854775808").find("a")->find("x")->values, ElementsAre(-0x1p63));
  EXPECT_THAT(read("uint64", "9007199254740992").find("a")->find("x")->values, ElementsAre(0x1p53));
  EXPECT_THROW(read("uint64", "9007199254740993"), MeshError);
  EXPECT_THROW(read("uint64", "18446744073709551615"), MeshError);
  const std::string list = "element face 1\nproperty list uchar int64 vertex_indices\n";
  const std::int64_t large = 0x7FFFFFFFFFFFFE77;
  EXPECT_EQ(refusal_of_ply(header(native_format, list) + native(uint8_t{1}, large)),
            "byte 112: face 0 has the value 9223372036854775415 as 'vertex_indices', more digits than a "
            "double has; "
            "export the file again");
}

struct Refusal {
  std::string name;
  std::string bytes;
  std::string sentence;
};

void PrintTo(const Refusal& refusal, std::ostream* out) { *out << refusal.name; }

class PlyRefusal : public testing::TestWithParam<Refusal> {};

TEST_P(PlyRefusal, NamesTheLineOrByteAndTheElement) {
  EXPECT_EQ(refusal_of_ply(GetParam().bytes), GetParam().sentence);
}

const std::string mend = "; mend the file or export it again";
const std::string too_much =
    ", more than the rest of the file can hold, so that the file is cut short or its header wrong; export it "
    "again";
const std::string point = "element vertex 1\nproperty float x\nproperty float y\n";
const std::string triangle = "element face 1\nproperty list uchar int vertex_indices\n";

INSTANTIATE_TEST_SUITE_P(
    Header, PlyRefusal,
    testing::Values(
        Refusal{"NoPly", "hello\n",
                "line 1: the file does not begin with a line 'ply'; check that it is a PLY file"},
        Refusal{"OneWord", "ply",
                "line 1: the file does not begin with a line 'ply'; check that it is a PLY file"},
        Refusal{"NoEnd", "ply\nformat ascii 1.0\nelement vertex 1\n",
                "the header has no line 'end_header', so it is cut short; export the file again"},
        Refusal{"NoFormat", "ply\nend_header\n", "line 3: the header has no line 'format'" + mend},
        Refusal{"UnknownFormat", header("binary_middle_endian", ""),
                "line 2: the format 'binary_middle_endian' is none of ascii, binary_little_endian and "
                "binary_big_endian" +
                    mend},
        Refusal{"UnknownKeyword", header("ascii", "elements vertex 1\n"),
                "line 3: 'elements' is not a keyword of PLY headers" + mend},
        Refusal{"UnknownType", header("ascii", "element vertex 1\nproperty real x\n"),
                "line 4: 'real' is not a type of PLY properties" + mend},
        Refusal{"ElementWithoutName", header("ascii", "element\n"), "line 3: the element has no name" + mend},
        Refusal{"ElementWithoutCount", header("ascii", "element vertex\n"),
                "line 3: the element 'vertex' has no count" + mend},
        Refusal{"CountNoNumber", header("ascii", "element vertex many\n"),
                "line 3: the element 'vertex' has the count 'many', which is not a count" + mend},
        Refusal{"CountNegative", header("ascii", "element vertex -1\n"),
                "line 3: the element 'vertex' has the count '-1', which is not a count" + mend},
        Refusal{
            "CountTooLarge", header("ascii", "element vertex 18446744073709551616\n"),
            "line 3: the element 'vertex' has the count '18446744073709551616', which is not a count" + mend},
        Refusal{"PropertyWithoutElement", header("ascii", "property float x\n"),
                "line 3: a property stands before the first element" + mend},
        Refusal{"PropertyWithoutName", header("ascii", "element vertex 1\nproperty float\n"),
                "line 4: the property has no name" + mend},
        Refusal{"ListLengthAsFloat",
                header("ascii", "element face 1\nproperty list float int vertex_indices\n"),
                "line 4: the length of a list has a type that is not an integer" + mend}),
    [](const auto& test) { return test.param.name; });

INSTANTIATE_TEST_SUITE_P(
    Promise, PlyRefusal,
    testing::Values(
        Refusal{"OfBinary",
                header(native_format, "element vertex 3000000000\nproperty float x\n") + native(0.f),
                "the header promises 3000000000 elements 'vertex'" + too_much},
        Refusal{
            "ThatOverflows",
            header(native_format, "element vertex 18446744073709551615\nproperty double x\n") + native(0.0),
            "the header promises 18446744073709551615 elements 'vertex'" + too_much},
        Refusal{"OfLists",
                header(native_format, point + "element face 9\nproperty list ushort int vertex_indices\n") +
                    std::string(16, '\0'),
                "the header promises 9 elements 'face'" + too_much},
        Refusal{"OfAscii", header("ascii", "element vertex 4\nproperty float x\n") + "0 0 0",
                "the header promises 4 elements 'vertex'" + too_much}),
    [](const auto& test) { return test.param.name; });

INSTANTIATE_TEST_SUITE_P(
    AsciiData, PlyRefusal,
    testing::Values(
        Refusal{"NoNumber", header("ascii", point) + "0 zero\n",
                "line 7: vertex 0 has the y 'zero', which is not a number" + mend},
        Refusal{"Overflow", header("ascii", point) + "0 1e400\n",
                "line 7: vertex 0 has the y '1e400', which is out of range" + mend},
        Refusal{"NoInteger", header("ascii", triangle) + "3 0 1.5 2\n",
                "line 6: face 0 has the vertex_indices '1.5', which is not an integer" + mend},
        Refusal{"OutOfItsType", header("ascii", "element a 2\nproperty uchar red\n") + "255\n256\n",
                "line 7: a 1 has the red '256', which is out of range" + mend},
        Refusal{"NegativeList",
                header("ascii", "element face 1\nproperty list char int vertex_indices\n") + "-1\n",
                "line 6: face 0 has a list 'vertex_indices' of length -1" + mend},
        Refusal{"CutShortWithinAnElement", header("ascii", triangle) + "3 0 1\n",
                "line 7: the text ends within face 0" + mend},
        Refusal{"UnprintableNames", header("ascii", "element a\xB8 1\nproperty int \x01\n") + "x\n",
                "line 6: a? 0 has the ? 'x', which is not an integer" + mend},
        Refusal{"CutShortBeforeAnElement", header("ascii", point) + "  \n\n\n",
                "line 10: the text ends before vertex 0" + mend},
        Refusal{"TooManyValues", header("ascii", point) + "0 0 0\n",
                "line 7: '0' follows after the last property of vertex 0" + mend},
        Refusal{"TooManyElements", header("ascii", point) + "0 0\n0 0\n",
                "line 8: '0' follows after the last element that the header promises" + mend}),
    [](const auto& test) { return test.param.name; });

INSTANTIATE_TEST_SUITE_P(
    BinaryData, PlyRefusal,
    testing::Values(
        Refusal{"CutShort", header("binary_big_endian", triangle) + std::string("\3\0\0\0\0\0\0\0\1\0\0", 11),
                "byte 99: the file ends within face 0, property 'vertex_indices'; export the file again"},
        Refusal{"EndlessList",
                header("binary_big_endian", "element face 1\nproperty list uint double vertex_indices\n") +
                    std::string("\xFF\xFF\xFF\xFF\0\0", 6),
                "byte 104: face 0 has a list 'vertex_indices' of length 4294967295; export the file again"},
        Refusal{
            "NegativeList",
            header("binary_big_endian", "element face 1\nproperty list char int vertex_indices\n") + "\xFF",
            "byte 98: face 0 has a list 'vertex_indices' of length -1; export the file again"},
        Refusal{"TooManyBytes",
                header("binary_big_endian", "element a 1\nproperty int x\n") + std::string(7, '\0'),
                "byte 75: 3 bytes follow after the last element that the header promises; export the file "
                "again"}),
    [](const auto& test) { return test.param.name; });

// What is written

struct Limits {
  PlyType type;
  double lowest, highest;
};

constexpr Limits integer_limits[] = {{PlyType::int8, -128, 127},
                                     {PlyType::uint8, 0, 255},
                                     {PlyType::int16, -32768, 32767},
                                     {PlyType::uint16, 0, 65535},
                                     {PlyType::int32, -2147483648.0, 2147483647},
                                     {PlyType::uint32, 0, 4294967295.0},
                                     {PlyType::int64, -9007199254740992.0, 9007199254740992.0},
                                     {PlyType::uint64, 0, 9007199254740992.0}};

double value_of(PlyType type) {
  for (const Limits& limits : integer_limits) {
    if (limits.type != type) continue;
    return static_cast<double>(*rc::gen::inRange<long long>(limits.lowest, limits.highest + 1));
  }
  const double value = *rc::gen::arbitrary<double>();
  return type == PlyType::float32 ? static_cast<float>(value) : value;
}

PlyProperty random_property(std::size_t count, std::size_t number) {
  PlyProperty property;
  property.name = "p" + std::to_string(number);
  property.type = static_cast<PlyType>(*rc::gen::inRange(0, 10));
  property.is_list = *rc::gen::arbitrary<bool>();
  property.count_type = static_cast<PlyType>(*rc::gen::inRange(0, 8));
  if (property.is_list) property.list_start = {0};
  for (std::size_t i = 0; i < count; ++i) {
    const int length = property.is_list ? *rc::gen::inRange(0, 6) : 1;
    for (int k = 0; k < length; ++k) property.values.push_back(value_of(property.type));
    if (property.is_list) property.list_start.push_back(property.values.size());
  }
  return property;
}

PlyElement random_element(std::size_t number) {
  PlyElement element;
  element.name = "e" + std::to_string(number);
  element.count = *rc::gen::inRange<std::size_t>(0, 6);
  const auto properties = *rc::gen::inRange<std::size_t>(0, 4);
  for (std::size_t k = 0; k < properties; ++k)
    element.properties.push_back(random_property(element.count, k));
  return element;
}

PlyFile random_file() {
  PlyFile file;
  file.comments = {"first", "second comment"};
  const auto elements = *rc::gen::inRange<std::size_t>(0, 4);
  for (std::size_t k = 0; k < elements; ++k) file.elements.push_back(random_element(k));
  return file;
}

void assert_same(const PlyProperty& a, const PlyProperty& b) {
  RC_ASSERT(a.name == b.name);
  RC_ASSERT(a.type == b.type);
  RC_ASSERT(a.is_list == b.is_list);
  RC_ASSERT(!a.is_list || a.count_type == b.count_type);
  RC_ASSERT(a.values == b.values);
  RC_ASSERT(a.list_start == b.list_start);
}

void assert_same(const PlyFile& a, const PlyFile& b) {
  RC_ASSERT(a.comments == b.comments);
  RC_ASSERT(a.elements.size() == b.elements.size());
  for (std::size_t e = 0; e < a.elements.size(); ++e) {
    RC_ASSERT(a.elements[e].name == b.elements[e].name);
    RC_ASSERT(a.elements[e].count == b.elements[e].count);
    RC_ASSERT(a.elements[e].properties.size() == b.elements[e].properties.size());
    for (std::size_t p = 0; p < a.elements[e].properties.size(); ++p) {
      assert_same(a.elements[e].properties[p], b.elements[e].properties[p]);
    }
  }
}

RC_GTEST_PROP(PlyProperty, WhatIsWrittenComesBack, ()) {
  const PlyFile file = random_file();
  assert_same(parse_ply(serialize_ply(file)), file);
}

RC_GTEST_PROP(PlyProperty, WhatIsCutShortIsRefused, ()) {
  PlyFile file = random_file();
  file.elements.push_back({"last", 1, {{"x", PlyType::float64, false, PlyType::uint8, {1}, {}}}});
  const std::string bytes = serialize_ply(file);
  const auto size = *rc::gen::inRange<std::size_t>(0, bytes.size());
  RC_ASSERT_THROWS_AS(parse_ply(bytes.substr(0, size)), MeshError);
}

RC_GTEST_PROP(PlyProperty, ChangedBytesNeverDoHarm, ()) {
  std::string bytes = serialize_ply(random_file());
  const auto at = *rc::gen::inRange<std::size_t>(0, bytes.size());
  bytes[at] = *rc::gen::arbitrary<char>();
  try {
    parse_ply(bytes);
  } catch (const MeshError&) {
  }
}

std::string failed_write(const PlyFile& file) {
  try {
    serialize_ply(file);
  } catch (const ArgumentError& error) {
    return error.what();
  }
  return "no ArgumentError";
}

PlyFile one_property(std::size_t count, const PlyProperty& property) {
  return {{}, {{"a", count, {property}}}};
}

TEST(PlyWriting, ColumnsHaveToBeAsLongAsTheirElement) {
  const std::string sentence = "property 'x' does not have one value for each of 2 elements 'a'";
  EXPECT_EQ(failed_write(one_property(2, {"x", PlyType::float64, false, PlyType::uint8, {1}, {}})), sentence);
  EXPECT_EQ(failed_write(one_property(2, {"x", PlyType::int32, true, PlyType::uint8, {1, 2}, {0, 2}})),
            sentence);
  EXPECT_EQ(failed_write(one_property(2, {"x", PlyType::int32, true, PlyType::uint8, {1, 2}, {0, 3, 2}})),
            sentence);
  EXPECT_EQ(failed_write(one_property(2, {"x", PlyType::int32, true, PlyType::uint8, {1, 2}, {}})), sentence);
}

TEST(PlyWriting, ValuesHaveToFitTheirType) {
  EXPECT_EQ(failed_write(one_property(1, {"x", PlyType::uint8, false, PlyType::uint8, {256}, {}})),
            "property 'x' has the value 256, which is not of type uchar");
  EXPECT_EQ(failed_write(one_property(1, {"x", PlyType::int32, false, PlyType::uint8, {0.5}, {}})),
            "property 'x' has the value 0.5, which is not of type int");
  EXPECT_EQ(failed_write(one_property(1, {"x", PlyType::int32, false, PlyType::uint8, {std::nan("")}, {}})),
            "property 'x' has the value nan, which is not of type int");
  const std::vector<double> long_list(256, 0.0);
  EXPECT_EQ(failed_write(one_property(1, {"x", PlyType::int32, true, PlyType::uint8, long_list, {0, 256}})),
            "property 'x' has the value 256, which is not of type uchar");
}

TEST(PlyWriting, ACommentStaysInItsLine) {
  PlyFile file;
  file.comments = {"two\nlines"};
  EXPECT_THAT(parse_ply(serialize_ply(file)).comments, ElementsAre("two lines"));
}

}  // namespace
}  // namespace orbitutte::ply_test
