// SPDX-License-Identifier: MIT
#include "orbitutte/io/mesh_io.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <rapidcheck/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <limits>
#include <ostream>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "orbitutte/io/file.h"
#include "test_meshes.h"

namespace orbitutte::mesh_io_test {
namespace {

namespace fs = std::filesystem;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::StartsWith;

using CornerLists = std::vector<std::vector<int>>;

CornerLists faces(const PolygonMesh& mesh) {
  CornerLists result(mesh.face_count());
  for (int f = 0; f < mesh.face_count(); ++f) {
    result[f].assign(mesh.corners.begin() + mesh.face_start[f],
                     mesh.corners.begin() + mesh.face_start[f + 1]);
  }
  return result;
}

std::vector<double> coordinates(const PolygonMesh& mesh) {
  return {mesh.V.data(), mesh.V.data() + mesh.V.size()};
}

const std::vector<double> corner_points = {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1};
const CornerLists corner_faces = {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}};

/// The tetrahedron of corner_points and corner_faces.
void expect_corner(const PolygonMesh& mesh) {
  EXPECT_EQ(coordinates(mesh), corner_points);
  EXPECT_EQ(faces(mesh), corner_faces);
}

std::string replaced(std::string text, const std::string& what, const std::string& by) {
  for (std::size_t at = text.find(what); at != text.npos; at = text.find(what, at + by.size())) {
    text.replace(at, what.size(), by);
  }
  return text;
}

// OBJ

PolygonMesh obj(const std::string& text) { return parse_mesh(text, MeshFormat::obj); }

const std::string obj_points = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\n";
const std::string obj_corner = obj_points + "f 1 3 2\nf 1 2 4\nf 2 3 4\nf 3 1 4\n";

TEST(Obj, VerticesAndFacesKeepTheirOrder) { expect_corner(obj(obj_corner)); }

TEST(Obj, LinesMayEndInAnyWayAndTheLastNeedNot) {
  for (const std::string end : {"\r\n", "\r", "\n\n", " \t\n"})
    expect_corner(obj(replaced(obj_corner, "\n", end)));
  expect_corner(obj(obj_corner.substr(0, obj_corner.size() - 1)));
}

TEST(Obj, TabsAndManyBlanksSeparateLikeOne) {
  expect_corner(obj(replaced(obj_corner, " ", "\t")));
  expect_corner(obj("  " + replaced(obj_corner, " ", " \t  ")));
}

TEST(Obj, ABackslashJoinsLines) {
  expect_corner(obj(replaced(obj_corner, " ", " \\\n  ")));
  expect_corner(obj(replaced(obj_corner, " ", "\\\r\n")));
}

TEST(Obj, ABackslashAtTheEndOfANameOrCommentJoinsNothing) {
  expect_corner(obj("mtllib C:\\models\\\n" + obj_points + "# from C:\\scans\\\n" +
                    obj_corner.substr(obj_points.size())));
}

TEST(Obj, CommentsAndAllOtherLinesArePassedOver) {
  expect_corner(obj("# corner\no corner\nvt 0 0\nvn 0 0 1\n" +
                    replaced(obj_corner, "f ", "g side\nusemtl #4\ns 1\nf ") +
                    "l 1 2\np 1\nvp 0.5\ncurv2 1\n"));
  expect_corner(obj(replaced(obj_corner, "\n", "# and so on\n")));
}

TEST(Obj, FurtherColumnsOfVerticesDoNotMoveThem) {
  expect_corner(obj(replaced(obj_corner, "v 0 0 0", "v 0 0 0 0.5 0.25 1")));
  expect_corner(obj(replaced(obj_corner, "v 0 0 0", "v 0 0 0 1")));
}

TEST(Obj, CornersMayHaveTexturesAndNormals) {
  EXPECT_EQ(
      faces(obj(obj_points + "f 1/1 2/2 3/3\nf 1//1 2//2 3//3\nf 1/1/1 2/2/2 3/3/3\nf 1/ 2// 3/-1/+1\n")),
      CornerLists(4, {0, 1, 2}));
}

TEST(Obj, NegativeIndicesCountBackFromTheLatestVertex) {
  EXPECT_EQ(faces(obj("v 0 0 0\nv 1 0 0\nv 0 1 0\nf -3 -2 -1\nv 0 0 1\nf -3//-1 -2 -1\n")),
            (CornerLists{{0, 1, 2}, {1, 2, 3}}));
}

TEST(Obj, FacesMayNameVerticesThatFollow) {
  EXPECT_EQ(faces(obj("f 1 2 3\n" + obj_points)), (CornerLists{{0, 1, 2}}));
}

TEST(Obj, PolygonsOfAnyDegreeAndIndicesOutOfRangeAreLeftToTheInspection) {
  EXPECT_EQ(faces(obj(obj_points + "f 1 2 3 4\nf 1 2\nf\nf 1 2 9\nf 2147483648 1 1\n")),
            (CornerLists{{0, 1, 2, 3}, {0, 1}, {}, {0, 1, 8}, {std::numeric_limits<int>::max(), 0, 0}}));
}

TEST(Obj, NumbersAreReadInEveryNotation) {
  EXPECT_EQ(
      coordinates(obj("v +1 -.5 1.\nv 1e3 +1.5E-3 -2.5e+2\nv 4.9e-324 1e-400 1.7976931348623157e308\n")),
      (std::vector<double>{1, -.5, 1, 1000, .0015, -250, 4.9e-324, 0, 1.7976931348623157e308}));
}

TEST(Obj, NumbersThatAreNotFiniteAreLeftToTheInspection) {
  const PolygonMesh mesh = obj("v nan inf -inf\n");
  EXPECT_TRUE(std::isnan(mesh.V(0, 0)));
  EXPECT_EQ(mesh.V(0, 1), std::numeric_limits<double>::infinity());
  EXPECT_EQ(mesh.V(0, 2), -std::numeric_limits<double>::infinity());
}

TEST(Obj, AByteOrderMarkIsPassedOver) { expect_corner(obj("\xEF\xBB\xBF" + obj_corner)); }

// OFF

PolygonMesh off(const std::string& text) { return parse_mesh(text, MeshFormat::off); }

const std::string off_points = "0 0 0\n1 0 0\n0 1 0\n0 0 1\n";
const std::string off_faces = "3 0 2 1\n3 0 1 3\n3 1 2 3\n3 2 0 3\n";
const std::string off_corner = "OFF\n4 4 6\n" + off_points + off_faces;

TEST(Off, VerticesAndFacesKeepTheirOrder) { expect_corner(off(off_corner)); }

TEST(Off, CountsMayStandOnTheLineOfTheKeywordOrTheNext) {
  expect_corner(off("OFF 4 4 6\n" + off_points + off_faces));
  expect_corner(off("OFF\n\n4 4 6\n" + off_points + off_faces));
}

TEST(Off, TheCountOfEdgesMayBeMissingOrWrong) {
  expect_corner(off("OFF 4 4\n" + off_points + off_faces));
  expect_corner(off("OFF\n4 4\n" + off_points + off_faces));
  expect_corner(off("OFF\n4 4 0\n" + off_points + off_faces));
}

TEST(Off, TheKeywordMayBeMissing) { expect_corner(off("4 4 6\n" + off_points + off_faces)); }

TEST(Off, NormalsColoursAndTextureCoordinatesDoNotMoveVertices) {
  for (const std::string keyword : {"OFF", "off", "COFF", "NOFF", "STOFF", "CNOFF", "STCNOFF"}) {
    expect_corner(off(keyword + "\n4 4 6\n" + replaced(off_points, "\n", " 128 128 128 255 0 0\n") +
                      replaced(off_faces, "\n", " 255 0 0\n")));
  }
}

TEST(Off, CommentsMayStandAnywhere) {
  expect_corner(off("# corner\n" + replaced(off_corner, "\n", "# and so on\n\n# more\n")));
}

TEST(Off, LinesMayEndInAnyWayAndTheLastNeedNot) {
  for (const std::string end : {"\r\n", "\r", " \t\n"}) expect_corner(off(replaced(off_corner, "\n", end)));
  expect_corner(off(off_corner.substr(0, off_corner.size() - 1)));
}

TEST(Off, PolygonsOfAnyDegreeAndIndicesOutOfRangeAreLeftToTheInspection) {
  EXPECT_EQ(faces(off("OFF\n4 4 0\n" + off_points + "4 0 1 2 3\n2 0 1\n0\n3 -1 9 0\n")),
            (CornerLists{{0, 1, 2, 3}, {0, 1}, {}, {-1, 9, 0}}));
}

TEST(Off, AMeshMayBeEmpty) {
  EXPECT_EQ(off("OFF 0 0 0").vertex_count(), 0);
  EXPECT_EQ(off("OFF 0 0 0").face_count(), 0);
}

// PLY

PolygonMesh ply(const std::string& bytes) { return parse_mesh(bytes, MeshFormat::ply); }

std::string ply_header(const std::string& format, const std::string& elements) {
  return "ply\nformat " + format + " 1.0\n" + elements + "end_header\n";
}

const std::string xyz = "property float x\nproperty float y\nproperty float z\n";
const std::string four_points = "element vertex 4\n" + xyz;

TEST(PlyMesh, VerticesAndFacesKeepTheirOrder) {
  for (const std::string name : {"vertex_indices", "vertex_index"}) {
    const std::string face = "element face 4\nproperty list uchar int " + name + "\n";
    expect_corner(ply(ply_header("ascii", four_points + face) + off_points + off_faces));
  }
}

TEST(PlyMesh, OtherElementsAndPropertiesArePassedOver) {
  const std::string elements =
      "element camera 1\nproperty list uchar float view\n"
      "element vertex 4\nproperty uchar id\n" +
      xyz +
      "property list char int tags\n"
      "element edge 1\nproperty int a\n"
      "element face 1\nproperty list uchar float uv\nproperty list uchar int vertex_indices\nproperty uchar "
      "flag\n"
      "element last 1\nproperty double d\n";
  const PolygonMesh mesh = ply(ply_header("ascii", elements) +
                               "2 0.5 0.5\n"
                               "7 0 0 0 0\n7 1 0 0 1 5\n7 0 1 0 2 5 6\n7 0 0 1 0\n"
                               "9\n"
                               "2 .5 .5 4 0 1 2 3 1\n"
                               "1e3\n");
  EXPECT_EQ(coordinates(mesh), corner_points);
  EXPECT_EQ(faces(mesh), (CornerLists{{0, 1, 2, 3}}));
}

TEST(PlyMesh, CoordinatesMayBeIntegersAndStandInAnyOrder) {
  const PolygonMesh mesh =
      ply(ply_header("ascii", "element vertex 1\nproperty char z\nproperty short x\nproperty uint y\n") +
          "-1 2 3\n");
  EXPECT_EQ(coordinates(mesh), (std::vector<double>{2, 3, -1}));
}

const std::string strips = "property list int int vertex_indices\n";

TEST(PlyMesh, EveryOtherTriangleOfAStripIsTurned) {
  EXPECT_EQ(faces(ply(ply_header("ascii", "element vertex 0\n" + xyz + "element tristrips 1\n" + strips) +
                      "6 0 1 2 3 4 5\n")),
            (CornerLists{{0, 1, 2}, {2, 1, 3}, {2, 3, 4}, {4, 3, 5}}));
}

TEST(PlyMesh, MinusOneBeginsAStripAnewAndSoDoesEveryList) {
  EXPECT_EQ(faces(ply(ply_header("ascii", "element vertex 0\n" + xyz + "element tristrips 4\n" + strips) +
                      "9 0 1 2 3 -1 4 5 6 -1\n2 7 8\n0\n8 -1 -1 7 -1 6 7 8 9\n")),
            (CornerLists{{0, 1, 2}, {2, 1, 3}, {4, 5, 6}, {6, 7, 8}, {8, 7, 9}}));
}

TEST(PlyMesh, FacesStandBeforeStrips) {
  const std::string elements = four_points + "element tristrips 1\n" + strips +
                               "element face 1\nproperty list uchar int vertex_indices\n";
  EXPECT_EQ(faces(ply(ply_header("ascii", elements) + off_points + "3 1 2 3\n3 0 1 2\n")),
            (CornerLists{{0, 1, 2}, {1, 2, 3}}));
}

TEST(PlyMesh, PointsWithoutFacesAreLeftToTheInspection) {
  EXPECT_EQ(ply(ply_header("ascii", four_points) + off_points).face_count(), 0);
}

/// A binary file of triangles, as its bytes and as what has to be read from it.
struct BinaryTriangles {
  std::string bytes;
  std::vector<double> points;
  std::vector<int> corners;
};

template <class T>
std::string number_bytes(T number, bool is_big) {
  std::string bytes(sizeof(T), '\0');
  std::memcpy(bytes.data(), &number, sizeof(T));
  const std::uint16_t one = 1;
  const bool machine_is_big = *reinterpret_cast<const char*>(&one) == 0;
  if (is_big != machine_is_big) std::reverse(bytes.begin(), bytes.end());
  return bytes;
}

/// What distinguishes the files that the bulk reader takes, and the generic one.
struct Layout {
  bool is_big, has_doubles, has_further_vertex_properties, is_unsigned, has_face_flags;
};

BinaryTriangles random_triangles(const Layout& layout) {
  const auto points = *rc::gen::container<std::vector<float>>(rc::gen::arbitrary<float>());
  const auto indices =
      *rc::gen::container<std::vector<int>>(rc::gen::inRange(0, std::numeric_limits<int>::max()));
  const std::size_t n = points.size() / 3, m = indices.size() / 3;
  const std::string type = layout.has_doubles ? "double" : "float";
  const std::string index_type = layout.is_unsigned ? "uint" : "int";
  const std::string id = layout.has_further_vertex_properties ? "property ushort id\n" : "";
  const std::string flag = layout.has_face_flags ? "property uchar flag\n" : "";
  BinaryTriangles result;
  result.bytes = ply_header(layout.is_big ? "binary_big_endian" : "binary_little_endian",
                            "element vertex " + std::to_string(n) + "\n" + id + replaced(xyz, "float", type) +
                                "element face " + std::to_string(m) + "\nproperty list uchar " + index_type +
                                " vertex_indices\n" + flag);
  for (std::size_t i = 0; i < 3 * n; ++i) {
    if (i % 3 == 0 && layout.has_further_vertex_properties)
      result.bytes += number_bytes(std::uint16_t{7}, layout.is_big);
    result.bytes += layout.has_doubles ? number_bytes(double{points[i]}, layout.is_big)
                                       : number_bytes(points[i], layout.is_big);
    result.points.push_back(points[i]);
  }
  for (std::size_t i = 0; i < 3 * m; ++i) {
    if (i % 3 == 0) result.bytes += '\3';
    result.bytes += number_bytes(indices[i], layout.is_big);
    result.corners.push_back(indices[i]);
    if (i % 3 == 2 && layout.has_face_flags) result.bytes += '\1';
  }
  return result;
}

RC_GTEST_PROP(PlyMeshProperty, TheLayoutOfBinaryTrianglesMakesNoDifference, ()) {
  const auto any = [] { return *rc::gen::arbitrary<bool>(); };
  const BinaryTriangles file = random_triangles({any(), any(), any(), any(), any()});
  const PolygonMesh mesh = ply(file.bytes);
  RC_ASSERT(coordinates(mesh) == file.points);
  RC_ASSERT(mesh.corners == file.corners);
  RC_ASSERT(mesh.face_count() == static_cast<int>(file.corners.size()) / 3);
  for (int f = 0; f < mesh.face_count(); ++f) RC_ASSERT(mesh.face_degree(f) == 3);
}

TEST(PlyMesh, BinaryTrianglesAndQuadranglesMayBeMixed) {
  // As many bytes as two triangles take.
  const std::string bytes = std::string(1, '\2') + number_bytes(0, false) + number_bytes(1, false) + '\4' +
                            number_bytes(0, false) + number_bytes(1, false) + number_bytes(2, false) +
                            number_bytes(3, false);
  EXPECT_EQ(faces(ply(ply_header("binary_little_endian",
                                 "element vertex 0\n" + xyz +
                                     "element face 2\nproperty list uchar int vertex_indices\n") +
                      bytes)),
            (CornerLists{{0, 1}, {0, 1, 2, 3}}));
}

// STL

PolygonMesh stl(const std::string& bytes) { return parse_mesh(bytes, MeshFormat::stl); }

std::string facet(const std::string& a, const std::string& b, const std::string& c) {
  return "facet normal 0 0 0\n  outer loop\n    vertex " + a + "\n    vertex " + b + "\n    vertex " + c +
         "\n  endloop\nendfacet\n";
}

const std::string o = "0 0 0", x = "1 0 0", y = "0 1 0", z = "0 0 1";
const std::string stl_facets = facet(o, y, x) + facet(o, x, z) + facet(x, y, z) + facet(y, o, z);

/// The corner's tetrahedron with its vertices in the order of their first use.
void expect_welded_corner(const PolygonMesh& mesh) {
  EXPECT_EQ(coordinates(mesh), (std::vector<double>{0, 0, 0, 0, 1, 0, 1, 0, 0, 0, 0, 1}));
  EXPECT_EQ(faces(mesh), (CornerLists{{0, 1, 2}, {0, 2, 3}, {2, 1, 3}, {1, 0, 3}}));
}

std::string binary_stl(std::string title, std::uint32_t count,
                       const std::vector<std::array<float, 9>>& triangles) {
  title.resize(80, ' ');
  std::string bytes = title + number_bytes(count, false);
  for (const auto& corners : triangles) {
    for (int axis = 0; axis < 3; ++axis) bytes += number_bytes(0.5f, false);
    for (const float coordinate : corners) bytes += number_bytes(coordinate, false);
    bytes += "\x1F\x7C";  // the attribute, which some programs use for colours
  }
  return bytes;
}

const std::vector<std::array<float, 9>> stl_triangles = {{0, 0, 0, 0, 1, 0, 1, 0, 0},
                                                         {0, 0, 0, 1, 0, 0, 0, 0, 1},
                                                         {1, 0, 0, 0, 1, 0, 0, 0, 1},
                                                         {0, 1, 0, 0, 0, 0, 0, 0, 1}};

TEST(Stl, CornersAreWeldedInTheOrderOfTheirFirstUse) {
  expect_welded_corner(stl("solid corner\n" + stl_facets + "endsolid corner\n"));
  expect_welded_corner(stl(binary_stl("corner", 4, stl_triangles)));
}

TEST(Stl, ABinaryFileMayBeginWithTheWordSolid) {
  expect_welded_corner(stl(binary_stl("solid corner", 4, stl_triangles)));
}

TEST(Stl, SolidsAreWeldedWithEachOther) {
  expect_welded_corner(stl("solid a\n" + facet(o, y, x) + facet(o, x, z) + "endsolid a\n\nsolid\n" +
                           facet(x, y, z) + facet(y, o, z) + "endsolid\n"));
}

TEST(Stl, KeywordsMayBeInUpperCaseAndLinesEndInAnyWay) {
  std::string text = "solid corner\n" + stl_facets + "endsolid corner\n";
  expect_welded_corner(stl(replaced(text, "\n", "\r\n")));
  expect_welded_corner(stl(" \n" + replaced(text, "outer loop\n", "outer\nloop ")));
  std::transform(text.begin(), text.end(), text.begin(), [](unsigned char c) { return std::toupper(c); });
  expect_welded_corner(stl(text));
}

TEST(Stl, NumbersAreReadInEveryNotation) {
  expect_welded_corner(stl("solid\n" + replaced(stl_facets, "1", "+1.0E+00") + "endsolid\n"));
  expect_welded_corner(stl("solid\n" + replaced(stl_facets, "1", "100e-2") + "endsolid\n"));
}

TEST(Stl, NormalsArePassedOver) {
  expect_welded_corner(
      stl("solid\n" + replaced(stl_facets, "normal 0 0 0", "normal -nan(ind) 1.#QNAN x") + "endsolid\n"));
}

TEST(Stl, MinusZeroIsZeroAndNotANumberIsItself) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const PolygonMesh mesh =
      stl(binary_stl("", 2, {{0, 0, 0, 0, 1, -0.f, nan, 0, 0}, {nan, -0.f, 0, 1, 0, 0, -0.f, 0, 0}}));
  EXPECT_EQ(faces(mesh), (CornerLists{{0, 1, 2}, {2, 3, 0}}));
  const std::string text =
      "solid\n" + facet("-0 0 0", "0 1 0", "1 0 0") + facet("0 -0.0 0", "1 0 0", "0 0 1");
  EXPECT_EQ(faces(stl(text + "endsolid\n")), (CornerLists{{0, 1, 2}, {0, 2, 3}}));
}

TEST(Stl, TheSmallestDifferenceKeepsVerticesApart) {
  EXPECT_EQ(faces(stl("solid\n" + facet("1 0 0", "1.0000000000000002 0 0", "0 0 4.9e-324") + "endsolid\n")),
            (CornerLists{{0, 1, 2}}));
}

TEST(Stl, AMeshMayBeEmpty) {
  EXPECT_EQ(stl("solid\nendsolid\n").face_count(), 0);
  EXPECT_EQ(stl(binary_stl("", 0, {})).face_count(), 0);
}

// Refusals

std::string refusal_of_mesh(const std::string& bytes, MeshFormat format) {
  try {
    parse_mesh(bytes, format);
  } catch (const MeshError& error) {
    return error.what();
  }
  return "no MeshError";
}

struct Refusal {
  std::string name;
  std::string bytes;
  std::string sentence;
};

void PrintTo(const Refusal& refusal, std::ostream* out) { *out << refusal.name; }

std::string test_name(const testing::TestParamInfo<Refusal>& test) { return test.param.name; }

const std::string mend = "; mend the file or export it again";

class ObjRefusal : public testing::TestWithParam<Refusal> {};

TEST_P(ObjRefusal, NamesTheLineAndTheElement) {
  EXPECT_EQ(refusal_of_mesh(GetParam().bytes, MeshFormat::obj), GetParam().sentence);
}

INSTANTIATE_TEST_SUITE_P(
    Obj, ObjRefusal,
    testing::Values(
        Refusal{"Empty", "", "the file is empty; export it again"},
        Refusal{"NoVertices", "<html>\nf 1 2 3\n",
                "no line begins with 'v', so there are no vertices; check that it is an OBJ file"},
        Refusal{"CoordinateMissing", "v 0 0 0\n\nv 0 0\n",
                "line 3: the line ends where vertex 1 needs another coordinate" + mend},
        Refusal{"CoordinateNoNumber", "v 0 0 0\nv 0 1,5 0\n",
                "line 2: vertex 1 has the coordinate '1,5', which is not a number" + mend},
        Refusal{"CoordinateWithRest", "v 0 1.5x 0\n",
                "line 1: vertex 0 has the coordinate '1.5x', which is not a number" + mend},
        Refusal{"CoordinateHexadecimal", "v 0 0x10 0\n",
                "line 1: vertex 0 has the coordinate '0x10', which is not a number" + mend},
        Refusal{"CoordinateTooLarge", "v 0 0 -1e400\n",
                "line 1: vertex 0 has the coordinate '-1e400', which is out of range" + mend},
        Refusal{"CoordinateWithTwoSigns", "v 0 +-1 0\n",
                "line 1: vertex 0 has the coordinate '+-1', which is not a number" + mend},
        Refusal{"IndexZero", obj_points + "f 1 2 3\nf 0 1 2\n",
                "line 6: face 1 has the index 0, but OBJ counts from 1" + mend},
        Refusal{"IndexBeforeTheFirst", obj_points + "f -1 -4 -5\n",
                "line 5: face 0 has the index -5, but only 4 vertices come before it" + mend},
        Refusal{"IndexNoInteger", obj_points + "f 1 2 x\n",
                "line 5: face 0 has the index 'x', which is not an integer" + mend},
        Refusal{"IndexAsFloat", obj_points + "f 1 2 3.0\n",
                "line 5: face 0 has the index '3.0', which is not an integer" + mend},
        Refusal{"IndexMissing", obj_points + "f 1 2 /3\n",
                "line 5: face 0 has the index '/3', which is not an integer" + mend},
        Refusal{"IndexTooLarge", obj_points + "f 1 2 2147483649\n",
                "line 5: face 0 has the index '2147483649', which is out of range" + mend},
        Refusal{"IndexFarTooLarge", obj_points + "f 1 2 99999999999999999999\n",
                "line 5: face 0 has the index '99999999999999999999', which is out of range" + mend},
        Refusal{"TextureNoIndex", obj_points + "f 1/x 2 3\n",
                "line 5: face 0 has the corner '1/x', which is none of v, v/vt, v//vn, v/vt/vn" + mend},
        Refusal{"CornerOfFourParts", obj_points + "f 1/2/3/4 2 3\n",
                "line 5: face 0 has the corner '1/2/3/4', which is none of v, v/vt, v//vn, v/vt/vn" + mend},
        Refusal{"LineBehindContinuations", "v 0 \\\n 0 \\\r\n 0\nv 0 x 0\n",
                "line 4: vertex 1 has the coordinate 'x', which is not a number" + mend},
        Refusal{"BytesThatCannotBeShown", "v 0 \x01z\xFF\n",
                "line 1: vertex 0 has the coordinate '?z?', which is not a number" + mend},
        Refusal{"EndlessWord", "v 0 " + std::string(1000, 'x') + "\n",
                "line 1: vertex 0 has the coordinate '" + std::string(40, 'x') +
                    "...', which is not a number" + mend}),
    test_name);

class OffRefusal : public testing::TestWithParam<Refusal> {};

TEST_P(OffRefusal, NamesTheLineAndTheElement) {
  EXPECT_EQ(refusal_of_mesh(GetParam().bytes, MeshFormat::off), GetParam().sentence);
}

INSTANTIATE_TEST_SUITE_P(
    Off, OffRefusal,
    testing::Values(
        Refusal{"Empty", "", "the file is empty; export it again"},
        Refusal{"Blank", "\n \n", "line 3: the header lacks the number of vertices" + mend},
        Refusal{"Text", "hello\n",
                "line 1: the header has 'hello' where the number of vertices belongs" + mend},
        Refusal{"Binary", std::string("OFF BINARY\n\0\0\0\4", 15),
                "byte 4 behind the first line: the file ends before the number of faces; copy or export the "
                "file again"},
        Refusal{"FourDimensions", "4OFF\n1 0 0\n0 0 0 1\n",
                "line 1: '4OFF' announces points of a dimension other than three" + mend},
        Refusal{"AnyDimension", "# two\nnOFF 2\n1 0 0\n0 0\n",
                "line 2: 'nOFF' announces points of a dimension other than three" + mend},
        Refusal{"CountMissing", "OFF\n4\n", "line 2: the header lacks the number of faces" + mend},
        Refusal{"TwoCountsWithoutKeyword", "4 4\n" + off_points + off_faces,
                "line 1: the header lacks the number of edges" + mend},
        Refusal{"FourCounts", "OFF\n4 4 6 0\n" + off_points + off_faces,
                "line 2: the header has more than three counts" + mend},
        Refusal{"CountNegative", "OFF\n4 -4 0\n",
                "line 2: the header has '-4' where the number of faces belongs" + mend},
        Refusal{"CountTooLarge", "OFF\n2147483648 4 0\n",
                "line 2: the header has '2147483648' where the number of vertices belongs" + mend},
        Refusal{
            "PromiseOfVertices", "OFF\n2147483647 0 0\n0 0 0\n",
            "line 2: the header promises 2147483647 vertices and 0 faces, but only 7 bytes follow" + mend},
        Refusal{
            "PromiseOfFaces", "OFF\n0 2147483647 0\n0 0 0\n",
            "line 2: the header promises 0 vertices and 2147483647 faces, but only 7 bytes follow" + mend},
        Refusal{"CutShortInVertices", "OFF\n3 0 0\n0.000 0.000 0.000\n1.000 0.000 0.000\n",
                "line 5: the text ends before vertex 2, but the header promises 3" + mend},
        Refusal{"CutShortInFaces", "OFF\n4 4 0\n" + off_points + "3 0 2 1\n3 0 1 3\n",
                "line 9: the text ends before face 2, but the header promises 4" + mend},
        Refusal{"CutShortInALine", "OFF\n4 4 6\n" + off_points + "3 0 2 1\n3 0 1 3\n3 1 2 3\n3 2 ",
                "line 10: the line ends where face 3 needs another index" + mend},
        Refusal{"TooManyLines", "OFF\n4 3 0\n" + off_points + off_faces,
                "line 10: '3' follows after the 4 vertices and 3 faces that the header promises" + mend},
        Refusal{"CoordinateMissing", "OFF\n4 4 0\n0 0\n" + off_points + off_faces,
                "line 3: the line ends where vertex 0 needs another coordinate" + mend},
        Refusal{"CoordinateNoNumber", "OFF\n4 4 0\n0 0 O\n" + off_points + off_faces,
                "line 3: vertex 0 has the coordinate 'O', which is not a number" + mend},
        Refusal{"CoordinateTooLarge", "OFF\n4 4 0\n0 0 1e400\n" + off_points + off_faces,
                "line 3: vertex 0 has the coordinate '1e400', which is out of range" + mend},
        Refusal{"DegreeNoInteger", "OFF\n4 1 0\n" + off_points + "3.0 0 1 2\n",
                "line 7: face 0 has the number of corners '3.0', which is not an integer" + mend},
        Refusal{"DegreeNegative", "OFF\n4 1 0\n" + off_points + "-3 0 1 2\n",
                "line 7: face 0 has -3 corners" + mend},
        Refusal{"DegreeTooLarge", "OFF\n4 1 0\n" + off_points + "2147483647 0 1 2\n",
                "line 7: the line ends where face 0 needs another index" + mend},
        Refusal{"IndexNoInteger", "OFF\n4 1 0\n" + off_points + "3 0 x 2\n",
                "line 7: face 0 has the index 'x', which is not an integer" + mend},
        Refusal{"IndexTooLarge", "OFF\n4 1 0\n" + off_points + "3 0 1 2147483648\n",
                "line 7: face 0 has the index '2147483648', which is out of range" + mend}),
    test_name);

TEST(Off, NoBlankNeedStandBehindTheKeyword) {
  for (const std::string keyword : {"OFF4 4 6\n", "OFF4 4\n", "off4 4 6\n", "COFF4 4 6\n"})
    expect_corner(parse_mesh(keyword + off_points + off_faces, MeshFormat::off));
}

TEST(Off, NumbersMayStandInAnyLinesWhereNothingElseDoes) {
  const std::string numbers = off_points + off_faces;
  expect_corner(parse_mesh("OFF\n4 4 6\n" + replaced(numbers, " ", "\n"), MeshFormat::off));
  expect_corner(parse_mesh("OFF\n4 4 6\n" + replaced(numbers, "\n", " "), MeshFormat::off));
  expect_corner(parse_mesh("OFF\n4 4 6\n" + replaced(numbers, " 2", "\n2"), MeshFormat::off));
}

TEST(MeshFiles, InUtf16AreNamedWithTheRemedy) {
  const auto wide = [](const std::string& text, bool big) {
    std::string bytes;
    for (const char c : text) bytes += big ? std::string({'\0', c}) : std::string({c, '\0'});
    return bytes;
  };
  const std::string sentence = "the file is UTF-16 text; save it as UTF-8";
  for (const auto& [text, format] : {std::pair(obj_corner, MeshFormat::obj),
                                     std::pair("OFF\n4 4 6\n" + off_points + off_faces, MeshFormat::off),
                                     std::pair(std::string("ply\nformat ascii 1.0\n"), MeshFormat::ply),
                                     std::pair(std::string("solid\nendsolid\n"), MeshFormat::stl)}) {
    EXPECT_EQ(refusal_of_mesh(wide(text, false), format), sentence);
    EXPECT_EQ(refusal_of_mesh(wide(text, true), format), sentence);
    EXPECT_EQ(refusal_of_mesh("\xFF\xFE" + wide(text, false), format), sentence);
    EXPECT_EQ(refusal_of_mesh("\xFE\xFF" + wide(text, true), format), sentence);
  }
}

TEST(Stl, BytesBehindTheLastFacetArePassedOverWithAWarning) {
  const std::string whole = binary_stl("", 4, stl_triangles);
  EXPECT_THAT(parse_mesh(whole, MeshFormat::stl).warnings, testing::IsEmpty());
  for (const std::size_t behind : {1, 49, 51, 80}) {
    const PolygonMesh mesh = parse_mesh(whole + std::string(behind, '\n'), MeshFormat::stl);
    EXPECT_EQ(mesh.face_count(), 4);
    EXPECT_THAT(mesh.warnings, testing::ElementsAre(testing::HasSubstr("ignored after the 4 triangles")));
  }
}

TEST(Stl, FacetsWithTwoEqualCornersAreLeftOutWithAWarning) {
  const std::string text = "solid\n" + facet(o, x, y) + facet(o, x, o) + facet(x, x, y) + "endsolid\n";
  const PolygonMesh mesh = parse_mesh(text, MeshFormat::stl);
  EXPECT_EQ(mesh.face_count(), 1);
  EXPECT_EQ(mesh.vertex_count(), 3);
  EXPECT_THAT(mesh.warnings,
              testing::ElementsAre("facet 1 has two corners at the same point (2 such facets): it "
                                   "is left out, and the faces are numbered without it"));
}

class PlyMeshRefusal : public testing::TestWithParam<Refusal> {};

TEST_P(PlyMeshRefusal, NamesTheElement) {
  EXPECT_EQ(refusal_of_mesh(GetParam().bytes, MeshFormat::ply), GetParam().sentence);
}

INSTANTIATE_TEST_SUITE_P(
    PlyMesh, PlyMeshRefusal,
    testing::Values(
        Refusal{"Empty", "", "the file is empty; export it again"},
        Refusal{"NoVertices", ply_header("ascii", ""),
                "there is no element 'vertex'; check that the file holds a mesh"},
        Refusal{"NoCoordinate",
                ply_header("ascii", "element vertex 1\nproperty float x\nproperty float y\n") + "0 0\n",
                "the element 'vertex' has no coordinate 'z'; export the file again"},
        Refusal{"CoordinateAsList",
                ply_header(
                    "ascii",
                    "element vertex 1\nproperty list uchar float x\nproperty float y\nproperty float z\n") +
                    "1 0 0 0\n",
                "the element 'vertex' has no coordinate 'x'; export the file again"},
        Refusal{"NoIndices",
                ply_header("ascii", four_points + "element face 1\nproperty int a\n") + off_points + "1\n",
                "the element 'face' has no list 'vertex_indices'; export the file again"},
        Refusal{"NoIndicesOfStrips",
                ply_header("ascii", four_points + "element tristrips 1\nproperty int vertex_indices\n") +
                    off_points + "1\n",
                "the element 'tristrips' has no list 'vertex_indices'; export the file again"},
        Refusal{
            "IndexNoInteger",
            ply_header("ascii", four_points + "element face 1\nproperty list uchar float vertex_indices\n") +
                off_points + "3 0 1.5 2\n",
            "face 0 has the index 1.5, which is not an integer; export the file again"},
        Refusal{
            "IndexNoNumber",
            ply_header("ascii", four_points + "element face 1\nproperty list uchar float vertex_indices\n") +
                off_points + "3 0 nan 2\n",
            "face 0 has the index nan, which is not an integer; export the file again"},
        Refusal{
            "IndexTooLarge",
            ply_header("ascii", four_points + "element face 2\nproperty list uchar uint vertex_indices\n") +
                off_points + "3 0 1 2\n3 0 1 2147483648\n",
            "face 1 has the index 2147483648, which is out of range; export the file again"},
        Refusal{
            "IndexTooLargeInBinary",
            ply_header("binary_big_endian", "element vertex 0\n" + xyz +
                                                "element face 1\nproperty list uchar uint vertex_indices\n") +
                '\3' + number_bytes(0, true) + number_bytes(1, true) + number_bytes(~0u, true),
            "face 0 has the index 4294967295, which is out of range; export the file again"}),
    test_name);

class StlRefusal : public testing::TestWithParam<Refusal> {};

TEST_P(StlRefusal, NamesTheLineOrByteAndTheElement) {
  EXPECT_EQ(refusal_of_mesh(GetParam().bytes, MeshFormat::stl), GetParam().sentence);
}

const std::string whole_stl = binary_stl("", 4, stl_triangles);

INSTANTIATE_TEST_SUITE_P(
    Stl, StlRefusal,
    testing::Values(
        Refusal{"Empty", "", "the file is empty; export it again"},
        Refusal{"CutShortInTheHeader", whole_stl.substr(0, 40),
                "the file neither begins with 'solid' nor has the 84 bytes of a binary STL header, but 40 "
                "bytes; check "
                "that it is an STL file"},
        Refusal{"BinaryCutShort", whole_stl.substr(0, whole_stl.size() - 1),
                "byte 80: the header promises 4 triangles in 284 bytes, but the file has 283 bytes, so that "
                "it is cut "
                "short; export it again"},
        Refusal{"BinaryCutShortThatSaysSolid", binary_stl("solid", 5, stl_triangles),
                "byte 80: the header promises 5 triangles in 334 bytes, but the file has 284 bytes, so that "
                "it is cut "
                "short; export it again"},
        Refusal{"BinaryTooLong", binary_stl("", 3, stl_triangles),
                "byte 80: the header promises 3 triangles in 234 bytes, but the file has 284 bytes, so that "
                "it is "
                "corrupt; export it again"},
        Refusal{"BinaryPromise", binary_stl("", 4294967295, stl_triangles),
                "byte 80: the header promises 4294967295 triangles in 214748364834 bytes, but the file has "
                "284 bytes, so "
                "that it is cut short; export it again"},
        Refusal{"NoEnd", "solid\n" + facet(o, x, y), "line 9: the text ends before 'endsolid'" + mend},
        Refusal{"CutShortInAFacet", "solid\n" + facet(o, x, y) + "facet normal 0 0 1\nouter loop\n",
                "line 11: the text ends within facet 1, where 'vertex' belongs" + mend},
        Refusal{"CutShortInALine", "solid\nfacet normal 0 0 1\nouter loop\nvertex 0 0",
                "line 4: the line ends where facet 0 needs another coordinate" + mend},
        Refusal{"Quadrangle",
                "solid\n" + replaced(facet(o, x, y), "  endloop", "vertex 1 1 0\nendloop") + "endsolid\n",
                "line 7: facet 0 has 'vertex' where 'endloop' belongs" + mend},
        Refusal{"Misspelt", "solid\nfecet normal 0 0 1\n",
                "line 2: 'fecet' stands where 'facet' or 'endsolid' belongs" + mend},
        Refusal{"CoordinateNoNumber", "solid\n" + facet(o, "1 zero 0", y) + "endsolid\n",
                "line 5: facet 0 has the coordinate 'zero', which is not a number" + mend},
        Refusal{"CoordinateTooLarge", "solid\n" + facet(o, "1 1e400 0", y) + "endsolid\n",
                "line 5: facet 0 has the coordinate '1e400', which is out of range" + mend},
        Refusal{"TextBehind", "solid\nendsolid\nhello\n",
                "line 3: 'hello' stands where 'solid' belongs" + mend}),
    test_name);

// Round trips

bool same(const Mesh& a, const Mesh& b) {
  return a.V.rows() == b.V.rows() && a.F.rows() == b.F.rows() && a.V == b.V && a.F == b.F;
}

Mesh random_mesh() {
  const auto points = *rc::gen::nonEmpty(
      rc::gen::container<std::vector<std::array<double, 3>>>(rc::gen::arbitrary<std::array<double, 3>>()));
  const int n = static_cast<int>(points.size());
  const auto triangles = *rc::gen::container<std::vector<std::array<int, 3>>>(
      rc::gen::container<std::array<int, 3>>(rc::gen::inRange(0, n)));
  Mesh mesh{Points(n, 3), Triangles(triangles.size(), 3)};
  for (int v = 0; v < n; ++v) mesh.V.row(v) << points[v][0], points[v][1], points[v][2];
  for (std::size_t f = 0; f < triangles.size(); ++f) {
    mesh.F.row(f) << triangles[f][0], triangles[f][1], triangles[f][2];
  }
  return mesh;
}

RC_GTEST_PROP(MeshIoProperty, PositionsAndFacesComeBackExactly, ()) {
  const Mesh mesh = random_mesh();
  for (const MeshFormat format : {MeshFormat::obj, MeshFormat::off, MeshFormat::ply}) {
    RC_ASSERT(same(to_triangle_mesh(parse_mesh(serialize_mesh(mesh, format), format)), mesh));
  }
}

RC_GTEST_PROP(MeshIoProperty, CornersComeBackFromStlInSinglePrecision, ()) {
  const Mesh mesh = random_mesh();
  const Mesh again = to_triangle_mesh(parse_mesh(serialize_mesh(mesh, MeshFormat::stl), MeshFormat::stl));
  Eigen::Index next = 0;
  for (Eigen::Index f = 0; f < mesh.F.rows(); ++f) {
    const auto before = [&](int k) { return Eigen::RowVector3f(mesh.V.row(mesh.F(f, k)).cast<float>()); };
    if (before(0) == before(1) || before(1) == before(2) || before(2) == before(0)) continue;  // is left out
    RC_ASSERT(next < again.F.rows());
    for (int k = 0; k < 3; ++k)
      RC_ASSERT(before(k) == Eigen::RowVector3f(again.V.row(again.F(next, k)).cast<float>()));
    ++next;
  }
  RC_ASSERT(next == again.F.rows());
}

RC_GTEST_PROP(MeshIoProperty, WhatIsCutShortIsRefusedWhereTheFormatCounts, ()) {
  const Mesh mesh = random_mesh();
  RC_PRE(mesh.F.rows() > 0);
  for (const MeshFormat format : {MeshFormat::off, MeshFormat::ply, MeshFormat::stl}) {
    const std::string bytes = serialize_mesh(mesh, format);
    // In a text, the last line break and all but the first digit of the last number may go unnoticed.
    const std::size_t unnoticed =
        format == MeshFormat::off ? std::to_string(mesh.F(mesh.F.rows() - 1, 2)).size() : 0;
    const auto size = *rc::gen::inRange<std::size_t>(0, bytes.size() - unnoticed);
    RC_ASSERT_THROWS_AS(parse_mesh(std::string_view(bytes).substr(0, size), format), MeshError);
  }
}

TEST(MeshIo, StlHasUnitNormalsThatPointOutward) {
  const std::string bytes = serialize_mesh(test::octahedron(), MeshFormat::stl);
  for (int f = 0; f < 8; ++f) {
    std::array<float, 6> normal_and_corner;
    std::memcpy(normal_and_corner.data(), bytes.data() + 84 + 50 * f, sizeof(normal_and_corner));
    const Eigen::Vector3f normal(normal_and_corner.data()), corner(normal_and_corner.data() + 3);
    EXPECT_NEAR(normal.norm(), 1, 1e-6);
    EXPECT_NEAR(normal.dot(corner), 1 / std::sqrt(3), 1e-6);
  }
}

TEST(MeshIo, StlNeedsTheVerticesThatFacesName) {
  Mesh mesh = test::tetrahedron();
  mesh.F(2, 1) = 4;
  try {
    serialize_mesh(mesh, MeshFormat::stl);
    FAIL() << "no MeshError";
  } catch (const MeshError& error) {
    EXPECT_STREQ(error.what(), "face 2 has the index 4, but the mesh has 4 vertices");
  }
}

TEST(PolygonMesh, TrianglesStayTheSameAsPolygons) {
  const Mesh mesh = test::octahedron();
  EXPECT_TRUE(same(to_triangle_mesh(to_polygon_mesh(mesh)), mesh));
}

TEST(PolygonMesh, TheFirstFaceThatIsNoTriangleIsNamed) {
  try {
    to_triangle_mesh(obj(obj_points + "f 1 2 3\nf 1 2 3 4\n"));
    FAIL() << "no MeshError";
  } catch (const MeshError& error) {
    EXPECT_STREQ(error.what(), "face 1 has 4 corners instead of three; triangulate the mesh");
  }
}

// Files

TEST(MeshFormat, IsNamedByTheEndingInAnyCase) {
  EXPECT_EQ(mesh_format("a.obj"), MeshFormat::obj);
  EXPECT_EQ(mesh_format("folder.ply/a.b.OFF"), MeshFormat::off);
  EXPECT_EQ(mesh_format("/a.Ply"), MeshFormat::ply);
  EXPECT_EQ(mesh_format("a.sTL"), MeshFormat::stl);
}

TEST(MeshFormat, EachHasAUsualEnding) {
  std::set<MeshFormat> formats;
  for (const std::string& ending : mesh_endings()) formats.insert(mesh_format("a" + ending));
  EXPECT_EQ(formats.size(), mesh_endings().size());
  EXPECT_TRUE(formats.contains(MeshFormat::obj) && formats.contains(MeshFormat::freesurfer));
}

TEST(MeshFormat, OtherEndingsAreRefused) {
  for (const std::string path : {"a.fbx", "a", "folder.obj/a", "a.obj.bz2", "a.gz", ""}) {
    try {
      mesh_format(path);
      FAIL() << "no ArgumentError for " << path;
    } catch (const ArgumentError& error) {
      EXPECT_THAT(error.what(), StartsWith(path + ": the ending names no known mesh format; use one of .obj, "
                                                  ".off, .ply, .stl, .gii, .vtk, .vtp, .gltf, .glb, .pial"));
    }
  }
}

TEST(MeshIo, MeshesComeBackFromFilesOfEveryFormat) {
  const Mesh mesh = test::icosahedron();
  for (const std::string ending : {".obj", ".off", ".ply", ".stl"}) {
    const std::string path =
        (fs::temp_directory_path() / ("orbitutte-mesh-" + std::to_string(::getpid()) + ending)).string();
    write_mesh(path, mesh);
    const Mesh again = to_triangle_mesh(read_mesh(path));
    fs::remove(path);
    EXPECT_EQ(again.F.rows(), mesh.F.rows());
    EXPECT_EQ(again.V.rows(), mesh.V.rows());
    EXPECT_TRUE(ending == ".stl" || same(again, mesh)) << ending;
  }
}

TEST(MeshIo, MessagesBeginWithThePath) {
  const std::string path =
      (fs::temp_directory_path() / ("orbitutte-text-" + std::to_string(::getpid()) + ".off")).string();
  write_file(path, "hello");
  try {
    read_mesh(path);
    ADD_FAILURE() << "no MeshError";
  } catch (const MeshError& error) {
    EXPECT_EQ(error.what(),
              path + ": line 1: the header has 'hello' where the number of vertices belongs" + mend);
  }
  fs::remove(path);
  try {
    read_mesh(path);
    ADD_FAILURE() << "no FileError";
  } catch (const FileError& error) {
    EXPECT_EQ(error.what(), path + ": cannot be read: No such file or directory");
  }
}

TEST(MeshIo, RealMeshesHaveTheVerticesAndFacesThatTheirListTells) {
  const fs::path folder = fs::path(ORBITUTTE_SHARED_DIR) / "meshes";
  std::ifstream list(folder / "cones.tsv");
  if (!list) GTEST_SKIP() << "no folder of real meshes beside the source folder";
  std::string line;
  std::getline(list, line);  // the heading
  int meshes = 0;
  while (std::getline(list, line)) {
    std::istringstream columns(line);
    std::string file;
    int vertices = 0, face_count = 0;
    columns >> file >> vertices >> face_count;
    const Mesh mesh = to_triangle_mesh(read_mesh((folder / file).string()));
    EXPECT_EQ(mesh.V.rows(), vertices) << file;
    EXPECT_EQ(mesh.F.rows(), face_count) << file;
    EXPECT_TRUE(mesh.V.allFinite()) << file;
    EXPECT_EQ(mesh.F.minCoeff(), 0) << file;
    EXPECT_LT(mesh.F.maxCoeff(), vertices) << file;
    ++meshes;
  }
  EXPECT_GT(meshes, 0);
}

}  // namespace
}  // namespace orbitutte::mesh_io_test
