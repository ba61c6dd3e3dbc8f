// SPDX-License-Identifier: MIT
#include "orbitutte/map/surface_map.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>

#include "orbitutte/cones/extremities.h"
#include "orbitutte/cut/cut.h"
#include "orbitutte/inspect/recognition.h"
#include "orbitutte/io/landmark_file.h"
#include "orbitutte/map/vertex_map.h"
#include "orbitutte/orbifold/polygon.h"
#include "orbitutte/samples/sample.h"
#include "sample_embeddings.h"
#include "test_meshes.h"

namespace orbitutte::surface_map_test {
namespace {

Mesh irregular_sphere() { return test::perturbed(test::icosphere(2), 0.03, 7); }

// The same combinatorics, stretched and bent.
Mesh stretched_sphere() {
  Mesh mesh = irregular_sphere();
  mesh.V.col(0) *= 1.3;
  mesh.V.col(2).array() += 0.2 * mesh.V.col(0).array().square();
  return mesh;
}

Mesh bent_disk() { return test::sample_mesh_for(parse_orbifold("*432")); }

std::vector<Landmark> same_vertices(const std::vector<int>& vertices) {
  std::vector<Landmark> landmarks;
  for (const int v : vertices) landmarks.push_back({v, v});
  return landmarks;
}

std::vector<Landmark> spread_landmarks(const Surface& surface, int inside, int on_boundary) {
  return same_vertices(choose_extremities(surface, {inside, on_boundary}));
}

// The largest difference between the lengths of an edge in both embeddings.
double difference(const Mesh& mesh, const EmbedResult& first, const EmbedResult& second) {
  return (test::edge_lengths(mesh, first.embedding) - test::edge_lengths(mesh, second.embedding))
      .cwiseAbs()
      .maxCoeff();
}

std::string refusal(const Surface& a, const Surface& b, const std::vector<Landmark>& landmarks) {
  try {
    map_between(a, b, landmarks);
  } catch (const MeshError& error) {
    return error.what();
  }
  return "";
}

class LandmarksOnSpheres : public testing::TestWithParam<int> {};
INSTANTIATE_TEST_SUITE_P(Count, LandmarksOnSpheres, testing::Values(3, 4, 5, 6, 8, 10));

TEST_P(LandmarksOnSpheres, GiveTwoCertifiedEmbeddingsIntoOneTile) {
  const Surface a = make_surface(irregular_sphere()), b = make_surface(stretched_sphere());
  const std::vector<Landmark> landmarks = spread_landmarks(a, GetParam(), 0);
  const SurfaceMap map = map_between(a, b, landmarks);
  EXPECT_TRUE(map.is_bijective());
  const Points on_a = map.a.embedding.canonical_positions(), on_b = map.b.embedding.canonical_positions();
  ASSERT_EQ(map.a.embedding.cones.size(), landmarks.size());
  for (std::size_t k = 0; k < landmarks.size(); ++k) {
    const int v = map.a.embedding.cones[k].vertex, w = map.b.embedding.cones[k].vertex;
    EXPECT_EQ(v, w) << "landmarks of one mesh, in one order";
    EXPECT_LT((on_a.row(v) - on_b.row(w)).norm(), 1e-9) << k;
  }
}

TEST_P(LandmarksOnSpheres, MapASurfaceToItselfByTheIdentityWhicheverTheCuts) {
  const Mesh mesh = irregular_sphere();
  const Surface surface = make_surface(mesh);
  MapOptions options;
  options.cut_b.seed = 5;
  const SurfaceMap map = map_between(surface, surface, spread_landmarks(surface, GetParam(), 0), options);
  EXPECT_TRUE(map.is_bijective());
  EXPECT_LT(difference(mesh, map.a, map.b), 1e-7);
}

TEST_P(LandmarksOnSpheres, AreMappedAlikeWhicheverTheTourOrWarned) {
  if (GetParam() < 4) return;
  const Mesh mesh = irregular_sphere();
  const Surface a = make_surface(mesh), b = make_surface(stretched_sphere());
  const std::vector<Landmark> landmarks = spread_landmarks(a, GetParam(), 0);
  const SurfaceMap shortest = map_between(a, b, landmarks);
  MapOptions options;
  for (int k = 0; k < GetParam(); ++k)
    options.tour.push_back((2 * k) % GetParam() + (2 * k >= GetParam() && GetParam() % 2 == 0));
  const SurfaceMap other = map_between(a, b, landmarks, options);
  EXPECT_TRUE(other.is_bijective());
  for (const SurfaceMap* map : {&shortest, &other}) {
    EXPECT_EQ(map->map_class.tile, TileShape::shared) << map->warnings.front();
    if (!map->warnings.empty()) GTEST_SKIP() << map->warnings.front();
  }
  EXPECT_LT(difference(mesh, shortest.a, other.a), 1e-6)
      << other.map_class.distance << " " << shortest.map_class.distance;
  EXPECT_LT(difference(mesh, shortest.b, other.b), 1e-6);
}

TEST_P(LandmarksOnSpheres, MayHaveARegularTile) {
  const Surface a = make_surface(irregular_sphere()), b = make_surface(stretched_sphere());
  MapOptions options;
  options.tile = TileShape::regular;
  const SurfaceMap map = map_between(a, b, spread_landmarks(a, GetParam(), 0), options);
  EXPECT_TRUE(map.is_bijective());
}

// Conformal maps of both sides, and so as even as can be.
TEST_P(LandmarksOnSpheres, ShareATileUpToTheirConformalShapes) {
  const Surface a = make_surface(irregular_sphere());
  MapOptions options;
  options.cut_b.seed = 5;
  const SurfaceMap map = map_between(a, a, spread_landmarks(a, GetParam(), 0), options);
  for (const EmbedResult* side : {&map.a, &map.b})
    EXPECT_LT(side->minimum.energy / (2 * target_area(map.target())), 1.2);
}

struct OnDisk {
  int inside, on_boundary;
};

class LandmarksOnDisks : public testing::TestWithParam<OnDisk> {};
INSTANTIATE_TEST_SUITE_P(Places, LandmarksOnDisks,
                         testing::Values(OnDisk{0, 3}, OnDisk{0, 4}, OnDisk{0, 6}, OnDisk{1, 1}, OnDisk{1, 3},
                                         OnDisk{2, 2}),
                         [](const auto& info) {
                           return std::to_string(info.param.inside) + "_inside_" +
                                  std::to_string(info.param.on_boundary) + "_on_the_boundary";
                         });

TEST_P(LandmarksOnDisks, GiveTwoCertifiedEmbeddingsIntoOneTile) {
  Mesh bent = bent_disk();
  bent.V.col(2).array() += 0.3 * bent.V.col(0).array();
  bent.V.col(0) *= 1.2;
  const Surface a = make_surface(bent_disk()), b = make_surface(bent);
  const SurfaceMap map = map_between(a, b, spread_landmarks(a, GetParam().inside, GetParam().on_boundary));
  EXPECT_TRUE(map.is_bijective());
  const Points on_a = map.a.embedding.canonical_positions(), on_b = map.b.embedding.canonical_positions();
  for (const ConeCopies& cone : map.a.embedding.cones)
    EXPECT_LT((on_a.row(cone.vertex) - on_b.row(cone.vertex)).norm(), 1e-9) << cone.vertex;
}

// The vertices of a boundary, or those inside, that are nearest to some vertices of another mesh.
std::vector<Landmark> nearest_partners(const Mesh& a, const Mesh& b, const std::vector<int>& vertices,
                                       int inside) {
  const Connectivity connectivity = test::edges_of(b);
  std::vector<char> on_boundary(b.V.rows(), 0);
  for (int h = 0; h < static_cast<int>(b.F.size()); ++h)
    if (connectivity.opposite[h] < 0) on_boundary[b.F.data()[h]] = 1;
  std::vector<Landmark> landmarks;
  for (int k = 0; k < static_cast<int>(vertices.size()); ++k) {
    int nearest = -1;
    double least = 1e300;
    for (int v = 0; v < b.V.rows(); ++v) {
      const double away = (b.V.row(v) - a.V.row(vertices[k])).norm();
      if ((on_boundary[v] != 0) == (k < inside) || away >= least) continue;
      nearest = v;
      least = away;
    }
    landmarks.push_back({vertices[k], nearest});
  }
  return landmarks;
}

// Along one of these tours the flat tile of A is not found.
TEST(LandmarksOnMasks, AreMappedAlikeWhicheverTheTour) {
  const Mesh a_mesh = sample_mesh({SampleShape::mask, 4000}), other = sample_mesh({SampleShape::mask, 3000});
  const std::vector<Landmark> landmarks = nearest_partners(a_mesh, other, {1668, 1671, 484, 235, 264}, 3);
  Mesh bent = other;
  bent.V.col(0) *= 1.3;
  bent.V.col(2).array() += 0.2 * other.V.col(1).array().square();
  const Surface a = make_surface(a_mesh), b = make_surface(bent);
  MapOptions options;
  const SurfaceMap shortest = map_between(a, b, landmarks, options);
  ASSERT_TRUE(shortest.is_bijective());
  options.tour = {0, 1, 2};
  do {
    const SurfaceMap map = map_between(a, b, landmarks, options);
    EXPECT_TRUE(map.is_bijective());
    EXPECT_LT(difference(a_mesh, shortest.a, map.a), 1e-6);
    EXPECT_LT(difference(bent, shortest.b, map.b), 1e-6);
  } while (std::next_permutation(options.tour.begin(), options.tour.end()));
}

// Many faces of such a crumpled disk are thin; those that come out turned over are repaired.
TEST(LandmarksOnCrumpledDisks, MapThemToThemselvesByTheIdentityWhicheverTheCuts) {
  constexpr int rings = 12, on_boundary = 3 * rings * (rings - 1) + 1;
  for (const std::uint32_t roughness : {1, 2, 3}) {
    Mesh mesh = test::perturbed(test::round_disk(rings), 1.2 / rings, roughness);
    mesh.V.col(2) *= 0.2;
    const Surface surface = make_surface(mesh);
    MapOptions options;
    options.cut_b.seed = 5;
    const SurfaceMap map = map_between(surface, surface, {{0, 0}, {on_boundary, on_boundary}}, options);
    EXPECT_TRUE(map.is_bijective());
    EXPECT_FALSE(map.a.moved_vertices.empty()) << "nothing was repaired";
    EXPECT_EQ(map.a.moved_vertices, map.b.moved_vertices);
    const SurfacePoints images = images_of_vertices(map.a.embedding, map.b.embedding).images;
    for (int v = 0; v < mesh.V.rows(); ++v) {
      Vector3 image = Vector3::Zero();
      for (int k = 0; k < 3; ++k)
        image += images.barycentric(v, k) * mesh.V.row(mesh.F(images.triangle[v], k)).transpose();
      EXPECT_LT((image - mesh.V.row(v).transpose()).norm(), 1e-6) << v;
    }
  }
}

// Both surfaces are cut and factorised at the same time.
TEST(Landmarks, GiveTheSameMapOnEveryRunAndForAnyNumberOfThreads) {
  const Mesh mesh = sample_mesh({SampleShape::figure, 20000});
  const Surface surface = make_surface(mesh);
  std::vector<Landmark> landmarks;
  for (const int v : {0, 2500, 5000, 7500}) landmarks.push_back({v, v});
  MapOptions options;
  options.embed.threads = 1;
  const SurfaceMap first = map_between(surface, surface, landmarks, options);
  options.embed.threads = 2;
  for (int run = 0; run < 4; ++run) {
    const SurfaceMap map = map_between(surface, surface, landmarks, options);
    EXPECT_EQ(map.a.embedding.positions, first.a.embedding.positions);
    EXPECT_EQ(map.b.embedding.positions, first.b.embedding.positions);
  }
}

TEST(Landmarks, ThatMakeNoSenseAreNamed) {
  const Surface sphere = make_surface(irregular_sphere()), disk = make_surface(bent_disk());
  EXPECT_EQ(refusal(sphere, disk, {{0, 0}, {1, 1}, {2, 2}}),
            "surface A is a sphere, but surface B is a disk; a map between them needs two of one topology");
  EXPECT_EQ(refusal(sphere, sphere, {{0, 0}, {7, 9}, {20, 9}}),
            "landmarks 1 and 2 are both vertex 9 of B; give each a vertex of its own");
  EXPECT_EQ(refusal(sphere, sphere, {{0, 0}, {-1, 9}, {20, 3}}),
            "landmark 1 is vertex -1 of A, which has the vertices 0 to 161");
  EXPECT_NE(refusal(sphere, sphere, {{0, 0}, {7, 9}}).find("2 landmarks between two spheres"),
            std::string::npos);
}

TEST(Landmarks, OnADiskMustLieOnOneSideAndInOneOrder) {
  const Surface disk = make_surface(bent_disk());
  const std::vector<char> is_outer = disk.boundary_vertices();
  std::vector<int> outer, inner;
  for (int v = 0; v < disk.vertex_count(); ++v) (is_outer[v] ? outer : inner).push_back(v);
  EXPECT_NE(refusal(disk, disk, {{outer[0], outer[0]}, {outer[3], inner[0]}, {outer[5], outer[5]}})
                .find("landmark 1 lies on the boundary of A"),
            std::string::npos);
  EXPECT_NE(refusal(disk, disk, {{outer[0], outer[0]}}).find("1 landmark on the boundary and 0 inside"),
            std::string::npos);
  const std::vector<int> four = choose_extremities(disk, {0, 4});
  const std::string crossed =
      refusal(disk, disk, {{four[0], four[0]}, {four[1], four[2]}, {four[2], four[1]}, {four[3], four[3]}});
  EXPECT_NE(crossed.find("meets the landmarks in the order"), std::string::npos) << crossed;
}

TEST(Landmarks, AreReadFromListsAndFiles) {
  const std::vector<Landmark> list = parse_landmarks("12:7,300:512");
  ASSERT_EQ(list.size(), 2);
  EXPECT_EQ(list[1].a, 300);
  EXPECT_EQ(list[1].b, 512);
  EXPECT_THROW(parse_landmarks("12:7,300"), ArgumentError);
  EXPECT_THROW(parse_landmarks("12:7,a:4"), ArgumentError);
  EXPECT_TRUE(is_landmark_list("12:7"));
  EXPECT_FALSE(is_landmark_list("C:/landmarks.txt"));
}

TEST(CutAlongTour, MeetsTheMarksInTheirOrder) {
  const Surface surface = make_surface(irregular_sphere());
  const std::vector<int> marks = choose_extremities(surface, {6, 0});
  const CutMesh cut = cut_along_tour(surface, marks, 6);
  EXPECT_EQ(cut.arrangement, (std::vector<int>{0, 1, 2, 3, 4, 5}));
  EXPECT_EQ(cut.sides.size(), 10) << "five there and five back";
}

TEST(MapWithoutLandmarks, BetweenTwoSpheresIsAGuess) {
  const Surface a = make_surface(stretched_sphere());
  Mesh turned = stretched_sphere();
  const Matrix3 turn = Eigen::AngleAxisd(1.1, Vector3(1, 2, -0.5).normalized()).toRotationMatrix();
  turned.V = (turned.V * turn.transpose()).eval();
  const Surface b = make_surface(turned);
  const SurfaceMap map = map_between(a, b, {});
  EXPECT_TRUE(map.is_bijective());
  ASSERT_EQ(map.warnings.size(), 1);
  EXPECT_NE(map.warnings[0].find("guess"), std::string::npos);
  const Points on_a = map.a.embedding.canonical_positions(), on_b = map.b.embedding.canonical_positions();
  EXPECT_LT((on_a - on_b).rowwise().norm().mean(), 0.2) << "the figure has few features";
}

}  // namespace
}  // namespace orbitutte::surface_map_test
