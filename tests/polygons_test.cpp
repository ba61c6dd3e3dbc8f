// SPDX-License-Identifier: MIT
// Meshes with faces of more than three corners: divided, embedded, certified, written and tiled.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <rapidcheck/gtest.h>

#include <Eigen/Geometry>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "orbitutte/embed.h"
#include "orbitutte/export/tiling.h"
#include "orbitutte/export/tiling_files.h"
#include "orbitutte/geometry/orientation.h"
#include "orbitutte/inspect/inspection.h"
#include "orbitutte/inspect/weak_places.h"
#include "orbitutte/io/file.h"
#include "orbitutte/io/mesh_io.h"
#include "orbitutte/io/ply.h"
#include "orbitutte/mesh/triangulation.h"
#include "orbitutte/report/embedding_file.h"
#include "orbitutte/report/report.h"
#include "orbitutte/verify/convexity.h"
#include "orbitutte/verify/energy.h"
#include "polygon_meshes.h"
#include "random_spheres.h"
#include "sample_embeddings.h"

namespace orbitutte::polygons_test {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

/// An irregular sphere or disk of polygons, whichever the orbifold needs.
PolygonMesh sample_polygons_for(const Target& orbifold) {
  if (orbifold.topology == Topology::sphere) return test::dual(test::perturbed(test::icosphere(2), 0.03, 7));
  return test::quadrangulated(test::perturbed(test::round_disk(5), 0.02, 7));
}

struct Sample {
  PolygonMesh mesh;
  EmbedResult result;
};

Sample embedded(const PolygonMesh& mesh, const std::string& signature, const EmbedOptions& options = {}) {
  const Target orbifold = parse_orbifold(signature);
  return {mesh, embed(mesh, orbifold, choose_cones(mesh, orbifold), options)};
}

Sample sample(const std::string& signature, const EmbedOptions& options = {}) {
  return embedded(sample_polygons_for(parse_orbifold(signature)), signature, options);
}

EmbedOptions uniform_weights() {
  EmbedOptions options;
  options.weights.kind = WeightKind::uniform;
  return options;
}

std::vector<int> sources(const std::vector<int>& cut_vertices, const Embedding& embedding) {
  std::vector<int> result;
  for (const int v : cut_vertices) result.push_back(embedding.source_vertex[v]);
  return result;
}

std::string failures(const Certificate& certificate) {
  std::string text;
  for (const Check& check : certificate.checks)
    if (!check.passed) text += check.name + ": " + check.detail + "; ";
  return text;
}

const Check& check_named(const Certificate& certificate, const std::string& name) {
  static const Check none = {"no such check", false, 0, 0, {}};
  for (const Check& check : certificate.checks)
    if (check.name == name) return check;
  return none;
}

bool all_corners_turn_left(const Embedding& embedding) {
  const FaceView faces = embedding.faces();
  const Points& X = embedding.positions;
  for (int f = 0; f < faces.count(); ++f) {
    const std::span<const int> v = faces[f];
    for (std::size_t k = 0, d = v.size(); k < d; ++k)
      if (orientation_sign(X.row(v[k]), X.row(v[(k + 1) % d]), X.row(v[(k + 2) % d])) <= 0) return false;
  }
  return true;
}

// --- triangulation

TEST(Triangulation, SquareGetsTheShorterDiagonal) {
  const PolygonMesh kite = test::polygon_mesh({{-3, 0, 0}, {0, -1, 0}, {3, 0, 0}, {0, 1, 0}}, {{0, 1, 2, 3}});
  Triangles expected(2, 3);
  expected << 1, 2, 3, 3, 0, 1;
  EXPECT_EQ(triangulate(kite), expected);
}

TEST(Triangulation, TrianglesOfAPolygonThatBendsInwardsDoNotOverlap) {
  const PolygonMesh arrow = test::polygon_mesh({{0, 0, 0}, {4, -3, 0}, {1, 0, 0}, {4, 3, 0}}, {{0, 1, 2, 3}});
  const Triangles F = triangles_on_vertices(triangulate(arrow), arrow.corners);
  for (const auto& f : F.rowwise()) {
    const Vector3 a = arrow.V.row(f[0]), b = arrow.V.row(f[1]), c = arrow.V.row(f[2]);
    EXPECT_GT((b - a).cross(c - a).z(), 0);
  }
}

RC_GTEST_PROP(Triangulation, CoversEveryConvexPolygonOnce, ()) {
  const int n = *rc::gen::inRange(3, 40);
  PolygonMesh mesh = test::prism(n);
  for (double& x : mesh.V.leftCols<1>().reshaped()) x *= 3;
  const Surface surface = make_surface(mesh);
  const Triangles& F = surface.triangles;
  RC_ASSERT(F.rows() == static_cast<Eigen::Index>(mesh.corners.size()) - 2 * mesh.face_count());
  RC_ASSERT(surface.polygons_on(F).corners == mesh.corners);
  double bottom = 0;
  for (int t = 0; t < n - 2; ++t) {
    const Vector3 a = mesh.V.row(F(t, 0)), b = mesh.V.row(F(t, 1)), c = mesh.V.row(F(t, 2));
    const double twice = -(b - a).cross(c - a).z();
    RC_ASSERT(twice > 0);
    bottom += 0.5 * twice;
  }
  RC_ASSERT(std::abs(bottom - 1.5 * n * std::sin(2 * std::numbers::pi / n)) < 1e-12);
}

TEST(Triangulation, EdgesAreThoseOfThePolygons) {
  const PolygonMesh mesh = test::dual(test::icosahedron());
  const Triangles division = triangulate(mesh);
  const Connectivity connectivity = connectivity_of(mesh, division);
  EXPECT_EQ(connectivity.edges.size(), 30u);
  EXPECT_TRUE(std::is_sorted(connectivity.edges.begin(), connectivity.edges.end()));
  const Triangles F = triangles_on_vertices(division, mesh.corners);
  int diagonals = 0;
  for (int h = 0; h < static_cast<int>(F.size()); ++h) {
    const int other = connectivity.opposite[h];
    ASSERT_GE(other, 0);
    EXPECT_EQ(connectivity.opposite[other], h);
    EXPECT_EQ(halfedge_origin(F, other), halfedge_target(F, h));
    EXPECT_EQ(connectivity.edge_of[other], connectivity.edge_of[h]);
    if (connectivity.edge_of[h] >= 0) continue;
    EXPECT_EQ(h / 9, other / 9);  // three triangles a pentagon
    ++diagonals;
  }
  EXPECT_EQ(diagonals, 2 * 2 * 12);
}

TEST(Triangulation, OfTrianglesIsTheTrianglesThemselves) {
  const Mesh mesh = test::icosphere(1);
  const PolygonMesh polygons = to_polygon_mesh(mesh);
  EXPECT_EQ(triangles_on_vertices(triangulate(polygons), polygons.corners), mesh.F);
}

// --- embedding

class PolygonsOfEveryFamily : public testing::TestWithParam<std::string> {};

TEST_P(PolygonsOfEveryFamily, BecomeConvexAndKeepTheirOrder) {
  for (const EmbedOptions& options : {EmbedOptions(), uniform_weights()}) {
    const auto [mesh, result] = sample(GetParam(), options);
    EXPECT_EQ(result.minimum.termination, Termination::converged);
    EXPECT_TRUE(result.certificate.bijective) << failures(result.certificate);
    EXPECT_TRUE(check_named(result.certificate, "convex_faces").passed);
    EXPECT_EQ(result.embedding.polygons.start, mesh.face_start);
    EXPECT_EQ(sources(result.embedding.polygons.corners, result.embedding), mesh.corners);
    EXPECT_THAT(result.warnings, IsEmpty());
    EXPECT_TRUE(all_corners_turn_left(result.embedding));
  }
}

TEST_P(PolygonsOfEveryFamily, EnergyIsThatOfTheirEdges) {
  const auto [mesh, result] = sample(GetParam());
  const Surface surface = make_surface(mesh);
  EXPECT_EQ(result.weights.w.size(), static_cast<Eigen::Index>(surface.connectivity.edges.size()));
  EXPECT_NEAR(dirichlet_energy(surface, result.weights, result.embedding), result.minimum.energy,
              1e-10 * result.minimum.energy);
}

TEST_P(PolygonsOfEveryFamily, AreTiledIntoAClosedSphere) {
  const auto [mesh, result] = sample(GetParam());
  const Tiling tiling = weld_copies(result.embedding);
  EXPECT_EQ(tiling.polygons.count(), mesh.face_count() * result.embedding.target.group_order);
  const PolygonMesh polygons = {tiling.mesh.V, tiling.polygons.corners, tiling.polygons.start};
  EXPECT_EQ(inspect(polygons).topology, Topology::sphere);
  EXPECT_EQ(inspect(tiling.mesh).topology, Topology::sphere);
}

INSTANTIATE_TEST_SUITE_P(Polygons, PolygonsOfEveryFamily,
                         testing::Values("532", "432", "332", "223", "2,2,12", "22", "55", "*532", "*432",
                                         "*332", "*225", "*33", "3*2", "2*3", "2*12", "3*", "12*"),
                         [](const auto& info) {
                           std::string name = info.param;
                           for (char& c : name) c = c == '*' ? 's' : c == ',' ? '_' : c;
                           return name;
                         });

TEST(Polygons, ProjectivePlanesAreEmbeddedWithFacesTurnedWhereTheyDisagree) {
  const PolygonMesh mesh = test::quadrangulated(test::projective_plane(1));
  for (const std::string signature : {"1x", "3x"}) {
    const auto [unused, result] = embedded(mesh, signature, uniform_weights());
    EXPECT_TRUE(result.certificate.bijective) << failures(result.certificate);
    EXPECT_TRUE(all_corners_turn_left(result.embedding));
    EXPECT_EQ(inspect(weld_copies(result.embedding).mesh).topology, Topology::sphere);
    const FaceView faces = result.embedding.faces();
    int turned = 0;
    for (int f = 0; f < faces.count(); ++f) {
      const std::vector<int> source = sources({faces[f].begin(), faces[f].end()}, result.embedding);
      const std::vector<int> face = test::face_lists(mesh)[f];
      if (source == face) continue;
      EXPECT_EQ(source, (std::vector<int>{face[0], face[3], face[2], face[1]}));
      ++turned;
    }
    EXPECT_GT(turned, 0);
  }
}

TEST(Polygons, RegularSolidsAreEmbedded) {
  for (const PolygonMesh& mesh :
       {test::cube(), test::dual(test::icosahedron()), test::prism(7), test::pyramid(6)}) {
    const auto [unused, result] = embedded(mesh, "332");
    EXPECT_TRUE(result.certificate.bijective) << failures(result.certificate);
  }
}

TEST(Polygons, FacesOfManyCornersAreEmbedded) {
  const PolygonMesh mesh = test::prism(300);
  const EmbedResult result = embed(mesh, parse_orbifold("432"), {0, 100, 500});
  EXPECT_TRUE(result.certificate.bijective) << failures(result.certificate);
  const std::string bytes = serialize_embedding(result.embedding);
  EXPECT_EQ(parse_mesh(bytes, MeshFormat::ply).corners, result.embedding.polygons.corners);
  const PolygonMesh tiled = parse_mesh(ply_bytes(weld_copies(result.embedding)), MeshFormat::ply);
  EXPECT_EQ(inspect(tiled).topology, Topology::sphere);
}

RC_GTEST_PROP(Polygons, DualsOfRandomTriangulationsAreEmbedded, ()) {
  const Mesh mesh = test::random_sphere(*rc::gen::arbitrary<std::uint32_t>(), *rc::gen::inRange(0, 15));
  const PolygonMesh polygons = test::dual(mesh);
  RC_ASSERT(find_weak_places(polygons).empty());
  const std::vector<int> order =
      test::permutation(polygons.vertex_count(), *rc::gen::arbitrary<std::uint32_t>());
  const EmbedResult result =
      embed(polygons, parse_orbifold("432"), {order[0], order[1], order[2]}, uniform_weights());
  if (!result.certificate.bijective) RC_FAIL(failures(result.certificate));
}

TEST(Polygons, StandardWeightsAreCotangents) {
  EmbedOptions cotan;
  cotan.weights.kind = WeightKind::cotan;
  const EmbedResult standard = sample("432").result;
  EXPECT_EQ(standard.weights.kind, WeightKind::cotan);
  EXPECT_EQ(standard.embedding.positions, sample("432", cotan).result.embedding.positions);
}

TEST(Polygons, TrianglesGivenAsPolygonsAreEmbeddedToTheSameBytes) {
  for (const std::string signature : {"432", "*33", "2*3"}) {
    const test::SampleEmbedding& expected = test::sample_embedding(signature);
    EmbedOptions options;
    options.threads = 1;
    options.weights.kind = WeightKind::cotan;
    const PolygonMesh mesh = to_polygon_mesh(expected.mesh);
    const Target orbifold = parse_orbifold(signature);
    EXPECT_EQ(choose_cones(mesh, orbifold), expected.marks);
    const EmbedResult result = embed(mesh, orbifold, expected.marks, options);
    EXPECT_EQ(serialize_embedding(result.embedding), serialize_embedding(expected.embedding()));
    EXPECT_EQ(result.embedding.polygons.count(), 0);
  }
}

Eigen::VectorXd polygon_edge_lengths(const PolygonMesh& mesh, const Embedding& embedding) {
  const Connectivity connectivity = connectivity_of(mesh, triangulate(mesh));
  Eigen::VectorXd lengths(static_cast<Eigen::Index>(connectivity.edges.size()));
  for (int h = 0; h < static_cast<int>(embedding.triangles.size()); ++h)
    if (const int e = connectivity.edge_of[h]; e >= 0)
      lengths[e] = Space::sphere().distance(embedding.positions.row(halfedge_origin(embedding.triangles, h)),
                                            embedding.positions.row(halfedge_target(embedding.triangles, h)));
  return lengths;
}

TEST(Polygons, CutChangesNoLength) {
  for (const std::string signature : {"532", "3*2", "22"}) {
    const Sample first = sample(signature);
    const Eigen::VectorXd expected = polygon_edge_lengths(first.mesh, first.result.embedding);
    for (const std::uint64_t seed : {1, 2, 3, 4}) {
      EmbedOptions options;
      options.cut.seed = seed;
      const Sample other = sample(signature, options);
      EXPECT_TRUE(other.result.certificate.bijective);
      const Eigen::VectorXd lengths = polygon_edge_lengths(other.mesh, other.result.embedding);
      EXPECT_LT((lengths - expected).cwiseAbs().maxCoeff(), 1e-8);
    }
  }
}

TEST(Polygons, SolverForManyEmbeddingsGivesTheSame) {
  const PolygonMesh mesh = sample_polygons_for(parse_orbifold("432"));
  EmbeddingSolver solver(mesh);
  for (const std::vector<int>& marks : {std::vector<int>{0, 50, 100}, {0, 50, 200}, {7, 50, 100}}) {
    const EmbedResult result = solver.embed(parse_orbifold("432"), marks);
    EXPECT_TRUE(result.certificate.bijective);
    EXPECT_EQ(serialize_embedding(result.embedding),
              serialize_embedding(embed(mesh, parse_orbifold("432"), marks).embedding));
  }
}

TEST(Polygons, WeightsFileNamesTheirEdgesAndNoDiagonals) {
  const PolygonMesh mesh = test::cube();
  const std::string path = (std::filesystem::temp_directory_path() / "orbitutte_cube_weights.txt").string();
  std::ofstream(path)
      << "0 1 1\n1 2 1\n2 3 1\n3 0 1\n4 5 1\n5 6 1\n6 7 1\n7 4 1\n0 4 1\n1 5 1\n2 6 1\n3 7 1\n";
  EmbedOptions options;
  options.weights_file = path;
  const EmbedResult result = embed(mesh, parse_orbifold("332"), {0, 2, 5}, options);
  EXPECT_TRUE(result.certificate.bijective);
  EXPECT_THAT(result.warnings, IsEmpty());
  std::ofstream(path, std::ios::app) << "0 2 1\n";
  EXPECT_THROW(embed(mesh, parse_orbifold("332"), {0, 2, 5}, options), MeshError);
  std::filesystem::remove(path);
}

TEST(Polygons, CotangentsOfSquaresAreOne) {
  const EdgeWeights weights = edge_weights(make_surface(test::square_grid(4, 3)), {WeightKind::cotan});
  for (int e = 0; e < weights.w.size(); ++e)
    EXPECT_TRUE(weights.w[e] == 1 || weights.w[e] == 0.5) << weights.w[e];
  EXPECT_EQ(weights.clamped_edges, 0);
}

TEST(Polygons, DefectsAreNamed) {
  PolygonMesh mesh = test::cube();
  std::swap(mesh.corners[0], mesh.corners[2]);
  std::swap(mesh.corners[0], mesh.corners[2]);
  mesh.corners[1] = mesh.corners[0];
  EXPECT_THROW(embed(mesh, parse_orbifold("332"), {0, 2, 5}), MeshError);
}

// --- straight corners

TEST(Polygons, CornerOfADiskThatIsNotMarkedLiesStraightOnItsMirror) {
  const PolygonMesh mesh = test::square_grid(6, 6);  // vertex 6 is the corner that is not marked
  const EmbedResult result = embed(mesh, parse_orbifold("*432"), {0, 48, 42});
  EXPECT_TRUE(result.certificate.bijective) << failures(result.certificate);
  EXPECT_THAT(result.warnings, IsEmpty());
}

TEST(Polygons, VertexOfTwoEdgesLiesStraightBetweenItsNeighbours) {
  const PolygonMesh mesh = test::with_edge_divided(test::dual(test::icosahedron()), 0, 1);
  const EmbedResult result = embed(mesh, parse_orbifold("332"), {5, 10, 15});
  EXPECT_TRUE(result.certificate.bijective) << failures(result.certificate);
  ASSERT_EQ(result.warnings.size(), 1u);
  EXPECT_THAT(result.warnings[0], HasSubstr("vertex 20 has edges only to the vertices"));
  const Points& X = result.embedding.positions;
  const Vector3 normal = Vector3(X.row(0)).cross(Vector3(X.row(1))).normalized();
  EXPECT_LT(std::abs(normal.dot(X.row(20))), 1e-8);
}

TEST(Polygons, FaceWithAllEdgesButOneOnAMirrorIsReportedAndRounded) {
  PolygonMesh mesh = test::square_grid(6, 6);
  for (const auto& [v, w] : {std::pair(5, 6), {6, 13}}) mesh = test::with_edge_divided(mesh, v, w);
  // The square at the corner 6 without its inner vertex: it leans on the chord (5, 13).
  std::vector<std::vector<int>> faces = test::face_lists(mesh);
  for (std::vector<int>& face : faces) {
    if (std::count(face.begin(), face.end(), 6)) std::erase(face, 12);
  }
  faces.push_back({5, 13, 12});
  mesh = test::polygon_mesh(test::point_list(mesh.V), faces);
  ASSERT_THAT(inspect(mesh).defects, IsEmpty());
  const EmbedResult result = embed(mesh, parse_orbifold("*432"), {0, 48, 42});
  ASSERT_FALSE(result.warnings.empty());
  EXPECT_THAT(result.warnings[0], HasSubstr("all edges but one lie on one mirror"));
  EXPECT_TRUE(result.certificate.bijective) << failures(result.certificate);
}

TEST(Polygons, PartBehindAChordOnOneMirrorMustCollapseAndIsReportedSo) {
  // Two more rows of squares upon the side from 0 to 6, which hang on by the edge (2, 4) alone.
  PolygonMesh mesh = test::square_grid(6, 6);
  std::vector<Vector3> points = test::point_list(mesh.V);
  std::vector<std::vector<int>> faces = test::face_lists(mesh);
  const int n = mesh.vertex_count();
  for (const double x : {2.0, 3.0, 4.0}) points.emplace_back(x, -1, 0);
  for (std::vector<int>& face : faces)
    if (std::count(face.begin(), face.end(), 3)) std::erase(face, 3);
  faces[2].push_back(0), faces[2] = {2, 4, 11, 10, 9};
  faces.erase(faces.begin() + 3);
  faces.insert(faces.end(), {{2, n, n + 1, 3}, {3, n + 1, n + 2, 4}, {2, 3, 4}});
  mesh = test::polygon_mesh(points, faces);
  ASSERT_THAT(inspect(mesh).defects, IsEmpty());
  const EmbedResult result = embed(mesh, parse_orbifold("*432"), {6, 48, 42});
  EXPECT_EQ(result.minimum.termination, Termination::converged);
  if (result.certificate.bijective) return;  // by luck in the last digits
  ASSERT_FALSE(result.warnings.empty());
  EXPECT_THAT(result.warnings.back(), HasSubstr("no solver can do better"));
  const int m = mesh.face_count();
  EXPECT_THAT(collapsing_faces(FaceView(mesh.corners, mesh.face_start), {{0, 1, 2, n, n + 1, n + 2, 4, 5, 6}},
                               {6, 48, 42}),
              ElementsAre(m - 3, m - 2, m - 1));
}

// --- certificate

class Faults : public testing::Test {
 protected:
  Sample sample_ = sample("432");
  Embedding& embedding() { return sample_.result.embedding; }
  Certificate judged() { return certify(test::unjudged(sample_.mesh), embedding()); }

  // A face that no seam touches.
  int inner_face() {
    std::vector<char> on_seam(embedding().source_vertex.size(), 0);
    for (const Seam& seam : embedding().seams)
      for (const std::vector<int>* bank : {&seam.left, &seam.right})
        for (const int v : *bank) on_seam[v] = 1;
    const FaceView faces = embedding().faces();
    for (int f = 0; f < faces.count(); ++f)
      if (std::none_of(faces[f].begin(), faces[f].end(), [&](int v) { return on_seam[v] != 0; })) return f;
    return -1;
  }
};

TEST_F(Faults, NoneIsSeenWhereThereIsNone) { EXPECT_TRUE(judged().bijective) << failures(judged()); }

TEST_F(Faults, VertexPushedIntoAFaceMakesItConcave) {
  const int f = inner_face();
  const std::vector<int> face(embedding().faces()[f].begin(), embedding().faces()[f].end());
  Vector3 middle = Vector3::Zero();
  for (const int v : face) middle += embedding().positions.row(v);
  middle.normalize();
  const Vector3 p = embedding().positions.row(face[0]);
  embedding().positions.row(face[0]) = (0.1 * p + 0.9 * middle).normalized();
  const Certificate certificate = judged();
  EXPECT_FALSE(certificate.bijective);
  EXPECT_FALSE(check_named(certificate, "convex_faces").passed);
  EXPECT_TRUE(check_named(certificate, "positive_faces").passed) << failures(certificate);
  EXPECT_THAT(certificate.nonpositive_faces, testing::Contains(f));
}

TEST_F(Faults, VertexMovedAcrossAFaceIsSeen) {
  const int f = inner_face();
  const std::span<const int> face = embedding().faces()[f];
  const Vector3 p = embedding().positions.row(face[0]), q = embedding().positions.row(face[face.size() / 2]);
  embedding().positions.row(face[0]) = (q + 0.5 * (q - p)).normalized();
  const Certificate certificate = judged();
  EXPECT_FALSE(certificate.bijective);
  EXPECT_FALSE(check_named(certificate, "positive_faces").passed);
}

TEST_F(Faults, PolygonTurnedOverIsSeen) {
  Polygons& polygons = embedding().polygons;
  std::reverse(polygons.corners.begin() + polygons.start[5], polygons.corners.begin() + polygons.start[6]);
  EXPECT_EQ(check_named(judged(), "cut_mesh").detail, "face 5 is not the input's face 5, cut");
}

TEST_F(Faults, PolygonThatBeginsAtAnotherCornerIsSeen) {
  Polygons& polygons = embedding().polygons;
  const auto begin = polygons.corners.begin() + polygons.start[5];
  std::rotate(begin, begin + 1, polygons.corners.begin() + polygons.start[6]);
  EXPECT_FALSE(judged().bijective);
}

TEST_F(Faults, PolygonThatIsMissingIsSeen) {
  Polygons& polygons = embedding().polygons;
  polygons.start.pop_back();
  polygons.corners.resize(polygons.start.back());
  EXPECT_FALSE(check_named(judged(), "cut_mesh").passed);
}

TEST_F(Faults, MirroredMapIsSeen) {
  embedding().positions.col(2) *= -1;
  EXPECT_FALSE(judged().bijective);
}

TEST_F(Faults, MeshTurnedInsideOutIsSeen) {
  for (int f = 0; f < embedding().polygons.count(); ++f) {
    for (std::vector<int>* corners : {&embedding().polygons.corners, &sample_.mesh.corners})
      std::reverse(corners->begin() + sample_.mesh.face_start[f],
                   corners->begin() + sample_.mesh.face_start[f + 1]);
  }
  const Certificate certificate = judged();
  EXPECT_FALSE(certificate.bijective);
  EXPECT_EQ(static_cast<int>(certificate.nonpositive_faces.size()), sample_.mesh.face_count());
}

// --- files

TEST(PolygonFiles, EmbeddingReadsBackAsItIs) {
  const auto [mesh, result] = sample("*432");
  const std::string path = (std::filesystem::temp_directory_path() / "orbitutte_polygons.ply").string();
  write_file(path, serialize_embedding(result.embedding));
  Embedding read = read_embedding(path);
  EXPECT_EQ(read.polygons.corners, result.embedding.polygons.corners);
  EXPECT_EQ(read.polygons.start, result.embedding.polygons.start);
  EXPECT_EQ(read.positions, result.embedding.positions);
  EXPECT_EQ(read.source_vertex, result.embedding.source_vertex);
  read.target = result.embedding.target;
  read.placement = result.embedding.placement;
  read.seams = result.embedding.seams;
  read.cones = result.embedding.cones;
  EXPECT_TRUE(certify(test::unjudged(mesh), read).bijective);
  EXPECT_EQ(inspect(weld_copies(read).mesh).topology, Topology::sphere);
  EXPECT_THAT(report_json(result, RunRecord()), HasSubstr(fmt::format("\"faces\": {}", mesh.face_count())));
  std::filesystem::remove(path);
}

TEST(PolygonFiles, TilingKeepsThePolygons) {
  const auto [mesh, result] = sample("*432");
  const Tiling tiling = weld_copies(result.embedding);
  const PolygonMesh ply = parse_mesh(ply_bytes(tiling), MeshFormat::ply);
  const PolygonMesh obj = parse_mesh(obj_text(tiling, "t.mtl"), MeshFormat::obj);
  EXPECT_EQ(ply.corners, tiling.polygons.corners);
  EXPECT_EQ(obj.corners, tiling.polygons.corners);
  EXPECT_EQ(obj.V, ply.V);
  const PlyFile file = parse_ply(ply_bytes(tiling));
  const std::vector<double>& source = file.find("face")->find("source_face")->values;
  const std::vector<double>& tile = file.find("face")->find("tile")->values;
  for (int f = 0; f < tiling.polygons.count(); ++f) {
    EXPECT_EQ(source[f], f % mesh.face_count());
    EXPECT_EQ(tile[f], f / mesh.face_count());
  }
}

}  // namespace
}  // namespace orbitutte::polygons_test
