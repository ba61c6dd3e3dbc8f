// SPDX-License-Identifier: MIT
// The colours of vertices in mesh files.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <bit>
#include <cstdint>
#include <string>
#include <vector>

#include "orbitutte/io/bytes.h"
#include "orbitutte/io/mesh_io.h"

namespace orbitutte::mesh_colours_test {
namespace {

/// Vertices with colours as a file has them, and two faces.
struct ColouredMesh {
  Points V;
  std::vector<double> channels;  ///< 3 n: bytes or numbers of 0 .. 1
  bool has_bytes = false;

  Eigen::Index count() const { return V.rows(); }
  Points colours() const {
    const Eigen::Map<const Points> given(channels.data(), count(), 3);
    return has_bytes ? Points(given / 255) : Points(given);
  }
};

ColouredMesh random_coloured_mesh() {
  ColouredMesh mesh;
  const int n = *rc::gen::inRange(3, 20);
  mesh.has_bytes = *rc::gen::arbitrary<bool>();
  mesh.V.resize(n, 3);
  for (double& x : mesh.V.reshaped()) x = *rc::gen::inRange(-1000, 1000) / 64.0;
  for (int i = 0; i < 3 * n; ++i)
    mesh.channels.push_back(mesh.has_bytes ? *rc::gen::inRange(0, 256) : *rc::gen::inRange(0, 4097) / 4096.0);
  if (mesh.has_bytes) mesh.channels[*rc::gen::inRange(0, 3 * n)] = 2;  // or all might be 0 and 1
  return mesh;
}

const std::vector<int> two_faces = {0, 1, 2, 2, 1, 0};

void require_same(const PolygonMesh& read, const ColouredMesh& mesh) {
  RC_ASSERT(read.V == mesh.V);
  RC_ASSERT(read.corners == two_faces);
  RC_ASSERT(read.colours == mesh.colours());
}

std::string words(const ColouredMesh& mesh, Eigen::Index v) {
  return fmt::format("{} {} {}", mesh.channels[3 * v], mesh.channels[3 * v + 1], mesh.channels[3 * v + 2]);
}

std::string place(const ColouredMesh& mesh, Eigen::Index v) {
  return fmt::format("{} {} {}", mesh.V(v, 0), mesh.V(v, 1), mesh.V(v, 2));
}

RC_GTEST_PROP(MeshColours, ComeBackFromObj, ()) {
  const ColouredMesh mesh = random_coloured_mesh();
  std::string text;
  for (Eigen::Index v = 0; v < mesh.count(); ++v) text += "v " + place(mesh, v) + " " + words(mesh, v) + "\n";
  require_same(parse_mesh(text + "f 1 2 3\nf 3 2 1\n", MeshFormat::obj), mesh);
}

RC_GTEST_PROP(MeshColours, ComeBackFromOff, ()) {
  const ColouredMesh mesh = random_coloured_mesh();
  const auto any = [] { return *rc::gen::arbitrary<bool>(); };
  const bool has_texture = any(), has_normals = any(), has_alpha = any();
  std::string text =
      fmt::format("{}C{}OFF\n{} 2 0\n", has_texture ? "ST" : "", has_normals ? "N" : "", mesh.count());
  for (Eigen::Index v = 0; v < mesh.count(); ++v)
    text += place(mesh, v) + (has_normals ? " 0.25 -1 7 " : " ") + words(mesh, v) + (has_alpha ? " 1" : "") +
            (has_texture ? " 0.5 0.75\n" : "\n");
  require_same(parse_mesh(text + "3 0 1 2\n3 2 1 0\n", MeshFormat::off), mesh);
}

/// A PLY file of which every part may be told in several ways.
class PlyWriter {
 public:
  PlyWriter()
      : is_ascii_(any()),
        is_big_(any()),
        has_doubles_(any()),
        has_alpha_(any()),
        is_coloured_first_(any()),
        has_face_flags_(any()) {}

  std::string bytes(const ColouredMesh& mesh) {
    text_ = "ply\nformat " +
            std::string(is_ascii_ ? "ascii"
                        : is_big_ ? "binary_big_endian"
                                  : "binary_little_endian") +
            " 1.0\nelement vertex " + std::to_string(mesh.count()) + "\n";
    const std::string place = "property double x\nproperty double y\nproperty double z\n";
    text_ += is_coloured_first_ ? colour_header(mesh) + place : place + colour_header(mesh);
    text_ += "element face 2\nproperty list uchar int vertex_indices\n";
    text_ += std::string(has_face_flags_ ? "property uchar flag\n" : "") + "end_header\n";
    for (Eigen::Index v = 0; v < mesh.count(); ++v) {
      if (is_coloured_first_) append_colour(mesh, v);
      for (int k = 0; k < 3; ++k) append(mesh.V(v, k));
      if (!is_coloured_first_) append_colour(mesh, v);
      if (is_ascii_) text_ += '\n';
    }
    for (std::size_t c = 0; c < two_faces.size(); ++c) {
      if (c % 3 == 0) append(std::uint8_t{3});
      append(two_faces[c]);
      if (c % 3 == 2 && has_face_flags_) append(std::uint8_t{1});
      if (c % 3 == 2 && is_ascii_) text_ += '\n';
    }
    return text_;
  }

 private:
  static bool any() { return *rc::gen::arbitrary<bool>(); }

  std::string colour_header(const ColouredMesh& mesh) const {
    const std::string type = mesh.has_bytes ? "uchar" : has_doubles_ ? "double" : "float";
    std::string header;
    for (const std::string channel : {"red", "green", "blue", "alpha"})
      if (channel != "alpha" || has_alpha_) header += "property " + type + " " + channel + "\n";
    return header;
  }

  void append_colour(const ColouredMesh& mesh, Eigen::Index v) {
    for (int k = 0; k < (has_alpha_ ? 4 : 3); ++k) {
      const double value = k == 3 ? 1 : mesh.channels[3 * v + k];
      if (mesh.has_bytes)
        append(static_cast<std::uint8_t>(value));
      else if (has_doubles_)
        append(value);
      else
        append(static_cast<float>(value));
    }
  }

  template <typename Number>
  void append(Number number) {
    if (is_ascii_) {
      text_ += fmt::format("{} ", static_cast<double>(number));
      return;
    }
    const auto bytes = little_endian_bytes(number);
    is_big_ ? text_.append(bytes.rbegin(), bytes.rend()) : text_.append(bytes.begin(), bytes.end());
  }

  bool is_ascii_, is_big_, has_doubles_, has_alpha_, is_coloured_first_, has_face_flags_;
  std::string text_;
};

RC_GTEST_PROP(MeshColours, ComeBackFromPlyOfEveryLayout, ()) {
  const ColouredMesh mesh = random_coloured_mesh();
  require_same(parse_mesh(PlyWriter().bytes(mesh), MeshFormat::ply), mesh);
}

TEST(MeshColours, AreNoneWhereAVertexHasNone) {
  for (const auto& [text, format] :
       {std::pair("v 0 0 0 1 0 0\nv 1 0 0\nv 0 1 0 0 0 1\n", MeshFormat::obj),
        std::pair("COFF 3 0 0\n0 0 0 1 0 0\n1 0 0\n0 1 0 0 0 1\n", MeshFormat::off),
        std::pair("OFF 1 0 0\n0 0 0 1 0 0\n", MeshFormat::off), std::pair("v 0 0 0 1\n", MeshFormat::obj),
        std::pair("v 0 0 0 1 0.5 0.25 0.125\n", MeshFormat::obj),
        std::pair(
            "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\nproperty float "
            "z\nproperty uchar alpha\nend_header\n0 0 0 9\n",
            MeshFormat::ply)}) {
    const PolygonMesh mesh = parse_mesh(text, format);
    EXPECT_EQ(mesh.colours.rows(), 0) << text;
    EXPECT_EQ(mesh.colours.cols(), 3) << text;
    EXPECT_GT(mesh.V.rows(), 0) << text;
  }
}

TEST(MeshColours, WholeNumbersUpToOneAreNoBytesInTexts) {
  const PolygonMesh mesh = parse_mesh("v 0 0 0 1 0 1\nv 1 0 0 0 1 0\n", MeshFormat::obj);
  EXPECT_EQ(mesh.colours.row(0), Eigen::RowVector3d(1, 0, 1));
}

struct ColourWarning {
  std::string bytes;
  MeshFormat format;
  std::string sentence;
};

std::string ply_of(const std::string& properties, const std::string& data) {
  return "ply\nformat ascii 1.0\nelement vertex 2\nproperty float x\nproperty float y\nproperty float z\n" +
         properties + "end_header\n" + data;
}

std::string channels_of(const std::string& type) {
  return "property " + type + " red\nproperty " + type + " green\nproperty " + type + " blue\n";
}

// Floats, as the reader of binary triangles takes them.
std::string binary_ply_of(const std::vector<float>& numbers) {
  std::string bytes =
      "ply\nformat binary_little_endian 1.0\nelement vertex 2\nproperty float x\nproperty float y\n"
      "property float z\n" +
      channels_of("float") + "element face 0\nproperty list uchar int vertex_indices\nend_header\n";
  for (const float number : numbers) append_little_endian(bytes, number);
  return bytes;
}

TEST(MeshColours, MalformedOnesArePassedOverNamingLineOrVertex) {
  const std::string range = ", which is not within 0 .. 255";
  const ColourWarning warnings[] = {
      {"v 0 0 0 1 0 0\nv 0 0 0 1 0\n", MeshFormat::obj, "line 2: vertex 1 lacks a colour channel"},
      {"v 0 0 0 1 red 0\n", MeshFormat::obj,
       "line 1: vertex 0 has the colour channel 'red', which is not a number"},
      {"v 0 0 0 1 0 -0.5\n", MeshFormat::obj, "vertex 0 has the colour channel -0.5" + range},
      {"v 0 0 0 1 nan 0\n", MeshFormat::obj, "vertex 0 has the colour channel nan" + range},
      {"v 0 0 0 1 0 256\n", MeshFormat::obj, "vertex 0 has the colour channel 256" + range},
      {"COFF 1 0 0\n0 0 0 0.5\n", MeshFormat::off, "line 2: vertex 0 lacks a colour channel"},
      {"COFF 1 0 0\n0 0 0 x 0 0 1\n", MeshFormat::off,
       "line 2: vertex 0 has the colour channel 'x', which is not a number"},
      {ply_of(channels_of("int"), "0 0 0 1 0 0\n0 0 0 1 1 -1\n"), MeshFormat::ply,
       "vertex 1 has the colour channel -1" + range},
      {ply_of(channels_of("float"), "0 0 0 1 0 0\n0 0 0 1 inf 0\n"), MeshFormat::ply,
       "vertex 1 has the colour channel inf" + range},
      {ply_of("property uchar red\nproperty uchar blue\n", "0 0 0 1 0\n0 0 0 1 1\n"), MeshFormat::ply,
       "the element 'vertex' has colours without a number 'green'"},
      {ply_of("property uchar red\nproperty uchar green\nproperty list uchar uchar blue\n",
              "0 0 0 1 0 1 7\n0 0 0 1 1 0\n"),
       MeshFormat::ply, "the element 'vertex' has colours without a number 'blue'"},
      {binary_ply_of({0, 0, 0, 1, 1, 1, 0, 0, 0, 0, 0, -7}), MeshFormat::ply,
       "vertex 1 has the colour channel -7" + range},
  };
  for (const auto& [bytes, format, sentence] : warnings) {
    const PolygonMesh mesh = parse_mesh(bytes, format);
    EXPECT_GT(mesh.vertex_count(), 0) << sentence;
    EXPECT_EQ(mesh.colours.rows(), 0) << sentence;
    EXPECT_THAT(mesh.warnings, testing::ElementsAre(sentence + ": the colours of the vertices are ignored"));
  }
}

TEST(MeshColours, AboveOneByRoundingAreOneWithAWarning) {
  for (const PolygonMesh& mesh :
       {parse_mesh("v 0 0 0 0.5 0 0\nv 0 0 0 0.25 1.0000001 0\n", MeshFormat::obj),
        parse_mesh(ply_of(channels_of("double"), "0 0 0 0.5 0 0\n0 0 0 0.25 1.0000001 0\n"),
                   MeshFormat::ply)}) {
    EXPECT_EQ(mesh.colours, (Points(2, 3) << 0.5, 0, 0, 0.25, 1, 0).finished());
    EXPECT_THAT(mesh.warnings,
                testing::ElementsAre(testing::HasSubstr("vertex 1 has the colour channel 1.0")));
  }
}

TEST(MeshColours, NumbersUpTo255NeedNotBeWholeButThenAWarningSaysHowTheyAreTaken) {
  for (const PolygonMesh& mesh :
       {parse_mesh("v 0 0 0 255 0 0\nv 0 0 0 0 51.5 0\n", MeshFormat::obj),
        parse_mesh("COFF 2 0 0\n0 0 0 255 0 0\n0 0 0 0 51.5 0\n", MeshFormat::off),
        parse_mesh(binary_ply_of({0, 0, 0, 255, 0, 0, 0, 0, 0, 0, 51.5, 0}), MeshFormat::ply)}) {
    EXPECT_EQ(mesh.colours, Points((Points(2, 3) << 255, 0, 0, 0, 51.5, 0).finished() / 255));
    EXPECT_THAT(mesh.warnings, testing::ElementsAre(testing::HasSubstr("taken for numbers of 0 .. 255")));
  }
  const PolygonMesh whole =
      parse_mesh(ply_of(channels_of("float"), "0 0 0 1 0 0\n0 0 0 255 0 0\n"), MeshFormat::ply);
  EXPECT_EQ(whole.colours(1, 0), 1);
  EXPECT_THAT(whole.warnings, testing::IsEmpty());
}

}  // namespace
}  // namespace orbitutte::mesh_colours_test
