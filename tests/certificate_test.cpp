// SPDX-License-Identifier: MIT
// Embeddings that are bijective are certified; embeddings with a planted fault are rejected by the check that
// should see it.
#include "orbitutte/verify/certificate.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <climits>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <optional>
#include <random>
#include <set>

#include "hand_made.h"
#include "orbitutte/export/tiling.h"
#include "orbitutte/inspect/recognition.h"
#include "sample_embeddings.h"

namespace orbitutte::certificate_test {
namespace {

using std::numbers::pi;
using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::UnorderedElementsAre;

using Names = std::set<std::string>;

const test::SampleEmbedding& sample(const std::string& signature) {
  return test::sample_embedding(signature);
}

Names failed_checks(const Certificate& certificate) {
  Names names;
  for (const Check& check : certificate.checks)
    if (!check.passed) names.insert(check.name);
  return names;
}

// A surface that has been judged knows its edges; the certificate says the same as of its faces alone.
void expect_the_same_of_the_judged(const Mesh& mesh, const Embedding& embedding,
                                   const Certificate& certificate) {
  const std::optional<Surface> surface = recognize_sphere_or_disk(Mesh(mesh));
  if (!surface) return;
  const Certificate other = certify(*surface, embedding);
  EXPECT_EQ(other.bijective, certificate.bijective);
  ASSERT_EQ(other.checks.size(), certificate.checks.size());
  for (std::size_t k = 0; k < other.checks.size(); ++k) {
    EXPECT_EQ(other.checks[k].name, certificate.checks[k].name);
    EXPECT_EQ(other.checks[k].passed, certificate.checks[k].passed) << other.checks[k].name;
    EXPECT_EQ(other.checks[k].detail, certificate.checks[k].detail);
  }
}

// The names of the checks that fail; also sees to it that a failure is never bijective, and always explained.
Names rejection(const Mesh& mesh, const Embedding& embedding) {
  const Certificate certificate = certify(test::unjudged(mesh), embedding);
  EXPECT_FALSE(certificate.bijective);
  for (const Check& check : certificate.checks) EXPECT_EQ(check.passed, check.detail.empty()) << check.name;
  expect_the_same_of_the_judged(mesh, embedding, certificate);
  return failed_checks(certificate);
}

// Plants a fault into the sample of this signature.
Names rejection(const std::string& signature, const std::function<void(Embedding&)>& plant) {
  Embedding embedding = sample(signature).embedding();
  plant(embedding);
  return rejection(sample(signature).mesh, embedding);
}

bool accepted(const std::string& signature, const std::function<void(Embedding&)>& change) {
  Embedding embedding = sample(signature).embedding();
  change(embedding);
  return certify(test::unjudged(sample(signature).mesh), embedding).bijective;
}

Vector3 position(const Embedding& embedding, int v) { return embedding.positions.row(v); }

// The unit normal of a reflection's plane.
Vector3 mirror_normal(const Isometry& reflection) {
  const Matrix3 twice_projection = Matrix3::Identity() - reflection.matrix();
  Eigen::Index column = 0;
  twice_projection.colwise().norm().maxCoeff(&column);
  return twice_projection.col(column).normalized();
}

std::set<int> seam_vertices(const Embedding& embedding) {
  std::set<int> result;
  for (const Seam& seam : embedding.seams) {
    result.insert(seam.left.begin(), seam.left.end());
    result.insert(seam.right.begin(), seam.right.end());
  }
  return result;
}

struct Corner {
  int face, corner;
};

// A corner of the cut mesh whose vertex, and those next to it, lie inside the tile.
Corner inner_corner(const Embedding& embedding) {
  const std::set<int> on_seams = seam_vertices(embedding);
  for (int f = static_cast<int>(embedding.triangles.rows()) / 2; f < embedding.triangles.rows(); ++f) {
    bool inside = true;
    for (const int v : embedding.triangles.row(f)) inside = inside && !on_seams.count(v);
    if (inside) return {f, 0};
  }
  ADD_FAILURE() << "every face touches a seam";
  return {0, 0};
}

// A corner at this vertex.
Corner corner_at(const Embedding& embedding, int vertex) {
  for (int f = 0; f < embedding.triangles.rows(); ++f)
    for (int k = 0; k < 3; ++k)
      if (embedding.triangles(f, k) == vertex) return {f, k};
  ADD_FAILURE() << "no face uses vertex " << vertex;
  return {0, 0};
}

// The corner's vertex, mirrored in the opposite edge of its face.
Vector3 across_opposite_edge(const Embedding& embedding, const Corner& at) {
  const auto v = embedding.triangles.row(at.face);
  const Vector3 q = position(embedding, v[(at.corner + 1) % 3]),
                r = position(embedding, v[(at.corner + 2) % 3]);
  return hand_made::reflection(q.cross(r)) * position(embedding, v[at.corner]);
}

void conjugate(Embedding& embedding, const Isometry& isometry) {
  embedding.positions = isometry.on_rows(embedding.positions);
  retract_points(embedding.space(), embedding.positions);
  for (Seam& seam : embedding.seams) seam.transform = isometry * seam.transform * isometry.inverse();
}

// Changes the entries of a seam's transform.
void change(Seam& seam, const std::function<void(Matrix3&)>& plant) {
  Matrix3 matrix = seam.transform.matrix();
  plant(matrix);
  seam.transform = hand_made::symmetry(matrix);
}

// Bijective maps

TEST(Certificate, EmbeddingsOfEveryFamilyAreBijective) {
  for (const std::string& signature : test::sample_signatures()) {
    const Certificate certificate =
        certify(test::unjudged(sample(signature).mesh), sample(signature).embedding());
    EXPECT_TRUE(certificate.bijective) << signature;
    EXPECT_THAT(failed_checks(certificate), IsEmpty()) << signature;
    expect_the_same_of_the_judged(sample(signature).mesh, sample(signature).embedding(), certificate);
    EXPECT_THAT(certificate.nonpositive_faces, IsEmpty());
    EXPECT_NEAR(certificate.expected_area, 4 * pi / sample(signature).embedding().target.group_order, 1e-15);
    EXPECT_NEAR(certificate.signed_area, certificate.expected_area, 1e-9);
    EXPECT_LT(certificate.max_seam_residual, 1e-12);
    EXPECT_NEAR(certificate.max_edge_length,
                test::edge_lengths(sample(signature).mesh, sample(signature).embedding()).maxCoeff(), 1e-15);
  }
}

TEST(Certificate, RotatingTheSphereChangesNothing) {
  const Isometry R = hand_made::symmetry(hand_made::rotation({1, -2, 0.5}, 1.1));
  for (const char* signature : {"532", "33", "*432", "*22", "3*2", "5*"})
    EXPECT_TRUE(accepted(signature, [&](Embedding& e) { conjugate(e, R); })) << signature;
}

TEST(Certificate, SeamsMayBeGivenInAnyOrderAndDirectionAndFromEitherBank) {
  for (const char* signature : {"532", "33", "*432", "3*2", "5*"}) {
    EXPECT_TRUE(accepted(signature, [](Embedding& e) { std::reverse(e.seams.begin(), e.seams.end()); }));
    EXPECT_TRUE(accepted(signature, [](Embedding& e) {
      for (Seam& seam : e.seams) {
        std::reverse(seam.left.begin(), seam.left.end());
        std::reverse(seam.right.begin(), seam.right.end());
      }
    }));
    EXPECT_TRUE(accepted(signature, [](Embedding& e) {
      for (Seam& seam : e.seams) {
        std::swap(seam.left, seam.right);
        seam.transform = seam.transform.inverse();
      }
    }));
  }
}

TEST(Certificate, ASeamMayComeInTwoPieces) {
  for (const char* signature : {"33", "*432", "3*2", "5*"}) {
    EXPECT_TRUE(accepted(signature, [](Embedding& e) {
      Seam &whole = e.seams[0], rest = whole;
      rest.left.erase(rest.left.begin());
      rest.right.erase(rest.right.begin());
      whole.left.resize(2);
      whole.right.resize(2);
      e.seams.push_back(rest);
    })) << signature;
  }
}

// Triangles that are not positive

TEST(Certificate, InnerVertexMovedAcrossAnEdgeIsSeen) {
  for (const char* signature : {"532", "223", "33", "*432", "*22", "3*2", "5*"}) {
    Embedding embedding = sample(signature).embedding();
    const Corner at = inner_corner(embedding);
    embedding.positions.row(embedding.triangles(at.face, at.corner)) =
        across_opposite_edge(embedding, at).transpose();
    EXPECT_THAT(rejection(sample(signature).mesh, embedding), Contains("positive_faces")) << signature;
    EXPECT_THAT(certify(test::unjudged(sample(signature).mesh), embedding).nonpositive_faces,
                Contains(at.face))
        << signature;
  }
}

TEST(Certificate, SeamVertexMovedAcrossAnEdgeOnBothBanksIsSeen) {
  for (const char* signature : {"532", "223", "33", "3*2", "2*5", "5*"}) {
    Embedding embedding = sample(signature).embedding();
    const Seam& seam = embedding.seams[0];
    ASSERT_GT(seam.left.size(), 2u) << signature;
    const Vector3 moved = across_opposite_edge(embedding, corner_at(embedding, seam.left[1]));
    embedding.positions.row(seam.left[1]) = moved.transpose();
    embedding.positions.row(seam.right[1]) = (seam.transform.inverse() * moved).transpose();
    const Names names = rejection(sample(signature).mesh, embedding);
    EXPECT_THAT(names, Contains("positive_faces")) << signature;
    EXPECT_EQ(names.count("seam_residual"), 0u) << signature;
  }
}

TEST(Certificate, BoundaryVertexThatOvertakesItsNeighbourOnTheMirrorIsSeen) {
  for (const char* signature : {"*432", "*22", "*55"}) {
    Embedding embedding = sample(signature).embedding();
    const std::vector<int>& mirror = embedding.seams[0].left;
    ASSERT_GT(mirror.size(), 3u);
    const Vector3 p = position(embedding, mirror[1]), q = position(embedding, mirror[2]);
    embedding.positions.row(mirror[1]) = (2 * p.dot(q) * q - p).transpose();
    const Names names = rejection(sample(signature).mesh, embedding);
    EXPECT_THAT(names, Contains("positive_faces")) << signature;
    EXPECT_EQ(names.count("seam_residual"), 0u) << signature;
  }
}

TEST(Certificate, VertexPutOntoItsNeighbourLeavesAFaceWithoutArea) {
  for (const char* signature : {"532", "33", "*432", "*22", "3*2", "5*"}) {
    Embedding embedding = sample(signature).embedding();
    const Corner at = inner_corner(embedding);
    embedding.positions.row(embedding.triangles(at.face, 0)) =
        embedding.positions.row(embedding.triangles(at.face, 1)).eval();
    EXPECT_THAT(rejection(sample(signature).mesh, embedding), Contains("positive_faces")) << signature;
    EXPECT_THAT(certify(test::unjudged(sample(signature).mesh), embedding).nonpositive_faces,
                Contains(at.face))
        << signature;
  }
}

TEST(Certificate, MirroredMapIsSeen) {
  const Isometry M = hand_made::symmetry(hand_made::reflection({1, 2, -0.7}));
  for (const char* signature : {"532", "22", "33", "*432", "*22", "3*2", "5*"}) {
    EXPECT_THAT(rejection(signature, [&](Embedding& e) { conjugate(e, M); }),
                UnorderedElementsAre("positive_faces", "signed_area", "cone_angles", "angle_sums"))
        << signature;
    EXPECT_THAT(rejection(signature, [](Embedding& e) { e.positions = -e.positions; }),
                Contains("positive_faces"))
        << signature;
    EXPECT_THAT(rejection(signature, [&](Embedding& e) { e.positions = M.on_rows(e.positions); }),
                Contains("positive_faces"))
        << signature;
  }
}

TEST(Certificate, MeshTurnedInsideOutIsSeen) {
  Mesh mesh = sample("33").mesh;
  Embedding embedding = sample("33").embedding();
  mesh.F.col(1).swap(mesh.F.col(2));
  embedding.triangles.col(1).swap(embedding.triangles.col(2));
  EXPECT_THAT(rejection(mesh, embedding),
              UnorderedElementsAre("positive_faces", "signed_area", "cone_angles", "angle_sums"));
}

// Coverings of a higher degree

// Poles 0 and 1, then rings of 30 vertices.
Mesh orange() {
  constexpr int around = 30, rings = 11;
  std::vector<Vector3> points = {Vector3::UnitZ(), -Vector3::UnitZ()};
  std::vector<std::vector<int>> triangles;
  const auto vertex = [](int ring, int i) { return 2 + ring * around + i % around; };
  for (int ring = 0; ring < rings; ++ring) {
    const double colatitude = pi * (ring + 1) / (rings + 1);
    for (int i = 0; i < around; ++i) {
      const Vector3 on_equator = hand_made::on_equator(2 * pi * i / around);
      points.push_back(std::sin(colatitude) * on_equator + std::cos(colatitude) * Vector3::UnitZ());
      if (ring == 0) triangles.push_back({0, vertex(0, i), vertex(0, i + 1)});
      if (ring + 1 == rings) {
        triangles.push_back({1, vertex(ring, i + 1), vertex(ring, i)});
        continue;
      }
      const int a = vertex(ring, i), b = vertex(ring, i + 1), c = vertex(ring + 1, i),
                d = vertex(ring + 1, i + 1);
      triangles.insert(triangles.end(), {{a, c, b}, {b, c, d}});
    }
  }
  return test::mesh(points, triangles);
}

// Every vertex at `times` its longitude in the lune, which lies between the longitudes 0 and 2 pi/N.
void wrap(Embedding& embedding, int times) {
  Isometry& T = embedding.seams[0].transform;
  const double gauge = std::atan2(position(embedding, embedding.seams[0].right[1]).y(),
                                  position(embedding, embedding.seams[0].right[1]).x());
  const double turn = std::atan2(T.matrix()(1, 0), T.matrix()(0, 0));
  const double start = turn > 0 ? gauge : gauge + turn;  // the bank with the smaller longitude
  for (int v = 0; v < embedding.positions.rows(); ++v) {
    const Vector3 p = position(embedding, v);
    if (std::hypot(p.x(), p.y()) == 0) continue;
    double longitude = std::atan2(p.y(), p.x()) - start;
    longitude -= 2 * pi * std::floor((longitude + 0.3) / (2 * pi));
    const double radius = std::hypot(p.x(), p.y());
    embedding.positions.row(v) << radius * std::cos(times * longitude), radius * std::sin(times * longitude),
        p.z();
  }
  embedding.positions.rowwise().normalize();
  T = hand_made::symmetry(hand_made::rotation(Vector3::UnitZ(), times * turn));
}

class WrappedLune : public ::testing::TestWithParam<std::pair<const char*, int>> {};

// The longitudes multiplied so that the seams' rotation still generates a group of the right order.
TEST_P(WrappedLune, IsSeenByItsAreaAndItsAngles) {
  const auto& [signature, times] = GetParam();
  const Mesh mesh = orange();
  Embedding embedding = embed(mesh, parse_orbifold(signature), {0, 1}).embedding;
  ASSERT_TRUE(certify(test::unjudged(mesh), embedding).bijective);
  wrap(embedding, times);
  EXPECT_THAT(rejection(mesh, embedding), UnorderedElementsAre("signed_area", "cone_angles"));
  EXPECT_NEAR(certify(test::unjudged(mesh), embedding).signed_area,
              times * 4 * pi / embedding.target.group_order, 1e-9);
}

INSTANTIATE_TEST_SUITE_P(Certificate, WrappedLune,
                         ::testing::Values(std::pair("33", 2), std::pair("55", 2), std::pair("55", 3),
                                           std::pair("22", 3), std::pair("33", 4)));

// The northern half of the orange, its equator in the plane of the mirror of N*.
Mesh half_orange() {
  const Mesh whole = orange();
  std::vector<int> southern;
  for (int f = 0; f < test::face_count(whole); ++f) {
    double height = 0;
    for (const int v : whole.F.row(f)) height += whole.V(v, 2);
    if (height < 0) southern.push_back(f);
  }
  return test::without_faces(whole, southern);
}

TEST(Certificate, SectorOfNWrappedTwiceIsSeenByItsAreaAndItsAngle) {
  const Mesh mesh = half_orange();
  Embedding embedding = embed(mesh, parse_orbifold("5*"), {0}).embedding;
  ASSERT_TRUE(certify(test::unjudged(mesh), embedding).bijective);
  wrap(embedding, 2);
  EXPECT_THAT(rejection(mesh, embedding), UnorderedElementsAre("signed_area", "cone_angles"));
  EXPECT_NEAR(certify(test::unjudged(mesh), embedding).signed_area, 2 * 4 * pi / embedding.target.group_order,
              1e-9);
}

TEST(Certificate, ConeClaimedOnTheWrongSideOfTheStarIsSeen) {
  // 2*3 and 3*2 differ in where the orders lie; 4*, 2*2 have groups of order 8 both.
  EXPECT_THAT(rejection("2*3", [](Embedding& e) { e.target.signature = "3*2"; }), Contains("cones"));
  EXPECT_THAT(rejection("2*2",
                        [](Embedding& e) {
                          e.target.signature = "4*";
                          e.cones.pop_back();
                          e.cones[0].mark = Mark::of_order(4, ConeKind::rotation);
                        }),
              Contains("cone_angles"));
}

TEST(Certificate, MirrorTakenForTheRotationIsSeen) {
  for (const char* signature : {"3*2", "2*5", "5*"})
    EXPECT_THAT(
        rejection(signature, [](Embedding& e) { std::swap(e.seams[0].transform, e.seams[1].transform); }),
        Contains("seam_gluing"))
        << signature;
}

TEST(Certificate, LuneOfNWrappedTwiceHasAGroupOfOrderHalfN) {
  const Mesh mesh = orange();
  Embedding embedding = embed(mesh, parse_orbifold("66"), {0, 1}).embedding;
  wrap(embedding, 2);
  EXPECT_THAT(rejection(mesh, embedding), UnorderedElementsAre("group_order", "signed_area", "cone_angles"));
  embedding.target.group_order =
      3;  // now the group's order is right for the seams, but not for the signature
  EXPECT_THAT(rejection(mesh, embedding), Contains("group_order"));
}

// The map with a further copy of the whole sphere spliced in along a slit of two edges inside the tile: all
// triangles are positive, all seams match, all cones are right; two inner vertices are wrapped twice.
test::SampleEmbedding with_a_sphere_too_many(const test::SampleEmbedding& original) {
  const Embedding& tile = original.embedding();
  const Tiling sphere = weld_copies(tile);
  const int n = test::vertex_count(original.mesh), n_cut = static_cast<int>(tile.source_vertex.size());
  const int m = test::face_count(original.mesh), added = test::vertex_count(sphere.mesh);

  // The fan of a vertex inside the tile, and the slit from its first to its third neighbour.
  const Corner inner = inner_corner(tile);
  const int middle = tile.triangles(inner.face, inner.corner);
  const Connectivity connectivity = connectivity_of(tile.triangles, n_cut);
  std::vector<int> fan;
  int h = 3 * inner.face + inner.corner;
  do {
    fan.push_back(h);
    h = connectivity.opposite[previous_halfedge(h)];
  } while (h != fan.front());
  const int u = halfedge_target(tile.triangles, fan[0]), v = halfedge_target(tile.triangles, fan[2]);

  // Vertices: the input's, the sphere's, then the copies that the cut had added.
  std::vector<int> face_in_sphere(m);
  for (int f = 0; f < test::face_count(sphere.mesh); ++f)
    if (sphere.copy[f] == 0) face_in_sphere[sphere.source_face[f]] = f;
  const auto sphere_vertex = [&](int vertex) {
    const Corner at = corner_at(tile, vertex);
    return sphere.mesh.F(face_in_sphere[at.face], at.corner);
  };
  const int middle_too = n + sphere_vertex(middle);
  test::SampleEmbedding result = original;
  Embedding& embedding = result.result.embedding;
  const auto moved = [&](int vertex) { return vertex < n ? vertex : vertex + added; };
  embedding.positions.resize(n_cut + added, 3);
  embedding.positions << tile.positions.topRows(n), sphere.mesh.V, tile.positions.bottomRows(n_cut - n);
  embedding.source_vertex.clear();
  for (int k = 0; k < n + added; ++k) embedding.source_vertex.push_back(k);
  for (int k = n; k < n_cut; ++k) embedding.source_vertex.push_back(tile.source_vertex[k]);
  embedding.triangles.resize(m + sphere.mesh.F.rows(), 3);
  embedding.triangles << tile.triangles.unaryExpr(moved), (sphere.mesh.F.array() + n).matrix();
  const int u_too = n + sphere_vertex(u), v_too = n + sphere_vertex(v);
  for (int& vertex : embedding.triangles.bottomRows(sphere.mesh.F.rows()).reshaped())
    vertex = vertex == u_too ? u : vertex == v_too ? v : vertex;
  for (const int corner : {fan[0], fan[1]}) {  // the faces on one side of the slit change places
    embedding.triangles(corner / 3, corner % 3) = middle_too;
    embedding.triangles(m + face_in_sphere[corner / 3], corner % 3) = middle;
  }
  for (Seam& seam : embedding.seams)
    for (std::vector<int>* bank : {&seam.left, &seam.right})
      std::transform(bank->begin(), bank->end(), bank->begin(), moved);
  for (ConeCopies& cone : embedding.cones)
    std::transform(cone.copies.begin(), cone.copies.end(), cone.copies.begin(), moved);

  result.mesh.V.resize(n + added, 3);
  result.mesh.V << original.mesh.V, sphere.mesh.V;
  result.mesh.F = embedding.triangles.unaryExpr([&](int vertex) { return embedding.source_vertex[vertex]; });
  return result;
}

TEST(Certificate, SphereTooManyIsSeenByItsAreaAndTheAnglesAroundTwoVertices) {
  for (const char* signature : {"22", "332", "*22", "*332", "2*3", "3*"}) {
    const test::SampleEmbedding twofold = with_a_sphere_too_many(sample(signature));
    EXPECT_THAT(rejection(twofold.mesh, twofold.embedding()),
                UnorderedElementsAre("signed_area", "angle_sums"))
        << signature;
    const Certificate certificate = certify(test::unjudged(twofold.mesh), twofold.embedding());
    EXPECT_NEAR(certificate.signed_area, certificate.expected_area + 4 * pi, 1e-9) << signature;
  }
}

// The hemisphere of 22 with a straight seam, glued not by half a turn but by the reflection that swaps the
// two banks: everything else is right, yet the two copies of the tile lie on each other.
TEST(Certificate, SeamThatFoldsTheMapIsSeen) {
  const Mesh mesh = test::octasphere(2);  // with mirrors through the cones
  Embedding embedding = embed(mesh, parse_orbifold("22"), {4, 5}).embedding;
  Seam& seam = embedding.seams[0];
  const std::size_t middle = seam.left.size() / 2;
  const Vector3 across =
      (position(embedding, seam.left[middle]) - position(embedding, seam.right[middle])).normalized();
  seam.transform = hand_made::symmetry(hand_made::rotation(Vector3::UnitZ(), pi));
  for (std::size_t k = 1; k + 1 < seam.left.size();
       ++k) {  // onto the meridian, where they are but for rounding
    const Vector3 old = position(embedding, seam.left[k]);
    const Vector3 left = (across.dot(old) * across + old.z() * Vector3::UnitZ()).normalized();
    ASSERT_LT((left - old).norm(), 1e-6);
    embedding.positions.row(seam.left[k]) = left.transpose();
    embedding.positions.row(seam.right[k]) << -left.x(), -left.y(), left.z();
  }
  ASSERT_TRUE(certify(test::unjudged(mesh), embedding).bijective);
  seam.transform = hand_made::symmetry(hand_made::reflection(across));
  EXPECT_THAT(rejection(mesh, embedding), UnorderedElementsAre("seam_gluing"));
}

// Seams, cones and signature

TEST(Certificate, SeamsThatDoNotGlueTheWholeBoundaryAreSeen) {
  for (const char* signature : {"532", "33", "*432", "*22", "3*2", "5*"}) {
    const auto seam_fault = [&](const std::function<void(Embedding&)>& plant) {
      EXPECT_THAT(rejection(signature, plant), Contains("seam_gluing")) << signature;
    };
    seam_fault([](Embedding& e) { e.seams.clear(); });
    seam_fault([](Embedding& e) { e.seams.pop_back(); });
    seam_fault([](Embedding& e) { e.seams.push_back(e.seams[0]); });
    seam_fault([](Embedding& e) { e.seams.push_back({}); });
    seam_fault([](Embedding& e) { e.seams[0].left.clear(), e.seams[0].right.clear(); });
    seam_fault([](Embedding& e) { e.seams[0].left.pop_back(); });
    seam_fault([](Embedding& e) { e.seams[0].right.clear(); });
    seam_fault([](Embedding& e) { e.seams[0].left.pop_back(), e.seams[0].right.pop_back(); });
    seam_fault([](Embedding& e) {
      e.seams[0].left.erase(e.seams[0].left.begin() + 1);
      e.seams[0].right.erase(e.seams[0].right.begin() + 1);
    });
    seam_fault([](Embedding& e) {
      e.seams[0].left.resize(1);
      e.seams[0].right.resize(1);
    });
    seam_fault([](Embedding& e) { std::reverse(e.seams[0].left.begin(), e.seams[0].left.end()); });
    seam_fault([](Embedding& e) { std::swap(e.seams[0].left[1], e.seams[0].left[2]); });
    seam_fault([](Embedding& e) {
      e.seams[0].left.push_back(e.seams[0].left.front());
      e.seams[0].right.push_back(e.seams[0].right.front());
    });
    seam_fault([](Embedding& e) {  // a bank that leaves the boundary
      const int v = e.triangles(inner_corner(e).face, 0);
      e.seams[0].left.push_back(v);
      e.seams[0].right.push_back(v);
    });
  }
}

TEST(Certificate, SeamWithTheWrongTransformIsSeen) {
  for (const char* signature : {"532", "33", "55"}) {
    const auto residual_fault = [&](const std::function<void(Embedding&)>& plant) {
      EXPECT_THAT(rejection(signature, plant), Contains("seam_residual")) << signature;
    };
    residual_fault([](Embedding& e) { e.seams[0].transform = Isometry(); });
    residual_fault([](Embedding& e) { e.seams[0].transform = e.seams[0].transform.inverse(); });
    residual_fault([](Embedding& e) { std::swap(e.seams[0].left, e.seams[0].right); });
    residual_fault([](Embedding& e) {
      e.seams[0].transform = hand_made::symmetry(hand_made::rotation({1, 2, 3}, 1e-9)) * e.seams[0].transform;
    });
    residual_fault([](Embedding& e) {
      e.positions.row(e.seams[0].left[1]) = e.positions.row(e.seams[0].left[2]).eval();
    });
  }
  EXPECT_THAT(rejection("*432",
                        [](Embedding& e) {
                          const Vector3 p = position(e, e.seams[0].left[1]);
                          const Vector3 off = p + 1e-9 * mirror_normal(e.seams[0].transform);
                          e.positions.row(e.seams[0].left[1]) = off.normalized().transpose();
                        }),
              Contains("seam_residual"));
  EXPECT_THAT(rejection("*432", [](Embedding& e) { std::swap(e.seams[0].transform, e.seams[1].transform); }),
              Contains("seam_residual"));
}

TEST(Certificate, TransformThatIsNoSymmetryIsSeen) {
  for (const char* signature : {"532", "33", "*432", "*22", "3*2", "5*"}) {
    const auto transform_fault = [&](const std::function<void(Matrix3&)>& plant) {
      EXPECT_THAT(rejection(signature, [&](Embedding& e) { change(e.seams[0], plant); }),
                  Contains("seam_transforms"))
          << signature;
    };
    transform_fault([](Matrix3& M) { M *= 1 + 1e-11; });
    transform_fault([](Matrix3& M) { M(0, 1) += 1e-9; });
    transform_fault([](Matrix3& M) { M.setZero(); });
    transform_fault([](Matrix3& M) { M(2, 2) = std::numeric_limits<double>::quiet_NaN(); });
    transform_fault([](Matrix3& M) { M(0, 0) = std::numeric_limits<double>::infinity(); });
    transform_fault([](Matrix3& M) { M(0, 0) = 1e300; });
  }
}

TEST(Certificate, MirrorThatIsNoReflectionIsSeen) {
  for (const char* signature : {"*432", "*22"}) {
    const auto mirror_fault = [&](const Matrix3& M) {
      EXPECT_THAT(rejection(signature, [&](Embedding& e) { e.seams[0].transform = hand_made::symmetry(M); }),
                  Contains("seam_transforms"))
          << signature;
    };
    mirror_fault(Matrix3::Identity());
    mirror_fault(-Matrix3::Identity());
    const Isometry& mirror = sample(signature).embedding().seams[0].transform;
    mirror_fault(-mirror.matrix());  // half a turn
    mirror_fault(mirror.matrix() * hand_made::rotation(mirror_normal(mirror), 0.3));
    mirror_fault(mirror.matrix() * hand_made::rotation(mirror_normal(mirror), 1e-4));
  }
}

TEST(Certificate, RotationReplacedByAReflectionIsSeen) {
  for (const char* signature : {"532", "33", "3*2", "5*"}) {
    EXPECT_THAT(rejection(signature,
                          [](Embedding& e) {
                            const Vector3 line =
                                position(e, e.seams[0].right.front()).cross(position(e, e.seams[0].right[1]));
                            change(e.seams[0], [&](Matrix3& M) { M = M * hand_made::reflection(line); });
                          }),
                Contains("seam_gluing"))
        << signature;
  }
}

TEST(Certificate, ConesThatTheSignatureDoesNotAskForAreSeen) {
  for (const char* signature : {"532", "33", "*432", "*22", "3*2"}) {
    const auto cone_fault = [&](const std::function<void(std::vector<ConeCopies>&)>& plant) {
      EXPECT_THAT(rejection(signature, [&](Embedding& e) { plant(e.cones); }), Contains("cones"))
          << signature;
    };
    using Cones = std::vector<ConeCopies>;
    cone_fault([](Cones& cones) { cones.clear(); });
    cone_fault([](Cones& cones) { cones.pop_back(); });
    cone_fault([](Cones& cones) { cones.push_back(cones[0]); });
    cone_fault(
        [](Cones& cones) { cones[1].mark = Mark::of_order(cones[1].mark.order() + 1, cones[1].mark.kind); });
    cone_fault([](Cones& cones) { cones[1].mark.angle *= 1 + 1e-6; });
    cone_fault([](Cones& cones) { cones[1].mark.angle = 0; });
    cone_fault([](Cones& cones) { cones[1].mark.angle = std::numeric_limits<double>::quiet_NaN(); });
    cone_fault([](Cones& cones) { cones[1].mark.kind = ConeKind::fixed; });
    cone_fault([](Cones& cones) {
      ConeKind& kind = cones[1].mark.kind;
      kind = kind == ConeKind::corner ? ConeKind::rotation : ConeKind::corner;
    });
    cone_fault([](Cones& cones) { cones[0].copies.pop_back(); });
    cone_fault([](Cones& cones) { cones[0].copies.push_back(cones[0].copies[0]); });
    cone_fault([](Cones& cones) { cones[0].copies.swap(cones[1].copies); });
    cone_fault([](Cones& cones) { cones[0].vertex = cones[1].vertex; });
  }
}

TEST(Certificate, EveryCopyOfAConeHasToBeNamed) {
  Embedding embedding = sample("532").embedding();
  for (std::size_t k = 0; k < embedding.cones.size(); ++k) {
    for (std::size_t copy = 0; copy < embedding.cones[k].copies.size(); ++copy) {
      EXPECT_THAT(
          rejection("532", [&](Embedding& e) { e.cones[k].copies.erase(e.cones[k].copies.begin() + copy); }),
          Contains("cones"));
    }
  }
}

TEST(Certificate, ConesAtTheWrongVerticesAreSeenByTheirAngles) {
  EXPECT_THAT(rejection("532",
                        [](Embedding& e) {
                          std::swap(e.cones[0].vertex, e.cones[1].vertex);
                          std::swap(e.cones[0].copies, e.cones[1].copies);
                        }),
              UnorderedElementsAre("cone_angles"));
  EXPECT_THAT(rejection("33",
                        [](Embedding& e) {
                          const int v = e.triangles(inner_corner(e).face, 0);
                          e.cones[0] = {v, Mark::of_order(3, ConeKind::rotation), {v}};
                        }),
              UnorderedElementsAre("cone_angles", "angle_sums"));
  EXPECT_THAT(rejection("33", [](Embedding& e) { e.cones[0] = e.cones[1]; }),
              UnorderedElementsAre("angle_sums"));
  EXPECT_THAT(rejection("*22",
                        [](Embedding& e) {
                          const int v = e.seams[0].left[2];
                          e.cones[0] = {v, Mark::of_order(2, ConeKind::corner), {v}};
                        }),
              UnorderedElementsAre("cone_angles", "angle_sums"));
}

TEST(Certificate, WrongGroupOrderIsSeen) {
  for (const char* signature : {"532", "33", "*432", "*22", "3*2", "5*"}) {
    const int order = sample(signature).embedding().target.group_order;
    for (const int wrong : {0, 1, -order, order / 2, order - 1, order + 1, 2 * order, INT_MAX, INT_MIN})
      EXPECT_THAT(rejection(signature, [&](Embedding& e) { e.target.group_order = wrong; }),
                  Contains("group_order"))
          << signature << " " << wrong;
  }
}

TEST(Certificate, WrongSignatureIsSeen) {
  for (const char* signature : {"532", "33", "*432", "*22", "3*2", "5*"})
    for (const char* wrong :
         {"432", "22", "*532", "*33", "352", "333", "", "*", "x", "1", "abc", "5", "2,,3", "\xff",
          "99999999999999999999", "99999,99999,99999,99999,99999,99999,99999",
          "20000,19999,19997,19993,19991,19989,19987,19983", "*20000,19999,19997,19993,19991,19989"})
      EXPECT_THAT(rejection(signature, [&](Embedding& e) { e.target.signature = wrong; }), Contains("cones"))
          << signature << " " << wrong;
  // The map of 33 with its orders called 2: the marks are those of 22, the group and the angles are not.
  EXPECT_THAT(rejection("33",
                        [](Embedding& e) {
                          e.target.signature = "22";
                          e.target.group_order = 2;
                          for (ConeCopies& cone : e.cones) cone.mark = Mark::of_order(2, cone.mark.kind);
                        }),
              UnorderedElementsAre("group_order", "cone_angles", "signed_area"));
}

// The cut mesh

TEST(Certificate, FacesThatAreNotTheInputsAreSeen) {
  for (const char* signature : {"532", "*432", "2*3"}) {
    const auto cut_fault = [&](const std::function<void(Embedding&)>& plant) {
      EXPECT_THAT(rejection(signature, plant), UnorderedElementsAre("cut_mesh")) << signature;
    };
    cut_fault([](Embedding& e) { e.triangles.row(3).swap(e.triangles.row(200)); });
    cut_fault([](Embedding& e) { std::swap(e.triangles(3, 0), e.triangles(3, 1)); });
    cut_fault(
        [](Embedding& e) { e.triangles.row(3) << e.triangles(3, 1), e.triangles(3, 2), e.triangles(3, 0); });
    cut_fault([](Embedding& e) { e.triangles(3, 0) = e.triangles(3, 1); });
    cut_fault([](Embedding& e) { e.triangles.conservativeResize(e.triangles.rows() - 1, 3); });
    cut_fault([](Embedding& e) { e.triangles.resize(0, 3); });
    cut_fault([](Embedding& e) { std::swap(e.source_vertex[1], e.source_vertex[2]); });
    cut_fault([](Embedding& e) { e.source_vertex.back() = 0, e.source_vertex[0] = 1; });
    cut_fault([](Embedding& e) { e.source_vertex.pop_back(); });
    cut_fault([](Embedding& e) { e.source_vertex.clear(); });
    cut_fault([](Embedding& e) { e.positions.conservativeResize(e.positions.rows() - 1, 3); });
    cut_fault([](Embedding& e) { e.positions.resize(0, 3); });
    cut_fault([](Embedding& e) { e = {}; });
  }
  EXPECT_THAT(rejection(sample("*432").mesh, sample("532").embedding()), UnorderedElementsAre("cut_mesh"));
  Mesh turned = sample("532").mesh;
  turned.F.row(0).swap(turned.F.row(1));
  EXPECT_THAT(rejection(turned, sample("532").embedding()), UnorderedElementsAre("cut_mesh"));
  EXPECT_THAT(rejection(Mesh(), Embedding()), Contains("seam_gluing"));
}

TEST(Certificate, UncutSphereIsSeen) {
  for (const char* signature : {"532", "33"}) {
    const Mesh& mesh = sample(signature).mesh;
    Embedding embedding = sample(signature).embedding();
    embedding.triangles = mesh.F;
    embedding.positions.conservativeResize(mesh.V.rows(), 3);
    embedding.source_vertex.resize(mesh.V.rows());
    for (ConeCopies& cone : embedding.cones) cone.copies = {cone.vertex};
    EXPECT_THAT(rejection(mesh, embedding), UnorderedElementsAre("seam_gluing"));
    embedding.seams.clear();
    EXPECT_THAT(rejection(mesh, embedding), Contains("group_order"));
    embedding.positions = mesh.V.rowwise().normalized();  // a bijection onto the sphere, and no orbifold's
    EXPECT_THAT(rejection(mesh, embedding),
                UnorderedElementsAre("cone_angles", "group_order", "signed_area"));
  }
}

// Gives the corners a vertex of their own at the same place.
void split(Embedding& embedding, const std::vector<Corner>& corners) {
  const int old = embedding.triangles(corners[0].face, corners[0].corner),
            copy = static_cast<int>(embedding.source_vertex.size());
  embedding.source_vertex.push_back(embedding.source_vertex[old]);
  embedding.positions.conservativeResize(copy + 1, 3);
  embedding.positions.row(copy) = embedding.positions.row(old).eval();
  for (const Corner& at : corners) embedding.triangles(at.face, at.corner) = copy;
}

TEST(Certificate, MeshThatIsCutOnceMoreIsSeen) {
  for (const char* signature : {"532", "33", "*432", "2*3"}) {
    // A slit of two edges inside.
    EXPECT_THAT(rejection(signature, [](Embedding& e) { split(e, {inner_corner(e)}); }),
                Contains("seam_gluing"))
        << signature;
    // A face on its own.
    EXPECT_THAT(rejection(signature,
                          [](Embedding& e) {
                            const int face = inner_corner(e).face;
                            for (int k = 0; k < 3; ++k) split(e, {{face, k}});
                          }),
                Contains("seam_gluing"))
        << signature;
    // An edge between a seam and the inside.
    EXPECT_THAT(rejection(signature, [](Embedding& e) { split(e, {corner_at(e, e.seams[0].left[1])}); }),
                Contains("seam_gluing"))
        << signature;
    // All faces on their own.
    EXPECT_THAT(rejection(signature,
                          [](Embedding& e) {
                            for (int f = 0; f < e.triangles.rows(); ++f)
                              for (int k = 0; k < 3; ++k) split(e, {{f, k}});
                          }),
                Contains("seam_gluing"))
        << signature;
  }
}

// Positions and indices that mean nothing

TEST(Certificate, PositionsOffTheSphereAreSeen) {
  for (const char* signature : {"532", "*432"}) {
    for (const double wrong :
         {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity(), 1e300, 0.0})
      EXPECT_THAT(rejection(signature, [&](Embedding& e) { e.positions(17, 1) = wrong; }),
                  UnorderedElementsAre("unit_positions"))
          << wrong;
    EXPECT_THAT(rejection(signature, [](Embedding& e) { e.positions.row(17).setZero(); }),
                UnorderedElementsAre("unit_positions"));
    EXPECT_THAT(rejection(signature, [](Embedding& e) { e.positions.row(17) *= 1 + 1e-10; }),
                UnorderedElementsAre("unit_positions"));
    EXPECT_THAT(rejection(signature, [](Embedding& e) { e.positions *= 2; }),
                UnorderedElementsAre("unit_positions"));
  }
}

TEST(Certificate, IndicesOutOfRangeAreRejectedWithoutACrash) {
  for (const char* signature : {"532", "33", "*432", "*22", "3*2", "5*"}) {
    const Embedding& good = sample(signature).embedding();
    std::mt19937 random(11);
    for (int k = 0; k < 300; ++k) {
      Embedding embedding = good;
      std::vector<int*> places = {&embedding.target.group_order};
      switch (random() % 4) {
        case 0:
          for (int& v : embedding.triangles.reshaped()) places.push_back(&v);
          break;
        case 1:
          for (int& v : embedding.source_vertex) places.push_back(&v);
          break;
        case 2:
          for (Seam& seam : embedding.seams)
            for (std::vector<int>* bank : {&seam.left, &seam.right})
              for (int& v : *bank) places.push_back(&v);
          break;
        default:
          for (ConeCopies& cone : embedding.cones) {
            places.push_back(&cone.vertex);
            for (int& v : cone.copies) places.push_back(&v);
          }
      }
      const int n_cut = static_cast<int>(good.source_vertex.size());
      const int values[] = {
          -1, n_cut, n_cut + 1, INT_MAX, INT_MIN, INT_MAX / 3, static_cast<int>(random() % n_cut)};
      for (unsigned faults = 1 + random() % 3; faults > 0; --faults) {
        int& place = *places[random() % places.size()];
        const int value = values[random() % std::size(values)];
        place = value == place ? -2 : value;
      }
      EXPECT_FALSE(certify(test::unjudged(sample(signature).mesh), embedding).bijective)
          << signature << " " << k;
    }
  }
}

// The same index everywhere: the face's, the bank's and the source's agree with each other, but not with the
// mesh.
TEST(Certificate, FaultsThatAgreeWithEachOtherAreRejectedWithoutACrash) {
  for (const int wrong : {-1, 1 << 20, INT_MAX, INT_MIN}) {
    for (const char* signature : {"33", "*432"}) {
      EXPECT_FALSE(accepted(signature, [&](Embedding& e) {
        for (Seam& seam : e.seams) seam.left[1] = seam.right[1] = wrong;
      }));
      EXPECT_FALSE(accepted(signature, [&](Embedding& e) {
        for (ConeCopies& cone : e.cones) cone.vertex = wrong, cone.copies = {wrong};
      }));
      EXPECT_FALSE(accepted(signature, [&](Embedding& e) { e.triangles.setConstant(wrong); }));
      EXPECT_FALSE(accepted(signature, [&](Embedding& e) {
        std::fill(e.source_vertex.begin(), e.source_vertex.end(), wrong);
      }));
    }
  }
}

// Angles and seams at the scale of the edges beside them

const Check& check_named(const Certificate& certificate, const std::string& name) {
  for (const Check& check : certificate.checks)
    if (check.name == name) return check;
  throw std::out_of_range(name);
}

TEST(Certificate, AnglesAroundEveryVertexAddUp) {
  for (const std::string& signature : test::all_sample_signatures()) {
    const Certificate certificate =
        certify(test::unjudged(sample(signature).mesh), sample(signature).embedding());
    const Check& check = check_named(certificate, "angle_sums");
    EXPECT_TRUE(check.passed) << signature;
    EXPECT_LT(check.value, 1e-12) << signature;
    EXPECT_EQ(check.bound, 1e-8) << signature;
  }
}

TEST(Certificate, BoundsFollowTheRoundingOfShortEdges) {
  // An edge of 1e-10 leaves angles uncertain by 1e-6; a planted error of 1e-3 there is none of rounding.
  Embedding embedding = sample("*432").embedding();
  const Corner at = inner_corner(embedding);
  const int v = embedding.triangles(at.face, 0), u = embedding.triangles(at.face, 1);
  const Vector3 p = position(embedding, v), q = position(embedding, u);
  embedding.positions.row(v) = (q + 1e-10 * (p - q)).normalized().transpose();
  const Certificate certificate = certify(test::unjudged(sample("*432").mesh), embedding);
  const Check& check = check_named(certificate, "angle_sums");
  EXPECT_TRUE(check.passed);
  EXPECT_LT(check.value, 1e-4);
}

TEST(Certificate, VertexThatLeavesItsMirrorIsSeen) {
  const auto with_step = [](double step) {
    Embedding embedding = sample("*432").embedding();
    const Seam& seam = embedding.seams[0];
    const int v = seam.left[2];
    const Vector3 off = position(embedding, v) + step * mirror_normal(seam.transform);
    embedding.positions.row(v) = off.normalized().transpose();
    return failed_checks(certify(test::unjudged(sample("*432").mesh), embedding));
  };
  EXPECT_EQ(with_step(4e-13).count("seam_residual"), 0u);
  EXPECT_EQ(with_step(6e-13).count("seam_residual"), 1u);
}

TEST(Certificate, TheDetailNamesTheOffender) {
  Embedding embedding = sample("532").embedding();
  const Corner at = inner_corner(embedding);
  split(embedding, {at});
  for (const Check& check : certify(test::unjudged(sample("532").mesh), embedding).checks)
    if (check.name == "seam_gluing") {
      EXPECT_THAT(check.detail, HasSubstr("Euler characteristic 0"));
    }
  embedding = sample("532").embedding();
  change(embedding.seams[1], [](Matrix3& M) { M *= 2; });
  for (const Check& check : certify(test::unjudged(sample("532").mesh), embedding).checks)
    if (check.name == "seam_transforms") {
      EXPECT_THAT(check.detail, HasSubstr("seam 1"));
    }
}

}  // namespace
}  // namespace orbitutte::certificate_test
