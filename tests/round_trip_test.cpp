// SPDX-License-Identifier: MIT
// Every row of the tables of formats: what is written, read and written again is the same, byte by byte; and
// what was read has the same values, in the precision that the format keeps.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <string>
#include <vector>

#include "orbitutte/io/file.h"
#include "orbitutte/io/mesh_io.h"
#include "orbitutte/io/vertex_data.h"
#include "orbitutte/mesh/triangulation.h"
#include "orbitutte/samples/sample.h"
#include "orbitutte/types.h"
#include "test_meshes.h"

namespace orbitutte::round_trip_test {
namespace {

namespace fs = std::filesystem;

// Numbers that no text of few digits and no single precision holds, a zero with a sign, and the smallest.
Mesh awkward_mesh() {
  SampleOptions options;
  options.faces = 200;
  Mesh mesh = sample_mesh(options);
  mesh.V.array() *= 1e3 / 7;
  mesh.V(0, 0) = -0.0;
  mesh.V(1, 1) = 4.9e-324;
  mesh.V(2, 2) = 1e-30;
  return mesh;
}

// STL has no zero with a sign, numbers vertices in the order of their first use, and computes normals: what
// it keeps is known once a mesh was in one.
Mesh mesh_for(MeshFormat format) {
  const Mesh mesh = awkward_mesh();
  if (format != MeshFormat::stl) return mesh;
  return to_triangle_mesh(parse_mesh(serialize_mesh(mesh, format), format));
}

bool has_doubles(MeshFormat format) {
  const MeshFormat all[] = {MeshFormat::obj, MeshFormat::off, MeshFormat::ply, MeshFormat::vtk,
                            MeshFormat::vtp};
  return std::find(std::begin(all), std::end(all), format) != std::end(all);
}

class EveryMeshFormat : public testing::TestWithParam<NamedValue<MeshFormat>> {};

TEST_P(EveryMeshFormat, ComesBackByteByByte) {
  const MeshFormat format = GetParam().value;
  const Mesh mesh = mesh_for(format);
  const std::string once = serialize_mesh(mesh, format);
  const PolygonMesh again = parse_mesh(once, format);
  EXPECT_TRUE(serialize_mesh(again, format) == once);
  EXPECT_TRUE(again.warnings.empty());
  EXPECT_EQ(to_triangle_mesh(again).F, mesh.F);
  const Points expected = has_doubles(format) ? mesh.V : Points(mesh.V.cast<float>().cast<double>());
  ASSERT_EQ(again.V.rows(), expected.rows());
  EXPECT_TRUE(std::equal(expected.data(), expected.data() + expected.size(), again.V.data(),
                         [](double a, double b) { return a == b && std::signbit(a) == std::signbit(b); }));
}

// A folder that is removed with what is in it.
struct Folder {
  fs::path path = fs::temp_directory_path() / ("orbitutte-round-trip-" + std::to_string(::getpid()));
  Folder() { fs::create_directories(path); }
  ~Folder() { fs::remove_all(path); }
};

TEST_P(EveryMeshFormat, IsTheSameCompressed) {
  const Folder folder;
  const Mesh mesh = mesh_for(GetParam().value);
  for (const std::string& ending : mesh_endings()) {
    if (mesh_format("x" + ending) != GetParam().value) continue;
    const std::string plain = folder.path / ("x" + ending), packed = plain + ".gz",
                      again = folder.path / ("y" + ending + ".gz");
    write_mesh(plain, mesh);
    write_mesh(packed, mesh);
    EXPECT_LT(read_file(packed).size(), read_file(plain).size());
    EXPECT_EQ(read_file(packed).substr(0, 2), "\x1F\x8B");
    write_mesh(again, read_mesh(packed));
    EXPECT_TRUE(read_file(again) == read_file(packed));
    return;
  }
  FAIL() << "no ending names this format";
}

TEST_P(EveryMeshFormat, KeepsPolygonsByteByByteOrRefusesThem) {
  const MeshFormat format = GetParam().value;
  PolygonMesh mesh = test::cube();
  mesh.V.array() *= 1.0 / 3;
  std::string once;
  try {
    once = serialize_mesh(mesh, format);
  } catch (const MeshError&) {
    EXPECT_FALSE(has_doubles(format));
    return;
  }
  EXPECT_TRUE(has_doubles(format));
  const PolygonMesh again = parse_mesh(once, format);
  EXPECT_TRUE(serialize_mesh(again, format) == once);
  EXPECT_EQ(again.corners, mesh.corners);
  EXPECT_EQ(again.face_start, mesh.face_start);
  EXPECT_EQ(again.V, mesh.V);
}

INSTANTIATE_TEST_SUITE_P(Rows, EveryMeshFormat, testing::ValuesIn(NameTable<MeshFormat>::rows),
                         [](const auto& row) { return std::string(row.param.name); });

// ---- Values at vertices ----

// What each format can hold.
struct ValueRow {
  VertexDataFormat format;
  std::string ending;
  int maps;
  bool names, labels, doubles;
};

void PrintTo(const ValueRow& row, std::ostream* out) { *out << row.ending; }

// All of them, in the order of the enum.
const ValueRow value_rows[] = {{VertexDataFormat::curv, ".curv", 1, false, false, false},
                               {VertexDataFormat::annot, ".annot", 1, false, true, false},
                               {VertexDataFormat::shape_gifti, ".shape.gii", 3, true, false, false},
                               {VertexDataFormat::func_gifti, ".func.gii", 2, true, false, false},
                               {VertexDataFormat::label_gifti, ".label.gii", 2, true, true, false},
                               {VertexDataFormat::text, ".txt", 3, false, false, true},
                               {VertexDataFormat::csv, ".csv", 3, true, false, true},
                               {VertexDataFormat::npy, ".npy", 3, false, false, true}};
static_assert(static_cast<std::size_t>(VertexDataFormat::npy) + 1 == std::size(value_rows),
              "a row for each format");

VertexData awkward_values(const ValueRow& row) {
  constexpr int count = 50;
  VertexData data;
  data.values.resize(count, row.maps);
  for (int v = 0; v < count; ++v)
    for (int map = 0; map < row.maps; ++map)
      data.values(v, map) =
          row.labels ? (v + map) % 3 : std::sin(1.7 * v + map) * std::pow(10.0, v % 21 - 10);
  if (!row.labels) data.values(0, 0) = -0.0, data.values(1, 0) = std::numeric_limits<double>::infinity();
  if (row.labels)
    data.labels = {{0, "none", {0, 0, 0, 0}}, {1, "gyrus", {1, 0, 0, 1}}, {2, "sulcus <&>", {0, 0, 1, 1}}};
  for (int map = 0; map < row.maps && row.names; ++map)
    data.names.push_back("map \"" + std::to_string(map) + "\"");
  return data;
}

class EveryValueFormat : public testing::TestWithParam<ValueRow> {};

TEST_P(EveryValueFormat, ComesBackByteByByte) {
  const ValueRow& row = GetParam();
  const VertexData data = awkward_values(row);
  const std::string once = serialize_vertex_data(data, row.format);
  const VertexData again = parse_vertex_data(once, row.format);
  EXPECT_TRUE(serialize_vertex_data(again, row.format) == once);
  EXPECT_EQ(again.names, data.names);
  EXPECT_EQ(again.labels.size(), data.labels.size());
  const Eigen::MatrixXd expected =
      row.doubles ? data.values : Eigen::MatrixXd(data.values.cast<float>().cast<double>());
  EXPECT_EQ(again.values, expected);
}

TEST_P(EveryValueFormat, IsTheSameCompressed) {
  const Folder folder;
  const ValueRow& row = GetParam();
  const VertexData data = awkward_values(row);
  const std::string plain = folder.path / ("x" + row.ending), packed = plain + ".gz",
                    again = folder.path / ("y" + row.ending + ".gz");
  EXPECT_EQ(vertex_data_format(plain), row.format);
  write_vertex_data(plain, data);
  write_vertex_data(packed, data);
  EXPECT_EQ(read_file(packed).substr(0, 2), "\x1F\x8B");
  EXPECT_TRUE(serialize_vertex_data(read_vertex_data(packed), row.format) == read_file(plain));
  write_vertex_data(again, read_vertex_data(packed));
  EXPECT_TRUE(read_file(again) == read_file(packed));
}

INSTANTIATE_TEST_SUITE_P(Rows, EveryValueFormat, testing::ValuesIn(value_rows));

// Labels in, labels out; numbers that only happen to be whole stay numbers.
TEST(Npy, KeepsWholeNumbers) {
  VertexData data;
  data.values.resize(3, 1);
  data.values << 4, -1, 3e9;
  const auto written = [&] { return serialize_vertex_data(data, VertexDataFormat::npy); };
  EXPECT_NE(written().find("<f8"), std::string::npos);
  data.is_whole = true;
  EXPECT_NE(written().find("<i8"), std::string::npos);
  EXPECT_EQ(parse_vertex_data(written(), VertexDataFormat::npy).values, data.values);
  EXPECT_TRUE(parse_vertex_data(written(), VertexDataFormat::npy).is_whole);
  data.values(2) = 7;
  EXPECT_NE(written().find("<i4"), std::string::npos);
  EXPECT_EQ(parse_vertex_data(written(), VertexDataFormat::npy).values, data.values);
  data.values(2) = std::numeric_limits<double>::quiet_NaN();
  EXPECT_NE(written().find("<f8"), std::string::npos);
  data.values(2) = 0.5;
  EXPECT_EQ(parse_vertex_data(written(), VertexDataFormat::npy).values, data.values);
}

}  // namespace
}  // namespace orbitutte::round_trip_test
