// SPDX-License-Identifier: MIT
#include "orbitutte/export/tiling.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <limits>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>
#include <tuple>

#include "hand_made.h"
#include "orbitutte/export/closed_mesh.h"
#include "orbitutte/export/palette.h"
#include "orbitutte/export/tiling_files.h"
#include "orbitutte/inspect/inspection.h"
#include "orbitutte/io/file.h"
#include "orbitutte/io/mesh_io.h"
#include "orbitutte/io/ply.h"
#include "orbitutte/mesh/triangulation.h"
#include "polygon_meshes.h"
#include "sample_embeddings.h"

namespace orbitutte::tiling_test {
namespace {

using hand_made::antipodal_hemisphere;
using hand_made::mirror_bounded_cone;
using hand_made::mirror_triangle;
using hand_made::rotation_lune;
using hand_made::rotation_quadrilateral;

struct Corners {
  Vector3 a, b, c;
};

Corners corners(const Mesh& mesh, Eigen::Index f) {
  return {mesh.V.row(mesh.F(f, 0)), mesh.V.row(mesh.F(f, 1)), mesh.V.row(mesh.F(f, 2))};
}

/// The area of a spherical triangle, with sign: tan(area/2) = [a b c] / (1 + ab + bc + ca).
double signed_area(const Corners& t) {
  return 2 * std::atan2(t.a.dot(t.b.cross(t.c)), 1 + t.a.dot(t.b) + t.b.dot(t.c) + t.c.dot(t.a));
}

/// How often each directed edge is used.
std::map<std::pair<int, int>, int> directed_edges(const Triangles& F) {
  std::map<std::pair<int, int>, int> count;
  for (Eigen::Index f = 0; f < F.rows(); ++f)
    for (int k = 0; k < 3; ++k) ++count[{F(f, k), F(f, (k + 1) % 3)}];
  return count;
}

void expect_closed_sphere(const Mesh& mesh) {
  const auto edges = directed_edges(mesh.F);
  for (const auto& [edge, count] : edges) {
    ASSERT_EQ(count, 1);
    ASSERT_TRUE(edges.contains({edge.second, edge.first}));
  }
  EXPECT_EQ(mesh.V.rows() - static_cast<Eigen::Index>(edges.size()) / 2 + mesh.F.rows(), 2);
  const std::set<int> used(mesh.F.data(), mesh.F.data() + mesh.F.size());
  EXPECT_EQ(static_cast<Eigen::Index>(used.size()), mesh.V.rows());
}

void expect_covers_sphere_once(const Mesh& mesh) {
  double area = 0;
  for (Eigen::Index f = 0; f < mesh.F.rows(); ++f) {
    const Corners t = corners(mesh, f);
    ASSERT_GT(t.a.dot(t.b.cross(t.c)), 0) << "face " << f;
    area += signed_area(t);
  }
  EXPECT_NEAR(area, 4 * std::numbers::pi, 1e-9);
  for (Eigen::Index v = 0; v < mesh.V.rows(); ++v) ASSERT_NEAR(mesh.V.row(v).norm(), 1, 1e-15);
}

/// Every face is the copy of its source face that its tile says.
void expect_copies_of_source(const Tiling& tiling, const Embedding& embedding) {
  for (Eigen::Index f = 0; f < tiling.mesh.F.rows(); ++f) {
    const TileCopy& copy = tiling.copies[tiling.copy[f]];
    ASSERT_EQ(copy.mirrored, copy.transform.matrix().determinant() < 0);
    std::multiset<int> sources, expected;
    Vector3 sum = Vector3::Zero();
    for (int k = 0; k < 3; ++k) {
      const int v = embedding.triangles(tiling.source_face[f], k);
      expected.insert(embedding.source_vertex[v]);
      sources.insert(tiling.source_vertex[tiling.mesh.F(f, k)]);
      sum += copy.transform * Vector3(embedding.positions.row(v));
      sum -= tiling.mesh.V.row(tiling.mesh.F(f, k)).transpose();
    }
    ASSERT_LE(sum.norm(), 1e-12);
    ASSERT_EQ(sources, expected);
  }
}

void expect_neighbours_coloured_differently(const Tiling& tiling) {
  std::map<std::pair<int, int>, int> tile_at;
  const Triangles& F = tiling.mesh.F;
  for (Eigen::Index f = 0; f < F.rows(); ++f)
    for (int k = 0; k < 3; ++k) tile_at[{F(f, k), F(f, (k + 1) % 3)}] = tiling.copy[f];
  for (const auto& [edge, tile] : tile_at) {
    const int other = tile_at.at({edge.second, edge.first});
    if (other != tile) {
      ASSERT_NE(tiling.copies[tile].colour, tiling.copies[other].colour);
    }
  }
  for (const TileCopy& copy : tiling.copies) ASSERT_LT(copy.colour, palette_size);
}

/// Seams of cut meshes name one source vertex on both banks; the hand-made ones get theirs here.
Embedding with_sources(Embedding embedding) {
  for (bool changed = true; changed;) {
    changed = false;
    for (const Seam& seam : embedding.seams) {
      for (std::size_t i = 0; i < seam.left.size(); ++i) {
        int& left = embedding.source_vertex[seam.left[i]];
        int& right = embedding.source_vertex[seam.right[i]];
        changed = changed || left != right;
        left = right = std::min(left, right);
      }
    }
  }
  return embedding;
}

void expect_tiles_sphere(const Embedding& hand_made, int group_order) {
  const Embedding embedding = with_sources(hand_made);
  const Tiling tiling = weld_copies(embedding);
  EXPECT_EQ(tiling.copy_count(), group_order);
  EXPECT_EQ(static_cast<int>(tiling.copies.size()), tiling.copy_count());
  EXPECT_EQ(tiling.mesh.F.rows(), embedding.triangles.rows() * tiling.copy_count());
  expect_closed_sphere(tiling.mesh);
  expect_covers_sphere_once(tiling.mesh);
  expect_copies_of_source(tiling, embedding);
  expect_neighbours_coloured_differently(tiling);
}

TEST(Tiling, OctantsWithThreeMirrors) {
  for (const int n : {1, 2, 7}) expect_tiles_sphere(mirror_triangle(2, 2, 2, n), 8);
}

TEST(Tiling, PolyhedralReflections) {
  expect_tiles_sphere(mirror_triangle(5, 3, 2, 3), 120);
  expect_tiles_sphere(mirror_triangle(4, 3, 2, 1), 48);
  expect_tiles_sphere(mirror_triangle(3, 2, 3, 4), 24);
  expect_tiles_sphere(mirror_triangle(2, 2, 9, 4), 36);
}

TEST(Tiling, PolyhedralRotations) {
  expect_tiles_sphere(rotation_quadrilateral(2, 2, 2, 3), 4);
  expect_tiles_sphere(rotation_quadrilateral(3, 2, 3, 1), 12);
  expect_tiles_sphere(rotation_quadrilateral(3, 3, 2, 4), 12);
  expect_tiles_sphere(rotation_quadrilateral(5, 2, 3, 2), 60);
  expect_tiles_sphere(rotation_quadrilateral(2, 2, 30, 4), 60);
}

TEST(Tiling, LunesWithOneRotation) {
  expect_tiles_sphere(rotation_lune(2, 2, 3), 2);
  expect_tiles_sphere(rotation_lune(3, 1, 2), 3);
  expect_tiles_sphere(rotation_lune(17, 1, 1), 17);
  expect_tiles_sphere(rotation_lune(100, 2, 3), 100);
}

TEST(Tiling, SectorsWithRotationAndMirror) {
  expect_tiles_sphere(mirror_bounded_cone(2, 2, 2), 2 * 2);
  expect_tiles_sphere(mirror_bounded_cone(3, 1, 4), 2 * 3);
  expect_tiles_sphere(mirror_bounded_cone(40, 1, 3), 2 * 40);
}

TEST(Tiling, HemisphereWithTheAntipodalMap) { expect_tiles_sphere(antipodal_hemisphere(3), 2); }

TEST(Tiling, EmbeddingsWithRotationAndMirror) {
  for (const char* signature : {"3*2", "2*2", "2*3", "2*5", "2*12", "2*", "3*", "5*", "12*"}) {
    SCOPED_TRACE(signature);
    const Embedding& embedding = test::sample_embedding(signature).embedding();
    const Tiling tiling = weld_copies(embedding);
    EXPECT_EQ(tiling.copy_count(), embedding.target.group_order);
    expect_closed_sphere(tiling.mesh);
    expect_covers_sphere_once(tiling.mesh);
    expect_copies_of_source(tiling, embedding);
    expect_neighbours_coloured_differently(tiling);
  }
}

TEST(Tiling, BanksAreWeldedWhereverThePositionsAre) {
  Embedding embedding = rotation_lune(5, 1, 4);
  embedding.positions.row(embedding.seams[0].left[2]) += Eigen::RowVector3d(0, 0, 0.01);
  expect_closed_sphere(weld_copies(embedding).mesh);
}

TEST(Tiling, ReflectionsAlternateTwoColours) {
  for (const TileCopy& copy : weld_copies(mirror_triangle(5, 3, 2, 1)).copies)
    EXPECT_EQ(copy.colour, copy.mirrored ? 1 : 0);
}

TEST(Tiling, CopiesAreTheSameWithoutTheMesh) {
  const Embedding embedding = mirror_triangle(2, 2, 2, 3);
  const std::vector<TileCopy> copies = tile_copies(embedding), expected = weld_copies(embedding).copies;
  ASSERT_EQ(copies.size(), expected.size());
  for (std::size_t g = 0; g < copies.size(); ++g) {
    EXPECT_EQ(copies[g].transform.matrix(), expected[g].transform.matrix());
    EXPECT_EQ(copies[g].colour, expected[g].colour);
  }
}

TEST(Tiling, LeavesOutVerticesWithoutFaces) {
  Embedding embedding = mirror_triangle(2, 2, 2, 3);
  const Tiling expected = weld_copies(embedding);
  const Eigen::Index n = embedding.positions.rows();
  embedding.positions.conservativeResize(n + 2, 3);
  embedding.positions.bottomRows(2).rowwise() = Eigen::RowVector3d(0, 0, 1);
  embedding.source_vertex.insert(embedding.source_vertex.end(),
                                 {static_cast<int>(n), static_cast<int>(n + 1)});
  const Tiling tiling = weld_copies(embedding);
  EXPECT_EQ(tiling.mesh.V, expected.mesh.V);
  EXPECT_EQ(tiling.mesh.F, expected.mesh.F);
  EXPECT_EQ(tiling.source_vertex, expected.source_vertex);
}

// --- one closed mesh

std::string fault_of(const Mesh& mesh) {
  try {
    require_closed_sphere(mesh);
  } catch (const MeshError& error) {
    return error.what();
  }
  return {};
}

/// The grid of two by two squares, each halved from one corner: vertices 2 and 6 are tips of ears.
Mesh grid_with_ears() {
  Mesh mesh;
  mesh.V.resize(9, 3);
  for (int v = 0; v < 9; ++v) mesh.V.row(v) << v % 3, v / 3, 0;
  mesh.F.resize(8, 3);
  mesh.F << 0, 1, 4, 0, 4, 3, 1, 2, 5, 1, 5, 4, 3, 4, 7, 3, 7, 6, 4, 5, 8, 4, 8, 7;
  return mesh;
}

TEST(ClosedMesh, EveryPlantedFaultIsFound) {
  const Mesh sound = test::icosphere(1);
  EXPECT_EQ(fault_of(sound), "");
  Mesh mesh = sound;
  mesh.F.row(3) = mesh.F.row(4);
  EXPECT_THAT(fault_of(mesh), testing::HasSubstr("faces 3 and 4 have the same vertices"));
  mesh = sound;
  mesh.F.row(3).reverseInPlace();
  EXPECT_THAT(fault_of(mesh), testing::HasSubstr("in the same direction"));
  mesh = sound;
  mesh.F.conservativeResize(mesh.F.rows() - 1, 3);
  EXPECT_THAT(fault_of(mesh), testing::HasSubstr("the surface is a disk"));
  mesh = test::with_vertices_merged(sound, 0, 1);
  EXPECT_NE(fault_of(mesh), "");
  EXPECT_NE(fault_of(test::united(sound, sound)), "");
  EXPECT_NE(fault_of(test::torus(5, 5)), "");
  mesh = sound;
  mesh.V.conservativeResize(mesh.V.rows() + 1, 3);
  mesh.V.bottomRows(1).setOnes();
  EXPECT_THAT(fault_of(mesh), testing::HasSubstr("a vertex is in no face"));
}

TEST(ClosedMesh, OfPolygonsEveryPlantedFaultIsFound) {
  const PolygonMesh cube = test::cube();
  Polygons polygons = {cube.corners, cube.face_start};
  EXPECT_NO_THROW(require_closed_sphere(cube.V, polygons));
  std::swap(polygons.corners[0], polygons.corners[2]);
  EXPECT_THROW(require_closed_sphere(cube.V, polygons), MeshError);
  polygons.corners.resize(20);
  polygons.start.pop_back();
  EXPECT_THROW(require_closed_sphere(cube.V, polygons), MeshError);
}

TEST(Tiling, EarsThatCoincideWithTheirMirrorImagesAreLeftOut) {
  const Mesh mesh = grid_with_ears();
  const EmbedResult result = embed(mesh, parse_orbifold("*432"), {0, 8, 4 - 1});
  const Tiling tiling = weld_copies(result.embedding);
  EXPECT_EQ(tiling.left_out.size() + tiling.input_faces.size(), 8u);
  EXPECT_FALSE(tiling.left_out.empty());
  expect_closed_sphere(tiling.mesh);
  expect_covers_sphere_once(tiling.mesh);
  expect_copies_of_source(tiling, result.embedding);
  const PlyFile file = parse_ply(ply_bytes(tiling));
  const std::vector<double>& source = file.find("face")->find("source_face")->values;
  EXPECT_EQ(std::vector<int>(source.begin(), source.end()), tiling.source_face);
}

TEST(Tiling, AnEdgeThatCoincidesWithItsMirrorImageIsNamed) {
  Embedding embedding = with_sources(mirror_triangle(2, 2, 2, 4));
  const std::vector<int> side = embedding.seams[0].left;
  const Eigen::Index n = embedding.positions.rows(), m = embedding.triangles.rows();
  // Three faces over two edges of the mirror, around a vertex that lies on none.
  embedding.triangles.conservativeResize(m + 3, 3);
  embedding.positions.conservativeResize(n + 1, 3);
  embedding.positions.row(n) = embedding.positions.row(side[1]);
  embedding.source_vertex.push_back(static_cast<int>(n));
  for (int k = 0; k < 3; ++k)
    embedding.triangles.row(m + k) << side[k], side[(k + 1) % 3], static_cast<int>(n);
  try {
    weld_copies(embedding);
    ADD_FAILURE() << "no MeshError";
  } catch (const MeshError& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr("of the input joins two vertices of one mirror"));
  }
}

TEST(Tiling, PolygonsAreDividedSoThatNoDiagonalLiesOnAMirror) {
  PolygonMesh quads;
  quads.V = grid_with_ears().V;
  quads.corners = {0, 1, 4, 3, 1, 2, 5, 4, 3, 4, 7, 6, 4, 5, 8, 7};
  quads.face_start = {0, 4, 8, 12, 16};
  for (const std::vector<int>& marks : {std::vector{0, 8, 3}, {1, 3, 5}, {0, 2, 8}, {1, 8, 6}}) {
    const EmbedResult result = embed(quads, parse_orbifold("*432"), marks);
    Embedding embedding = result.embedding;
    embedding.triangles = triangles_on_vertices(fan_triangles(embedding.polygons),
                                                embedding.polygons.corners);  // as from a file
    for (const Embedding& each : {embedding, result.embedding}) {
      const Tiling tiling = weld_copies(each);
      EXPECT_TRUE(tiling.left_out.empty());
      expect_closed_sphere(tiling.mesh);
      expect_covers_sphere_once(tiling.mesh);
    }
  }
}

TEST(Tiling, RefusesAnotherGroupOrder) {
  Embedding embedding = mirror_triangle(2, 2, 2, 2);
  for (const int wrong : {-1, 0, 1, 4, 7, 9, 16}) {
    embedding.target.group_order = wrong;
    EXPECT_THROW(weld_copies(embedding), ArgumentError) << wrong;
  }
}

TEST(Tiling, RefusesWhatDoesNotCloseUp) {
  Embedding without_seams = mirror_triangle(2, 2, 2, 2);
  without_seams.seams.clear();
  EXPECT_THROW(weld_copies(without_seams), ArgumentError);

  Embedding missing_pair = rotation_lune(4, 1, 3);
  missing_pair.seams[0].left.erase(missing_pair.seams[0].left.begin() + 1);
  missing_pair.seams[0].right.erase(missing_pair.seams[0].right.begin() + 1);
  EXPECT_THROW(weld_copies(missing_pair), ArgumentError);
}

TEST(Tiling, RefusesWhatIsNoEmbedding) {
  const Embedding good = rotation_lune(4, 1, 3);
  Embedding bad = good;
  bad.triangles(0, 0) = static_cast<int>(bad.positions.rows());
  EXPECT_THROW(weld_copies(bad), ArgumentError);
  bad = good;
  bad.seams[0].left[1] = -1;
  EXPECT_THROW(weld_copies(bad), ArgumentError);
  bad = good;
  bad.seams[0].left.pop_back();
  EXPECT_THROW(weld_copies(bad), ArgumentError);
  bad = good;
  bad.source_vertex.pop_back();
  EXPECT_THROW(weld_copies(bad), ArgumentError);
  bad = good;
  bad.positions(2, 1) = std::numeric_limits<double>::infinity();
  EXPECT_THROW(weld_copies(bad), ArgumentError);
  bad = good;
  bad.target.group_order = 1 << 30;
  EXPECT_THROW(weld_copies(bad), ArgumentError);
}

TEST(Palette, ColoursStayDistinctWithFiveBits) {
  std::set<std::tuple<int, int, int>> colours;
  for (int c = 0; c < palette_size; ++c) {
    for (const bool mirrored : {false, true}) {
      const Rgb rgb = tile_colour(c, mirrored);
      colours.emplace(rgb.red >> 3, rgb.green >> 3, rgb.blue >> 3);
    }
  }
  EXPECT_EQ(colours.size(), 2u * palette_size);
}

/// Files in a folder of their own, which goes with the test.
class TilingFiles : public ::testing::Test {
 protected:
  TilingFiles()
      : folder_(
            std::filesystem::path(::testing::TempDir()) /
            (std::string("orbitutte_") + ::testing::UnitTest::GetInstance()->current_test_info()->name())) {
    std::filesystem::remove_all(folder_);
    std::filesystem::create_directories(folder_);
  }
  ~TilingFiles() override { std::filesystem::remove_all(folder_); }

  std::string path(const std::string& name) const { return (folder_ / name).string(); }

  std::string written(const std::string& name) const {
    write_tiling(path(name), tiling_);
    return read_file(path(name));
  }

  const Tiling tiling_ = weld_copies(mirror_triangle(4, 3, 2, 3));
  const std::size_t vertices_ = tiling_.mesh.V.rows();
  const std::size_t faces_ = tiling_.mesh.F.rows();

 private:
  std::filesystem::path folder_;
};

Rgb colour_of_face(const Tiling& tiling, std::size_t f) {
  const TileCopy& copy = tiling.copies[tiling.copy[f]];
  return tile_colour(copy.colour, copy.mirrored);
}

template <class Number>
Number number_at(const std::string& bytes, std::size_t offset) {
  static_assert(std::endian::native == std::endian::little);
  Number value;
  std::memcpy(&value, bytes.data() + offset, sizeof value);
  return value;
}

TEST_F(TilingFiles, PlyReadsBackTheSame) {
  const PlyFile ply = parse_ply(written("tiling.PLY"));
  const PlyElement* vertex = ply.find("vertex");
  const PlyElement* face = ply.find("face");
  ASSERT_TRUE(vertex && face);
  ASSERT_EQ(vertex->count, vertices_);
  ASSERT_EQ(face->count, faces_);
  EXPECT_EQ(vertex->find("x")->type, PlyType::float64);
  EXPECT_EQ(face->find("red")->type, PlyType::uint8);
  for (std::size_t v = 0; v < vertices_; ++v) {
    ASSERT_EQ(vertex->find("x")->values[v], tiling_.mesh.V(v, 0));
    ASSERT_EQ(vertex->find("y")->values[v], tiling_.mesh.V(v, 1));
    ASSERT_EQ(vertex->find("z")->values[v], tiling_.mesh.V(v, 2));
    ASSERT_EQ(vertex->find("source_vertex")->values[v], tiling_.source_vertex[v]);
  }
  for (std::size_t f = 0; f < faces_; ++f) {
    const PlyProperty* corners_of = face->find("vertex_indices");
    ASSERT_EQ(corners_of->list_start[f + 1] - corners_of->list_start[f], 3u);
    for (int k = 0; k < 3; ++k) ASSERT_EQ(corners_of->values[3 * f + k], tiling_.mesh.F(f, k));
    ASSERT_EQ(face->find("tile")->values[f], tiling_.copy[f]);
    ASSERT_EQ(face->find("source_face")->values[f], tiling_.source_face[f]);
    const Rgb colour = colour_of_face(tiling_, f);
    ASSERT_EQ(face->find("red")->values[f], colour.red);
    ASSERT_EQ(face->find("green")->values[f], colour.green);
    ASSERT_EQ(face->find("blue")->values[f], colour.blue);
  }
}

TEST_F(TilingFiles, StlHoldsEveryTriangleWithItsColour) {
  const std::string bytes = written("tiling.stl");
  ASSERT_EQ(bytes.size(), 84 + 50 * faces_);
  EXPECT_NE(bytes.substr(0, 5), "solid");
  EXPECT_EQ(number_at<std::uint32_t>(bytes, 80), faces_);
  for (std::size_t f = 0; f < faces_; ++f) {
    const std::size_t record = 84 + 50 * f;
    double outward = 0;
    for (int k = 0; k < 3; ++k) {
      const double x = tiling_.mesh.V(tiling_.mesh.F(f, 0), k);
      ASSERT_EQ(number_at<float>(bytes, record + 12 + 4 * k), static_cast<float>(x));
      outward += number_at<float>(bytes, record + 4 * k) * x;
    }
    ASSERT_GT(outward, 0.5);
    const Rgb colour = colour_of_face(tiling_, f);
    const int attribute = number_at<std::uint16_t>(bytes, record + 48);
    ASSERT_EQ(attribute, 0x8000 + (colour.red / 8) * 1024 + (colour.green / 8) * 32 + colour.blue / 8);
  }
}

// Moves one end of an edge to within a hair of the other: doubles hold it, STL does not.
TEST_F(TilingFiles, StlLeavesOutTrianglesThatSinglePrecisionDoesNotHold) {
  Tiling tiling = tiling_;
  const int a = tiling.mesh.F(0, 0), b = tiling.mesh.F(0, 1);
  tiling.mesh.V.row(b) = (1 + 1e-12) * tiling.mesh.V.row(a);
  write_tiling(path("t.stl"), tiling);
  const PolygonMesh found = read_mesh(path("t.stl"));
  EXPECT_EQ(found.face_count(), static_cast<int>(faces_) - 2);
  EXPECT_EQ(found.V.rows(), static_cast<Eigen::Index>(vertices_) - 1);
  EXPECT_THAT(found.warnings, testing::IsEmpty());
  EXPECT_THAT(inspect(found).defects, testing::IsEmpty());
}

TEST_F(TilingFiles, StlThatIsNoSurfaceInSinglePrecisionIsRefused) {
  Tiling tiling = tiling_;
  const Vector3 a = tiling.mesh.V.row(0);
  int far = 0;
  (tiling.mesh.V * a).minCoeff(&far);
  tiling.mesh.V.row(far) = (1 + 1e-12) * tiling.mesh.V.row(0);
  try {
    write_tiling(path("t.stl"), tiling);
    FAIL() << "two ends of the sphere are one vertex";
  } catch (const MeshError& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr("1 vertices of the tiling fall on others"));
  }
  EXPECT_FALSE(std::filesystem::exists(path("t.stl")));
  EXPECT_NO_THROW(write_tiling(path("t.ply"), tiling));
}

TEST_F(TilingFiles, ObjReadsBackTheSame) {
  std::istringstream obj(written("a tiling.obj"));
  std::istringstream mtl(read_file(path("a tiling.mtl")));
  std::set<std::string> materials, used;
  for (std::string line; std::getline(mtl, line);)
    if (line.starts_with("newmtl ")) materials.insert(line.substr(7));
  std::size_t v = 0, f = 0;
  int groups = 0;
  for (std::string line; std::getline(obj, line);) {
    std::istringstream words(line);
    std::string key;
    words >> key;
    if (key == "mtllib") {
      EXPECT_EQ(line, "mtllib a tiling.mtl");
    }
    if (key == "g") {
      EXPECT_EQ(line, "g tile_" + std::to_string(groups++));
    }
    if (key == "usemtl") used.insert(line.substr(7));
    if (key == "v") {
      for (int k = 0; k < 3; ++k) {
        std::string number;
        words >> number;
        ASSERT_EQ(std::stod(number), tiling_.mesh.V(v, k));
      }
      ++v;
    }
    if (key == "f") {
      int a, b, c;
      words >> a >> b >> c;
      ASSERT_EQ(Eigen::RowVector3i(a - 1, b - 1, c - 1), tiling_.mesh.F.row(f));
      ++f;
    }
  }
  EXPECT_EQ(v, vertices_);
  EXPECT_EQ(f, faces_);
  EXPECT_EQ(groups, tiling_.copy_count());
  EXPECT_EQ(used, materials);
  EXPECT_THAT(materials, ::testing::ElementsAre("colour_0", "colour_1_mirrored"));
}

/// The two chunks of a GLB, its lengths checked.
struct Glb {
  nlohmann::json json;
  std::string binary;
};

Glb parse_glb(const std::string& bytes) {
  EXPECT_EQ(bytes.substr(0, 4), "glTF");
  EXPECT_EQ(number_at<std::uint32_t>(bytes, 4), 2u);
  EXPECT_EQ(number_at<std::uint32_t>(bytes, 8), bytes.size());
  const std::size_t json_size = number_at<std::uint32_t>(bytes, 12);
  EXPECT_EQ(bytes.substr(16, 4), "JSON");
  EXPECT_EQ(json_size % 4, 0u);
  const std::size_t second = 20 + json_size;
  const std::size_t binary_size = number_at<std::uint32_t>(bytes, second);
  EXPECT_EQ(bytes.substr(second + 4, 4), std::string("BIN\0", 4));
  EXPECT_EQ(second + 8 + binary_size, bytes.size());
  return {nlohmann::json::parse(bytes.substr(20, json_size)), bytes.substr(second + 8)};
}

TEST_F(TilingFiles, GlbHasOnePrimitivePerColourOnSharedVertices) {
  const auto [json, binary] = parse_glb(written("tiling.glb"));
  EXPECT_EQ(json["asset"]["version"], "2.0");
  const auto& primitives = json["meshes"][0]["primitives"];
  ASSERT_EQ(primitives.size(), 2u);
  ASSERT_EQ(json["materials"].size(), 2u);
  std::set<int> materials;
  std::multiset<std::array<int, 3>> triangles;
  for (const auto& primitive : primitives) {
    EXPECT_EQ(primitive["attributes"], primitives[0]["attributes"]);
    materials.insert(primitive["material"].get<int>());
    EXPECT_FALSE(json["materials"][primitive["material"].get<int>()].value("doubleSided", false));
    const auto& indices = json["accessors"][primitive["indices"].get<int>()];
    EXPECT_EQ(indices["componentType"], 5125);
    EXPECT_EQ(indices["type"], "SCALAR");
    const auto& view = json["bufferViews"][indices["bufferView"].get<int>()];
    const std::size_t count = indices["count"].get<std::size_t>();
    ASSERT_EQ(view["byteLength"], 4 * count);
    ASSERT_EQ(count % 3, 0u);
    const std::size_t start = view.value("byteOffset", std::size_t{0});
    for (std::size_t i = 0; i < count; i += 3) {
      const auto index = [start = start + 4 * i, &bytes = binary](std::size_t k) {
        return number_at<int>(bytes, start + 4 * k);
      };
      triangles.insert({index(0), index(1), index(2)});
    }
  }
  EXPECT_EQ(materials.size(), 2u);
  std::multiset<std::array<int, 3>> expected;
  for (std::size_t f = 0; f < faces_; ++f)
    expected.insert({tiling_.mesh.F(f, 0), tiling_.mesh.F(f, 1), tiling_.mesh.F(f, 2)});
  EXPECT_EQ(triangles, expected);
}

TEST_F(TilingFiles, GlbStatesTheBoundsOfItsVertices) {
  const auto [json, binary] = parse_glb(written("tiling.glb"));
  EXPECT_EQ(json["buffers"][0]["byteLength"], binary.size());
  for (const char* attribute : {"POSITION", "NORMAL"}) {
    const auto& accessor =
        json["accessors"][json["meshes"][0]["primitives"][0]["attributes"][attribute].get<int>()];
    ASSERT_EQ(accessor["count"], vertices_);
    EXPECT_EQ(accessor["componentType"], 5126);
    EXPECT_EQ(accessor["type"], "VEC3");
    const auto& view = json["bufferViews"][accessor["bufferView"].get<int>()];
    EXPECT_EQ(view["byteStride"], 12);  // needed where two accessors share a view
    const std::size_t start = view.value("byteOffset", std::size_t{0});
    Eigen::MatrixX3f positions(vertices_, 3);
    for (std::size_t v = 0; v < vertices_; ++v)
      for (int k = 0; k < 3; ++k) positions(v, k) = number_at<float>(binary, start + 12 * v + 4 * k);
    EXPECT_EQ(positions, tiling_.mesh.V.cast<float>());
    for (int k = 0; k < 3; ++k) {
      EXPECT_EQ(accessor["min"][k].get<float>(), positions.col(k).minCoeff());
      EXPECT_EQ(accessor["max"][k].get<float>(), positions.col(k).maxCoeff());
    }
  }
}

TEST_F(TilingFiles, GlbOfAPatchOfThePlaneHasUprightNormals) {
  const Tiling patch = weld_copies(test::sample_embedding("442").embedding(), 5);
  write_tiling(path("patch.glb"), patch);
  const auto [json, binary] = parse_glb(read_file(path("patch.glb")));
  const auto& attributes = json["meshes"][0]["primitives"][0]["attributes"];
  const auto& accessor = json["accessors"][attributes["NORMAL"].get<int>()];
  const auto& view = json["bufferViews"][accessor["bufferView"].get<int>()];
  const std::size_t start = view.value("byteOffset", std::size_t{0});
  ASSERT_EQ(accessor["count"], patch.mesh.V.rows());
  for (Eigen::Index v = 0; v < patch.mesh.V.rows(); ++v)
    for (int k = 0; k < 3; ++k)
      EXPECT_NEAR(number_at<float>(binary, start + 12 * v + 4 * k), k == 2 ? 1 : 0, 1e-6) << v;
}

TEST_F(TilingFiles, BytesAreDeterministic) {
  for (const std::string name : {"t.ply", "t.obj", "t.stl", "t.glb"})
    EXPECT_EQ(written(name), written(name)) << name;
}

TEST_F(TilingFiles, EveryEndingThatIsNamedIsWrittenAndNamedInRefusals) {
  std::string refusal;
  try {
    write_tiling(path("t.off"), tiling_);
  } catch (const ArgumentError& error) {
    refusal = error.what();
  }
  for (const std::string& ending : tiling_endings()) {
    EXPECT_GT(written("t" + ending).size(), 100u) << ending;
    EXPECT_THAT(refusal, testing::HasSubstr(ending));
  }
}

TEST_F(TilingFiles, RefusesOtherEndings) {
  for (const std::string name : {"t.off", "t", "ply", "t.gltf"}) {
    EXPECT_THROW(write_tiling(path(name), tiling_), ArgumentError) << name;
    EXPECT_FALSE(std::filesystem::exists(path(name)));
  }
}

TEST_F(TilingFiles, ReportsFoldersThatDoNotExist) {
  for (const std::string name : {"no/t.ply", "no/t.obj", "no/t.stl", "no/t.glb"})
    EXPECT_THROW(write_tiling(path(name), tiling_), FileError) << name;
}

}  // namespace
}  // namespace orbitutte::tiling_test
