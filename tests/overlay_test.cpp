// SPDX-License-Identifier: MIT
// The overlay of two surfaces on one target, its certificate, and the maps of vertices and points.
#include "orbitutte/map/overlay.h"

#include <gmock/gmock.h>
#include <rapidcheck.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <random>
#include <set>
#include <string>
#include <vector>

#include "limb.h"
#include "orbitutte/map/overlay_certificate.h"
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
  for (std::size_t k = 0; k < a.cones.size(); ++k)
    EXPECT_EQ(transfer_labels(there, test::permutation(static_cast<int>(pair.b_mesh.V.rows()), 0)).size(),
              static_cast<std::size_t>(pair.a_mesh.V.rows()));
}

// Shapes that choose different vertices for the cuts: in the plane and in the hyperbolic plane the tile is
// the surface's own.
class OverlayOnFreeTile : public testing::TestWithParam<std::string> {};
INSTANTIATE_TEST_SUITE_P(Families, OverlayOnFreeTile, testing::Values("2222", "22222", "222222", "*2222"),
                         [](const auto& info) {
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
  const EmbedResult b = embed(mesh, target, marks, options_with_cut(1));
  ASSERT_TRUE(b.certificate.bijective);
  result = overlay(a.embedding, b.embedding);
  EXPECT_EQ(fault_in(certify(result, a.embedding, b.embedding)), "");
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

}  // namespace
}  // namespace orbitutte::overlay_test
