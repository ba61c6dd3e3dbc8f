// SPDX-License-Identifier: MIT
// The overlay of two surfaces on one target, its certificate, and the maps of vertices and points.
#include "orbitutte/map/overlay.h"

#include <gmock/gmock.h>
#include <rapidcheck.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <random>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "limb.h"
#include "orbitutte/cones/extremities.h"
#include "orbitutte/export/map_files.h"
#include "orbitutte/io/file.h"
#include "orbitutte/io/mesh_io.h"
#include "orbitutte/map/overlay_certificate.h"
#include "orbitutte/map/surface_map.h"
#include "orbitutte/map/vertex_map.h"
#include "orbitutte/samples/sample.h"
#include "random_spheres.h"
#include "sample_embeddings.h"

namespace orbitutte::overlay_test {
namespace {

using ::testing::Contains;
using ::testing::HasSubstr;

// What the certificate finds wrong, or nothing.
std::string fault_in(const OverlayCertificate& certificate) {
  std::string faults;
  for (const Check& check : certificate.checks)
    if (!check.passed) faults += check.name + ": " + check.detail + "; ";
  EXPECT_EQ(certificate.holds, faults.empty());
  return faults;
}

std::set<std::string> failed_checks(const OverlayCertificate& certificate) {
  std::set<std::string> names;
  for (const Check& check : certificate.checks)
    if (!check.passed) names.insert(check.name);
  EXPECT_EQ(certificate.holds, names.empty());
  return names;
}

EmbedOptions options_with_cut(std::uint64_t seed) {
  EmbedOptions options;
  options.threads = 1;
  options.cut.seed = seed;
  return options;
}

// The same topology as the sample, other vertices.
Mesh other_mesh_for(const Target& target) {
  if (target.topology == Topology::sphere) {
    Mesh mesh = test::perturbed(test::octasphere(3), 0.03, 11);
    mesh.V.col(0) *= 1.4;
    return mesh;
  }
  Mesh mesh = test::round_disk(6);
  mesh.V.col(2) = 0.3 * mesh.V.col(1).array().square() + 0.1 * mesh.V.col(0).array();
  return test::perturbed(mesh, 0.02, 3);
}

struct Pair {
  Mesh a_mesh, b_mesh;
  EmbedResult a, b;
};

Pair sample_pair(const std::string& signature) {
  const Target target = parse_orbifold(signature);
  Pair pair = {test::sample_mesh_for(target), other_mesh_for(target), {}, {}};
  pair.a = embed(pair.a_mesh, target, choose_cones(pair.a_mesh, target), options_with_cut(0));
  pair.b = embed(pair.b_mesh, target, choose_cones(pair.b_mesh, target), options_with_cut(1));
  return pair;
}

class OverlayOf : public testing::TestWithParam<std::string> {};

INSTANTIATE_TEST_SUITE_P(Families, OverlayOf,
                         testing::Values("532", "432", "332", "222", "225", "22", "55", "333", "442", "632",
                                         "*532", "*332", "*222", "*225", "*22", "*55", "3*2", "2*2", "2*3",
                                         "2*", "5*", "*333", "*442", "*632", "1", "*"),
                         [](const auto& info) {
                           std::string name = info.param;
                           for (std::size_t at; (at = name.find('*')) != std::string::npos;)
                             name.replace(at, 1, "star");
                           return name;
                         });

TEST_P(OverlayOf, TwoSurfacesIsCertified) {
  const Pair pair = sample_pair(GetParam());
  ASSERT_TRUE(pair.a.certificate.bijective && pair.b.certificate.bijective);
  const Overlay result = overlay(pair.a.embedding, pair.b.embedding);
  EXPECT_EQ(fault_in(certify(result, pair.a.embedding, pair.b.embedding)), "");
  EXPECT_GT(result.vertex_count(), pair.a_mesh.V.rows() + pair.b_mesh.V.rows());
}

TEST_P(OverlayOf, ASurfaceWithItselfIsTheSurface) {
  const Target target = parse_orbifold(GetParam());
  const Mesh mesh = test::sample_mesh_for(target);
  const EmbedResult a = embed(mesh, target, choose_cones(mesh, target), options_with_cut(0));
  const Overlay result = overlay(a.embedding, a.embedding);
  EXPECT_EQ(fault_in(certify(result, a.embedding, a.embedding)), "");
  EXPECT_EQ(result.vertex_count(), mesh.V.rows());
  EXPECT_EQ(result.face_count(), mesh.F.rows());
}

// The cut decides which copies of the tile vertices lie in, and by how much they are rounded.
TEST_P(OverlayOf, ASurfaceWithItselfCutElsewhereMovesNothing) {
  if (parse_orbifold(GetParam()).is_free_to_rotate) GTEST_SKIP() << "turned about its axis";
  const Target target = parse_orbifold(GetParam());
  const Mesh mesh = test::sample_mesh_for(target);
  const std::vector<int> marks = choose_cones(mesh, target);
  const EmbedResult a = embed(mesh, target, marks, options_with_cut(0)),
                    b = embed(mesh, target, marks, options_with_cut(3));
  const Overlay result = overlay(a.embedding, b.embedding);
  EXPECT_EQ(fault_in(certify(result, a.embedding, b.embedding)), "");
  const VertexMap map = images_of_vertices(a.embedding, b.embedding);
  const Points images = positions_on(mesh.V, b.embedding, map.images);
  EXPECT_LT((images - mesh.V).rowwise().norm().maxCoeff(), 1e-7);
}

TEST_P(OverlayOf, MapsThereAndBackAreTheIdentity) {
  const Pair pair = sample_pair(GetParam());
  const Embedding &a = pair.a.embedding, &b = pair.b.embedding;
  const VertexMap there = images_of_vertices(a, b);
  const Points images = positions_on(pair.a_mesh.V, a, images_of_points(b, a, there.images));
  EXPECT_LT((images - pair.a_mesh.V).rowwise().norm().maxCoeff(), 1e-9);
  for (std::size_t k = 0; k < a.cones.size(); ++k) {
    const int of_a = a.cones[k].vertex;
    int corner = 0;
    EXPECT_EQ(there.images.barycentric.row(of_a).maxCoeff(&corner), 1);
    EXPECT_EQ(there.corners(of_a, corner), b.cones[k].vertex);
  }
}

TEST_P(OverlayOf, HasTheImagesOfAllVertices) {
  const Pair pair = sample_pair(GetParam());
  const Embedding &a = pair.a.embedding, &b = pair.b.embedding;
  const VertexMaps maps = vertex_maps(overlay(a, b), a, b);
  const auto difference = [](const Points& V, const Embedding& on, const VertexMap& x, const VertexMap& y) {
    return (positions_on(V, on, x.images) - positions_on(V, on, y.images)).rowwise().norm().maxCoeff();
  };
  EXPECT_LT(difference(pair.b_mesh.V, b, maps.a_to_b, images_of_vertices(a, b)), 1e-12);
  EXPECT_LT(difference(pair.a_mesh.V, a, maps.b_to_a, images_of_vertices(b, a)), 1e-12);
}

// Values and points of a certified pair.

TEST(VertexMap, IsAMatrixWhoseRowsSumToOne) {
  const Pair pair = sample_pair("332");
  const VertexMap map = images_of_vertices(pair.a.embedding, pair.b.embedding);
  const Eigen::MatrixXd values = pair.b_mesh.V;
  Eigen::VectorXd sums = Eigen::VectorXd::Zero(pair.a_mesh.V.rows());
  Eigen::MatrixXd product = Eigen::MatrixXd::Zero(pair.a_mesh.V.rows(), 3);
  int row = 0, column = -1;
  for (const MatrixEntry& entry : transfer_matrix(map)) {
    EXPECT_TRUE(entry.row > row || (entry.row == row && entry.column > column));
    row = entry.row, column = entry.column;
    EXPECT_GT(entry.value, 0);
    sums[row] += entry.value;
    product.row(row) += entry.value * values.row(column);
  }
  EXPECT_LT((sums.array() - 1).abs().maxCoeff(), 1e-12);
  EXPECT_LT((product - transfer(map, values)).cwiseAbs().maxCoeff(), 1e-12);
  EXPECT_LT((positions_on(pair.b_mesh.V, pair.b.embedding, map.images) - product).cwiseAbs().maxCoeff(),
            1e-12);
}

TEST(VertexMap, TakesTheLabelOfTheNearestCorner) {
  const Pair pair = sample_pair("222");
  const VertexMap map = images_of_vertices(pair.a.embedding, pair.b.embedding);
  const std::vector<int> labels = test::permutation(static_cast<int>(pair.b_mesh.V.rows()), 5),
                         found = transfer_labels(map, labels);
  for (int v = 0; v < map.count(); ++v)
    for (int k = 0; k < 3; ++k)
      if (map.images.barycentric(v, k) > 0.5) EXPECT_EQ(found[v], labels[map.corners(v, k)]);
  EXPECT_THROW(transfer_labels(map, {1, 2}), ArgumentError);
  EXPECT_THROW(transfer(map, Eigen::MatrixXd::Zero(3, 1)), ArgumentError);
}

TEST(VertexMap, IsWhereTheOverlayHasTheVertices) {
  const Pair pair = sample_pair("333");
  const Embedding &a = pair.a.embedding, &b = pair.b.embedding;
  const Overlay both = overlay(a, b);
  const Points on_b = positions_on(pair.b_mesh.V, b, both.on_b),
               images = positions_on(pair.b_mesh.V, b, images_of_vertices(a, b).images);
  for (int v = 0; v < both.vertex_count(); ++v)
    if (const int of_a = both.vertices[v].a_vertex; of_a >= 0)
      EXPECT_LT((on_b.row(v) - images.row(of_a)).norm(), 1e-12);
}

TEST(SurfacePoints, OfAnotherSurfaceAreRefusedByTheirNumbers) {
  const Pair pair = sample_pair("332");
  const Embedding &a = pair.a.embedding, &b = pair.b.embedding;
  const auto refusal = [&](const SurfacePoints& points) -> std::string {
    try {
      images_of_points(a, b, points);
    } catch (const ArgumentError& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_EQ(refusal({{3, -1}, Points::Constant(2, 3, 1.0 / 3), {}}), "");
  EXPECT_THAT(refusal({{3, 4000}, Points::Constant(2, 3, 1.0 / 3), {}}),
              HasSubstr("point 1 names the triangle 4000"));
  EXPECT_THAT(refusal({{3, 4}, Points::Constant(2, 3, 0.5), {}}), HasSubstr("point 0 has the barycentric"));
  EXPECT_THAT(refusal({{3}, Points::Constant(2, 3, 1.0 / 3), {}}), HasSubstr("1 triangles and 2 rows"));
}

// A path along edges of A, whose image runs over B.
TEST(SurfacePoints, OfAPolylineCrossTheEdgesOfTheOtherSurface) {
  const Pair pair = sample_pair("332");
  const Embedding &a = pair.a.embedding, &b = pair.b.embedding;
  const Connectivity connectivity = test::edges_of(pair.a_mesh);
  SurfacePoints path = {{}, Points(8, 3), {}};
  int h = 0;
  for (int k = 0; k < 8; ++k) {
    path.triangle.push_back(h / 3);
    path.barycentric.row(k) = Vector3::Unit(h % 3).transpose();
    h = next_halfedge(h);
    for (int turn = 0; turn < 2; ++turn) h = connectivity.opposite[previous_halfedge(h)];
  }
  const SurfacePoints image = image_of_polyline(a, b, path);
  ASSERT_GT(image.count(), path.count());
  const Points back = positions_on(pair.a_mesh.V, a, images_of_points(b, a, image)),
               corners = positions_on(pair.a_mesh.V, a, path);
  int next = 0;
  for (int k = 0; k < image.count(); ++k) {
    if (next < path.count() && (back.row(k) - corners.row(next)).norm() < 1e-9) {
      ++next;
      continue;
    }
    ASSERT_GT(next, 0);
    EXPECT_EQ(image.barycentric.row(k).minCoeff(), 0) << "on an edge of B";
    const Vector3 from = corners.row(next - 1), to = corners.row(next), here = back.row(k);
    EXPECT_NEAR((here - from).norm() + (to - here).norm(), (to - from).norm(), 1e-9);
  }
  EXPECT_EQ(next, path.count());
  path.triangle[3] = 200;
  EXPECT_THROW(image_of_polyline(a, b, path), ArgumentError);
}

TEST(Overlay, OfDifferentTilesIsRefused) {
  const Pair first = sample_pair("332"), second = sample_pair("222");
  EXPECT_THROW(overlay(first.a.embedding, second.b.embedding), ArgumentError);
  const Target target = parse_orbifold("1x");
  const Mesh mesh = test::sample_mesh_for(target);
  const EmbedResult plane = embed(mesh, target, choose_cones(mesh, target), options_with_cut(0));
  EXPECT_THROW(overlay(plane.embedding, plane.embedding), ArgumentError);
}

// The tile of 2222 has the shape of the surface: that of another surface is another one.
TEST(Overlay, OfTilesOfDifferentShapesIsRefused) {
  const Pair pair = sample_pair("2222");
  EXPECT_THROW(overlay(pair.a.embedding, pair.b.embedding), ArgumentError);
}

TEST(Overlay, OfTriangleThatIsTurnedOverIsRefused) {
  Pair pair = sample_pair("332");
  std::swap(pair.b.embedding.triangles(5, 0), pair.b.embedding.triangles(5, 1));
  EXPECT_THROW(overlay(pair.a.embedding, pair.b.embedding), Error);
}

class MapFiles : public testing::Test {
 protected:
  void SetUp() override { std::filesystem::create_directories(folder_); }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  std::string path(const char* name) const { return (folder_ / name).string(); }

  std::filesystem::path folder_ =
      std::filesystem::path(testing::TempDir()) / ("orbitutte_map_files_" + std::to_string(::getpid()));
};

TEST_F(MapFiles, OfTheOverlayHaveTheSameFaces) {
  const Pair pair = sample_pair("222");
  const Overlay both = overlay(pair.a.embedding, pair.b.embedding);
  const Points on_a = positions_on(pair.a_mesh.V, pair.a.embedding, both.on_a),
               on_b = positions_on(pair.b_mesh.V, pair.b.embedding, both.on_b);
  write_overlay(path("a.obj"), both, on_a);
  write_overlay(path("b.obj"), both, on_b);
  const PolygonMesh a = read_mesh(path("a.obj")), b = read_mesh(path("b.obj"));
  EXPECT_EQ(a.corners, b.corners);
  EXPECT_EQ(a.face_start, both.faces.start);
  EXPECT_EQ(a.V, on_a);
  EXPECT_EQ(b.V, on_b);
}

TEST_F(MapFiles, OfVerticesHaveALineForEach) {
  const Pair pair = sample_pair("332");
  const VertexMap map = images_of_vertices(pair.a.embedding, pair.b.embedding);
  write_vertex_map(path("a_to_b.txt"), map);
  std::istringstream lines(read_file(path("a_to_b.txt")));
  for (int v = 0; v < map.count(); ++v) {
    int face = -1;
    Vector3 w;
    ASSERT_TRUE(lines >> face >> w[0] >> w[1] >> w[2]);
    EXPECT_EQ(face, map.images.triangle[v]);
    EXPECT_EQ(w, Vector3(map.images.barycentric.row(v)));
  }
  EXPECT_FALSE(lines >> std::ws && !lines.eof());
}

TEST_F(MapFiles, MorphsGoFromOneSurfaceToTheOther) {
  const Pair pair = sample_pair("222");
  const Overlay both = overlay(pair.a.embedding, pair.b.embedding);
  const Morph morph = morph_of(both, positions_on(pair.a_mesh.V, pair.a.embedding, both.on_a),
                               positions_on(pair.b_mesh.V, pair.b.embedding, both.on_b));
  EXPECT_EQ(morph_positions(morph, 0), morph.from);
  EXPECT_EQ(morph_positions(morph, 1), morph.to);
  write_morph(path("morph.glb"), morph);
  const std::string bytes = read_file(path("morph.glb"));
  EXPECT_EQ(bytes.substr(0, 4), "glTF");
  EXPECT_THAT(bytes, HasSubstr("\"targets\":[{"));
  EXPECT_THAT(bytes, HasSubstr("\"path\":\"weights\""));
  EXPECT_THROW(morph_of(both, morph.from, Points(3, 3)), ArgumentError);
}

// Faults of every kind are found, each by the check that is there for it.
class PlantedFault : public testing::Test {
 protected:
  static const Pair& pair() {
    static const Pair result = sample_pair("332");
    return result;
  }

  PlantedFault() : good_(overlay(pair().a.embedding, pair().b.embedding)), bad_(good_) {}

  std::set<std::string> found() const {
    return failed_checks(certify(bad_, pair().a.embedding, pair().b.embedding));
  }

  // A face with so many corners, or more.
  int face_of(int corners) const {
    for (int f = 0; f < good_.face_count(); ++f)
      if (good_.faces.start[f + 1] - good_.faces.start[f] >= corners) return f;
    return -1;
  }

  int crossing() const {
    for (int v = 0; v < good_.vertex_count(); ++v)
      if (good_.vertices[v].a_vertex < 0 && good_.vertices[v].b_vertex < 0) return v;
    return -1;
  }

  int* corners_of(int f) { return bad_.faces.corners.data() + bad_.faces.start[f]; }

  Overlay good_, bad_;
};

TEST_F(PlantedFault, NoneIsFoundWhereThereIsNone) { EXPECT_EQ(found(), std::set<std::string>()); }

TEST_F(PlantedFault, AFaceTheOtherWayRound) {
  std::swap(corners_of(7)[0], corners_of(7)[1]);
  EXPECT_THAT(found(), Contains("surface"));
  EXPECT_THAT(found(), Contains("positive_faces"));
}

TEST_F(PlantedFault, AMissingFace) {
  const int last = bad_.face_count() - 1;
  bad_.faces.corners.resize(bad_.faces.start[last]);
  bad_.faces.start.pop_back();
  bad_.parents.pop_back();
  EXPECT_THAT(found(), Contains("surface"));
  EXPECT_THAT(found(), Contains("euler_characteristic"));
  EXPECT_THAT(found(), Contains("shares_of_a"));
  EXPECT_THAT(found(), Contains("shares_of_b"));
}

TEST_F(PlantedFault, ParentsOfAnotherFace) {
  std::swap(bad_.parents[3], bad_.parents[200]);
  EXPECT_THAT(found(), Contains("parents"));
  EXPECT_THAT(found(), Contains("neighbours"));
}

TEST_F(PlantedFault, AnotherPlacement) {
  ASSERT_GT(bad_.placements.size(), 1u);
  bad_.parents[3].placement = bad_.parents[3].placement == 0 ? 1 : 0;
  EXPECT_THAT(found(), Contains("placements"));
}

TEST_F(PlantedFault, APlacementThatIsNoElement) {
  bad_.placements[0] = Space::sphere().rotation(Vector3::UnitX(), 0.3) * bad_.placements[0];
  EXPECT_THAT(found(), Contains("group"));
}

TEST_F(PlantedFault, APositionOnOneSurface) {
  const int v = crossing(), first = bad_.vertices[v].a_halfedge % 3;
  auto row = bad_.on_a.barycentric.row(v);
  row = 0.999 * row + 0.001 * Eigen::RowVector3d::Unit(first);
  EXPECT_THAT(found(), Contains("positions"));
}

TEST_F(PlantedFault, ACrossingOfOtherEdges) {
  OverlayVertex& v = bad_.vertices[crossing()];
  v.a_halfedge = (v.a_halfedge + 30) % 900;
  EXPECT_THAT(found(), Contains("parents"));
}

TEST_F(PlantedFault, AVertexThatIsNowhere) {
  for (OverlayVertex& v : bad_.vertices)
    if (v.a_vertex == 17) v.a_vertex = -1;
  EXPECT_THAT(found(), Contains("vertices"));
}

TEST_F(PlantedFault, APolygonThatIsNotConvex) {
  const int f = face_of(5);
  std::swap(corners_of(f)[1], corners_of(f)[2]);
  EXPECT_THAT(found(), Contains("positive_faces"));
}

TEST_F(PlantedFault, MarksThatAreExchanged) {
  Embedding b = pair().b.embedding;
  std::swap(b.cones[1], b.cones[2]);
  EXPECT_THAT(failed_checks(certify(bad_, pair().a.embedding, b)), Contains("landmarks"));
}

TEST_F(PlantedFault, IndicesOutOfRange) {
  bad_.faces.corners[4] = bad_.vertex_count();
  EXPECT_THAT(found(), Contains("indices"));
  bad_ = good_;
  bad_.parents.pop_back();
  EXPECT_THAT(found(), Contains("indices"));
}

// Small meshes as irregular as can be, with marks anywhere.

std::vector<int> some_marks(const Mesh& mesh, std::size_t count, std::uint32_t seed) {
  std::vector<int> vertices = test::permutation(static_cast<int>(mesh.V.rows()), seed);
  vertices.resize(std::min(count, vertices.size()));
  return vertices;
}

// Nothing if the marks cannot be had, or the map is not certified. Some of these meshes are not 3-connected,
// and have triangles whose images are as thin as rounding.
std::optional<Embedding> random_embedding(const Mesh& mesh, const Target& target, std::uint32_t seed) {
  try {
    const EmbedResult result =
        embed(mesh, target, some_marks(mesh, target.marks.size(), seed), options_with_cut(seed));
    if (result.certificate.bijective) return result.embedding;
  } catch (const MeshError&) {
  }
  return std::nullopt;
}

std::string fault_in_overlay(const Embedding& a, const Embedding& b) {
  const Overlay result = overlay(a, b);
  std::string fault = fault_in(certify(result, a, b));
  const VertexMap map = images_of_vertices(a, b);
  for (int v = 0; v < result.vertex_count() && fault.empty(); ++v) {
    const OverlayVertex& vertex = result.vertices[v];
    if (vertex.a_vertex < 0 || vertex.b_vertex < 0) continue;
    if (map.images.barycentric.row(vertex.a_vertex).maxCoeff() != 1) fault = "the vertex map differs";
  }
  return fault;
}

RC_GTEST_PROP(Overlay, OfRandomSpheresIsCertified, ()) {
  const std::string signature = *rc::gen::element<std::string>("222", "332", "432", "225", "22", "33", "333");
  const auto seed = *rc::gen::inRange<std::uint32_t>(0, 1u << 30);
  const Target target = parse_orbifold(signature);
  const Mesh a = test::random_sphere(seed, static_cast<int>(seed % 23)),
             b = test::random_sphere(seed + 1, static_cast<int>(seed % 17));
  const std::optional<Embedding> of_a = random_embedding(a, target, seed),
                                 of_b = random_embedding(b, target, seed + 7);
  RC_PRE(of_a && of_b);
  try {
    RC_ASSERT(fault_in_overlay(*of_a, *of_b) == "");
  } catch (const MeshError& error) {
    RC_ASSERT(std::string(error.what()).find("so thin") != std::string::npos);
  }
}

RC_GTEST_PROP(Overlay, OfARandomSphereCutInTwoWaysIsCertified, ()) {
  const std::string signature = *rc::gen::element<std::string>("222", "332", "2222", "2,2,2,2,2");
  const auto seed = *rc::gen::inRange<std::uint32_t>(0, 1u << 30);
  const Target target = parse_orbifold(signature);
  const Mesh mesh = test::random_sphere(seed, 10 + static_cast<int>(seed % 19));
  RC_PRE(mesh.V.rows() > static_cast<Eigen::Index>(target.marks.size()));
  const std::vector<int> marks = some_marks(mesh, target.marks.size(), seed);
  const EmbedResult a = embed(mesh, target, marks, options_with_cut(1)),
                    b = embed(mesh, target, marks, options_with_cut(2));
  RC_PRE(a.certificate.bijective && b.certificate.bijective);
  RC_ASSERT(fault_in_overlay(a.embedding, a.embedding) == "");
  if (!target.has_free_tile) RC_ASSERT(fault_in_overlay(a.embedding, b.embedding) == "");
}

// Tiles that have the shape of the surface.
class OverlayOnFreeTile : public testing::TestWithParam<std::string> {};
INSTANTIATE_TEST_SUITE_P(Families, OverlayOnFreeTile,
                         testing::Values("2222", "2,2,2,2,2", "2,2,2,2,2,2", "*2222"), [](const auto& info) {
                           return (info.param[0] == '*' ? "star" : "") + std::to_string(info.param.size());
                         });

TEST_P(OverlayOnFreeTile, OneSurfaceWithTwoCutsIsCertified) {
  const Target target = parse_orbifold(GetParam());
  const Mesh mesh = test::sample_mesh_for(target);
  const std::vector<int> marks = choose_cones(mesh, target);
  const EmbedResult a = embed(mesh, target, marks, options_with_cut(0));
  ASSERT_TRUE(a.certificate.bijective);
  Overlay result = overlay(a.embedding, a.embedding);
  EXPECT_EQ(fault_in(certify(result, a.embedding, a.embedding)), "");
  EXPECT_EQ(result.vertex_count(), mesh.V.rows());
  if (target.space.curvature() < 0) return;  // another cut has another image of the second mark on x
  const EmbedResult b = embed(mesh, target, marks, options_with_cut(1));
  ASSERT_TRUE(b.certificate.bijective);
  result = overlay(a.embedding, b.embedding);
  EXPECT_EQ(fault_in(certify(result, a.embedding, b.embedding)), "");
}

// Tiles of any shape that two surfaces share, cut in different ways; on disks with cones of any angle.
struct Landmarked {
  int inside, on_boundary;
};

class OverlayOfMap : public testing::TestWithParam<Landmarked> {
 protected:
  // On a disk if there are landmarks on a boundary.
  OverlayOfMap()
      : mesh_(test::sample_mesh_for(parse_orbifold(GetParam().on_boundary > 0 ? "*222" : "222"))),
        surface_(make_surface(mesh_)) {
    for (const int v : choose_extremities(surface_, {GetParam().inside, GetParam().on_boundary}))
      landmarks_.push_back({v, v});
    options_.cut_b.seed = 3;
    options_.embed.threads = 1;
    options_.embed.tolerance = 1e-12;
  }

  Mesh mesh_;
  Surface surface_;
  std::vector<Landmark> landmarks_;
  MapOptions options_;
};

INSTANTIATE_TEST_SUITE_P(Landmarks, OverlayOfMap,
                         testing::Values(Landmarked{4, 0}, Landmarked{5, 0}, Landmarked{6, 0},
                                         Landmarked{0, 5}, Landmarked{1, 1}, Landmarked{2, 3},
                                         Landmarked{4, 4}),
                         [](const auto& info) {
                           return std::to_string(info.param.inside) + "And" +
                                  std::to_string(info.param.on_boundary);
                         });

TEST_P(OverlayOfMap, OfASurfaceToItselfMovesNothing) {
  const SurfaceMap map = map_between(surface_, surface_, landmarks_, options_);
  ASSERT_TRUE(map.is_bijective());
  const Embedding &a = map.a.embedding, &b = map.b.embedding;
  EXPECT_EQ(fault_in(certify(overlay(a, b), a, b)), "");
  const Points images = positions_on(mesh_.V, b, images_of_vertices(a, b).images);
  EXPECT_LT((images - mesh_.V).rowwise().norm().maxCoeff(), 1e-7);
}

// Another surface, bent: with another cut it has the same image.
TEST_P(OverlayOfMap, DoesNotDependOnTheCut) {
  Mesh bent = mesh_;
  bent.V.col(0) *= 1.2;
  bent.V.col(2).array() += 0.2 * mesh_.V.col(0).array().square();
  const Surface other = make_surface(bent);
  std::vector<Points> images;
  for (const std::uint64_t seed : {0, 3}) {
    options_.cut_a.seed = options_.cut_b.seed = seed;
    const SurfaceMap map = map_between(surface_, other, landmarks_, options_);
    ASSERT_TRUE(map.is_bijective());
    const Embedding &a = map.a.embedding, &b = map.b.embedding;
    EXPECT_EQ(fault_in(certify(overlay(a, b), a, b)), "");
    images.push_back(positions_on(bent.V, b, images_of_vertices(a, b).images));
  }
  EXPECT_LT((images[0] - images[1]).rowwise().norm().maxCoeff(), 1e-6);
}

// Six limbs, most of which shrink below what doubles resolve.
TEST(Overlay, OfOctocatIsCertified) {
  const std::string path = std::string(ORBITUTTE_SHARED_DIR) + "/meshes/octocat.off";
  if (!std::filesystem::exists(path)) GTEST_SKIP() << path << " is missing";
  const Mesh mesh = to_triangle_mesh(read_mesh(path));
  const Target target = parse_orbifold("532");
  const std::vector<int> marks = choose_cones(mesh, target);
  const EmbedResult a = embed(mesh, target, marks, options_with_cut(0)),
                    b = embed(mesh, target, marks, options_with_cut(2));
  ASSERT_TRUE(a.certificate.bijective && b.certificate.bijective);
  ASSERT_FALSE(a.embedding.offsets.empty());
  EXPECT_EQ(fault_in(certify(overlay(a.embedding, b.embedding), a.embedding, b.embedding)), "");
}

// With three landmarks, five of six limbs shrink below what doubles resolve. With eight, edges do not, but
// copies of them lie so far out in the hyperbolic plane that their doubles do not either.
class OverlayOfOctocat : public testing::TestWithParam<int> {};
INSTANTIATE_TEST_SUITE_P(Landmarks, OverlayOfOctocat, testing::Values(3, 8));

TEST_P(OverlayOfOctocat, WithItselfMovesNothingWhicheverTheCuts) {
  const std::string path = std::string(ORBITUTTE_SHARED_DIR) + "/meshes/octocat.off";
  if (!std::filesystem::exists(path)) GTEST_SKIP() << path << " is missing";
  const Mesh mesh = to_triangle_mesh(read_mesh(path));
  const Surface surface = make_surface(mesh);
  std::vector<Landmark> landmarks;
  for (const int v : choose_extremities(surface, {GetParam(), 0})) landmarks.push_back({v, v});
  MapOptions options;
  options.cut_b.seed = 7;
  const SurfaceMap map = map_between(surface, surface, landmarks, options);
  ASSERT_TRUE(map.is_bijective());
  const Embedding &a = map.a.embedding, &b = map.b.embedding;
  EXPECT_FALSE(a.offsets.empty() || b.offsets.empty());
  const double size = (mesh.V.colwise().maxCoeff() - mesh.V.colwise().minCoeff()).norm();
  const Points images = positions_on(mesh.V, b, images_of_vertices(a, b).images);
  EXPECT_LT((images - mesh.V).rowwise().norm().maxCoeff(), 1e-7 * size);
}

// Two limbs that shrink below what doubles resolve.
TEST(Overlay, WhereDoublesResolveNothingIsCertified) {
  const test::Limb a(1.0 / 8, 30), b(1.0 / 5, 40);
  const Overlay result = overlay(a.embedding, b.embedding);
  EXPECT_EQ(fault_in(certify(result, a.embedding, b.embedding)), "");
  const VertexMap there = images_of_vertices(a.embedding, b.embedding);
  const Points images =
      positions_on(a.mesh.V, a.embedding, images_of_points(b.embedding, a.embedding, there.images));
  EXPECT_LT((images - a.mesh.V).rowwise().norm().maxCoeff(), 1e-9);
}

// The cuts of this tour lie so far out that doubles put the images of B's vertices 1e-9 off.
TEST(Overlay, OfCatAndHorseIsCertifiedAlongALongTour) {
  const std::string folder = std::string(ORBITUTTE_SHARED_DIR) + "/pairs/cat_horse";
  if (!std::filesystem::exists(folder)) GTEST_SKIP() << folder << " is missing";
  const std::vector<Landmark> all = read_landmarks(folder + "/landmarks.tsv");
  std::vector<Landmark> landmarks;
  for (const int row : {14, 12, 9, 3, 7, 5, 0}) landmarks.push_back(all.at(row));
  MapOptions options;
  options.tour = {5, 1, 4, 0, 6, 3, 2};
  const SurfaceMap map =
      map_between(make_surface(to_triangle_mesh(read_mesh(folder + "/a.off"))),
                  make_surface(to_triangle_mesh(read_mesh(folder + "/b.off"))), landmarks, options);
  ASSERT_TRUE(map.is_bijective());
  const Embedding &a = map.a.embedding, &b = map.b.embedding;
  EXPECT_EQ(fault_in(certify(overlay(a, b), a, b)), "");
}

// The same map in a frame in which it lies at that height of the hyperboloid.
Embedding moved_out(Embedding embedding, double height) {
  const Vector3 there(std::sqrt(height * height - 1), 0, height);
  const Isometry out = embedding.space().to_origin(there).inverse();
  embedding.positions = out.on_rows(embedding.positions);
  for (Seam& seam : embedding.seams) seam.transform = out * seam.transform * out.inverse();
  embedding.placement = out * embedding.placement;
  return embedding;
}

// Coordinates grow with the distance from (0, 0, 1), and the entries of the group's elements with its square.
class OverlayFarOut : public testing::TestWithParam<double> {
 protected:
  void SetUp() override {
    const Mesh mesh = test::sample_mesh_for(parse_orbifold("222")),
               other = other_mesh_for(parse_orbifold("222"));
    const Surface surface = make_surface(mesh), other_surface = make_surface(other);
    const std::vector<int> marks = choose_extremities(surface, {5, 0}),
                           other_marks = choose_extremities(other_surface, {5, 0});
    std::vector<Landmark> landmarks;
    for (int k = 0; k < 5; ++k) landmarks.push_back({marks[k], other_marks[k]});
    const SurfaceMap map = map_between(surface, other_surface, landmarks);
    ASSERT_TRUE(map.is_bijective());
    a_ = moved_out(map.a.embedding, GetParam());
    b_ = moved_out(map.b.embedding, GetParam());
  }

  Embedding a_, b_;
};
INSTANTIATE_TEST_SUITE_P(Heights, OverlayFarOut, testing::Values(1, 20, 200));

TEST_P(OverlayFarOut, IsCertified) { EXPECT_EQ(fault_in(certify(overlay(a_, b_), a_, b_)), ""); }

TEST_P(OverlayFarOut, ShowsAPositionThatIsAMillionthOff) {
  Overlay bad = overlay(a_, b_);
  for (int v = 0; v < bad.vertex_count(); ++v) {
    if (bad.vertices[v].a_halfedge < 0) continue;
    auto row = bad.on_a.barycentric.row(v);
    row = (1 - 1e-6) * row + 1e-6 * Eigen::RowVector3d::Unit(bad.vertices[v].a_halfedge % 3);
    break;
  }
  EXPECT_THAT(failed_checks(certify(bad, a_, b_)), Contains("positions"));
}

// Triangles with two edges on the boundary, one at every `step`-th edge of it: on one mirror they are flat.
Mesh with_ears(const Mesh& mesh, int step) {
  const Connectivity connectivity = test::edges_of(mesh);
  Mesh result = mesh;
  int edges = 0;
  for (int h = 0; h < static_cast<int>(mesh.F.size()); ++h) {
    if (connectivity.opposite[h] >= 0 || edges++ % step != 0) continue;
    const int a = halfedge_origin(mesh.F, h), b = halfedge_target(mesh.F, h);
    const int tip = static_cast<int>(result.V.rows());
    result.V.conservativeResize(tip + 1, 3);
    result.V.row(tip) = 0.55 * (mesh.V.row(a) + mesh.V.row(b));
    result.F.conservativeResize(result.F.rows() + 1, 3);
    result.F.row(result.F.rows() - 1) << b, a, tip;
  }
  return result;
}

class OverlayWithEars : public testing::TestWithParam<Landmarked> {
 protected:
  OverlayWithEars() : plain_(test::sample_mesh_for(parse_orbifold("*222"))), mesh_(with_ears(plain_, 3)) {
    const Surface surface = make_surface(plain_);
    for (const int v : choose_extremities(surface, {GetParam().inside, GetParam().on_boundary}))
      landmarks_.push_back({v, v});
    options_.cut_b.seed = 3;
    options_.embed.threads = 1;
  }

  SurfaceMap map_to(const Mesh& other) const {
    return map_between(make_surface(mesh_), make_surface(other), landmarks_, options_);
  }

  Mesh plain_, mesh_;
  std::vector<Landmark> landmarks_;
  MapOptions options_;
};

INSTANTIATE_TEST_SUITE_P(Landmarks, OverlayWithEars,
                         testing::Values(Landmarked{0, 3}, Landmarked{0, 4}, Landmarked{1, 1},
                                         Landmarked{2, 3}),
                         [](const auto& info) {
                           return std::to_string(info.param.inside) + "And" +
                                  std::to_string(info.param.on_boundary);
                         });

TEST_P(OverlayWithEars, OfASurfaceWithItselfMovesNothing) {
  const SurfaceMap map = map_to(mesh_);
  ASSERT_TRUE(map.is_bijective());
  const Embedding &a = map.a.embedding, &b = map.b.embedding;
  const Overlay both = overlay(a, b);
  EXPECT_EQ(fault_in(certify(both, a, b)), "");
  for (const OverlayFace& face : both.parents) {
    ASSERT_LT(face.a, mesh_.F.rows());
    ASSERT_LT(face.b, mesh_.F.rows());
  }
  const Points on_a = positions_on(mesh_.V, a, both.on_a), on_b = positions_on(mesh_.V, b, both.on_b);
  EXPECT_LT((on_a - on_b).rowwise().norm().maxCoeff(), 1e-7) << "inside of ears, too";
  for (const VertexMap& images : {images_of_vertices(a, b), vertex_maps(both, a, b).a_to_b}) {
    ASSERT_EQ(images.count(), mesh_.V.rows());
    EXPECT_LT((positions_on(mesh_.V, b, images.images) - mesh_.V).rowwise().norm().maxCoeff(), 1e-7);
    EXPECT_LT(images.corners.maxCoeff(), mesh_.V.rows());
  }
}

TEST_P(OverlayWithEars, OfOtherSurfacesIsCertified) {
  Mesh bent = with_ears(plain_, 5);
  bent.V.col(0) *= 1.3;
  bent.V.col(2).array() += 0.2 * bent.V.col(1).array().square();
  for (const Mesh& other : {bent, plain_}) {
    const SurfaceMap map = map_to(other);
    ASSERT_TRUE(map.is_bijective());
    const Embedding &a = map.a.embedding, &b = map.b.embedding;
    EXPECT_EQ(fault_in(certify(overlay(a, b), a, b)), "");
    EXPECT_EQ(fault_in(certify(overlay(b, a), b, a)), "");
    SurfacePoints points = {{}, Points(mesh_.F.rows(), 3), {}};
    std::mt19937 random(5);
    std::exponential_distribution<double> weight;
    for (int t = 0; t < mesh_.F.rows(); ++t) {
      const Vector3 w(weight(random), weight(random), weight(random));
      points.triangle.push_back(t);
      points.barycentric.row(t) = w.transpose() / w.sum();
    }
    const SurfacePoints back = images_of_points(b, a, images_of_points(a, b, points));
    EXPECT_LT((positions_on(mesh_.V, a, back) - positions_on(mesh_.V, a, points)).rowwise().norm().maxCoeff(),
              1e-9);
  }
}

// The inner edge of an ear is no edge of its parts.
TEST_P(OverlayWithEars, PolylinesAlongInnerEdgesStayOnThem) {
  const SurfaceMap map = map_to(mesh_);
  ASSERT_TRUE(map.is_bijective());
  const Embedding &a = map.a.embedding, &b = map.b.embedding;
  for (auto ear = static_cast<int>(plain_.F.rows()); ear < mesh_.F.rows(); ++ear) {
    const SurfacePoints path = {{ear, ear, ear}, Points(Matrix3::Identity()), {}};  // two ends and the tip
    const SurfacePoints image = image_of_polyline(a, b, path);
    const Vector3 from = mesh_.V.row(mesh_.F(ear, 0)), to = mesh_.V.row(mesh_.F(ear, 1)),
                  tip = mesh_.V.row(mesh_.F(ear, 2));
    const Points there = positions_on(mesh_.V, b, image);
    for (const auto& here : there.rowwise()) {
      const Vector3 p = here;
      const double along = (p - from).norm() + (to - p).norm() - (to - from).norm(),
                   beside = (p - to).norm() + (tip - p).norm() - (tip - to).norm();
      EXPECT_LT(std::min(along, beside), 1e-9);
    }
    EXPECT_LT((there.row(0).transpose() - from).norm(), 1e-7);
    EXPECT_LT((there.row(there.rows() - 1).transpose() - tip).norm(), 1e-7);
  }
}

TEST_P(OverlayWithEars, ThatSaysOtherThanItsPartsIsSeen) {
  const SurfaceMap map = map_to(mesh_);
  ASSERT_TRUE(map.is_bijective());
  const Embedding &a = map.a.embedding, &b = map.b.embedding;
  const Overlay good = overlay(a, b);
  Overlay bad = good;
  bad.parents[7].a = (bad.parents[7].a + 1) % 100;
  EXPECT_THAT(failed_checks(certify(bad, a, b)), Contains("ears"));
  bad = good;
  bad.on_b.barycentric.row(3) = Eigen::RowVector3d(0.2, 0.3, 0.5);
  EXPECT_THAT(failed_checks(certify(bad, a, b)), Contains("ears"));
  bad = good;
  bad.of_parts = nullptr;
  EXPECT_THAT(failed_checks(certify(bad, a, b)), Contains("ears"));
  Overlay parts = *good.of_parts;
  std::swap(parts.parents[2], parts.parents[90]);
  bad = good;
  bad.of_parts = std::make_shared<const Overlay>(parts);
  EXPECT_FALSE(certify(bad, a, b).holds);
}

}  // namespace
}  // namespace orbitutte::overlay_test
