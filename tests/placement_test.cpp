// SPDX-License-Identifier: MIT
// One placement: maps of one mesh with the same marks are the same map, wherever the cut runs.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "orbitutte/map/point_map.h"
#include "orbitutte/orbifold/symmetry_group.h"
#include "sample_embeddings.h"

namespace orbitutte::placement_test {
namespace {

// Every family, those with a free order for N = 2, 3 and 5.
std::vector<std::string> signatures_of_all_families() {
  std::vector<std::string> result;
  for (const FamilyDescription& family : families()) {
    const bool is_free = family.family.find('N') != std::string::npos;
    for (const char N : is_free ? std::string("235") : std::string("2")) {
      std::string signature = family.family;
      std::replace(signature.begin(), signature.end(), 'N', N);
      result.push_back(signature);
    }
  }
  return result;
}

class Placement : public testing::TestWithParam<std::string> {
 protected:
  static constexpr std::uint64_t seeds = 20;

  void SetUp() override {
    target_ = parse_orbifold(GetParam());
    mesh_ = test::sample_mesh_for(target_);
    marks_ = choose_cones(mesh_, target_);
  }

  EmbedResult embedded(std::uint64_t seed) const {
    EmbedOptions options;
    options.threads = 1;
    options.tolerance = 1e-11;
    options.cut.seed = seed;
    return embed(mesh_, target_, marks_, options);
  }

  Target target_;
  Mesh mesh_;
  std::vector<int> marks_;
};

INSTANTIATE_TEST_SUITE_P(AllFamilies, Placement, testing::ValuesIn(signatures_of_all_families()),
                         [](const auto& info) {
                           std::string name = info.param;
                           if (const std::size_t at = name.find('*'); at != std::string::npos)
                             name.replace(at, 1, "star");
                           return name;
                         });

// The largest distance of a vertex's position from the nearest image of its position in the other result.
double largest_difference(const Embedding& one, const Embedding& other, int vertices) {
  const std::vector<Isometry> group = group_of(one, 200).elements();
  const Points X = one.canonical_positions(), Y = other.canonical_positions();
  double largest = 0;
  for (int v = 0; v < vertices; ++v) {
    const Vector3 x = X.row(v), y = Y.row(v);
    double least = (x - y).norm();
    for (const Isometry& g : group) least = std::min(least, (g * x - y).norm());
    largest = std::max(largest, least);
  }
  return largest;
}

// How far the vertices of the mesh come back from where they are, through the other result, at the most.
double largest_miss(const Mesh& mesh, const Embedding& one, const Embedding& other) {
  const int n = test::vertex_count(mesh);
  const SurfacePoints found = PointLocator(other).locate(one.canonical_positions().topRows(n));
  double largest = 0;
  for (int v = 0; v < n; ++v) {
    if (found.triangle[v] < 0) return std::numeric_limits<double>::infinity();
    Vector3 back = Vector3::Zero();
    for (int k = 0; k < 3; ++k)
      back += found.barycentric(v, k) * mesh.V.row(mesh.F(found.triangle[v], k)).transpose();
    largest = std::max(largest, (back - mesh.V.row(v).transpose()).norm());
  }
  return largest;
}

TEST_P(Placement, TheMapOfAMeshToItselfIsTheIdentityForEveryCut) {
  const EmbedResult first = embedded(0);
  ASSERT_TRUE(first.certificate.bijective);
  for (std::uint64_t seed = 1; seed < seeds; ++seed) {
    const EmbedResult other = embedded(seed);
    ASSERT_TRUE(other.certificate.bijective) << seed;
    EXPECT_LT(largest_difference(first.embedding, other.embedding, test::vertex_count(mesh_)), 1e-8) << seed;
  }
}

// The corners of faces that are turned over, where the surface has no orientation, change places.
TEST_P(Placement, VerticesAreLocatedWhereTheyAreInAnyOtherResult) {
  if (target_.topology == Topology::projective_plane) return;
  const EmbedResult first = embedded(0);
  for (const std::uint64_t seed : {3, 8, 13}) {
    const EmbedResult other = embedded(seed);
    EXPECT_LT(largest_miss(mesh_, first.embedding, other.embedding), 1e-5) << seed;
    EXPECT_LT(largest_miss(mesh_, other.embedding, first.embedding), 1e-5) << seed;
  }
}

// What the test above would see: the maps are not the same once the marks are exchanged.
TEST_P(Placement, ExchangedMarksAreSeen) {
  if (marks_.size() < 3) return;
  const EmbedResult first = embedded(0);
  std::swap(marks_[1], marks_.back());  // boundaries meet marks in their order or against it
  EXPECT_GT(largest_difference(first.embedding, embedded(0).embedding, test::vertex_count(mesh_)), 1e-3);
}

TEST_P(Placement, IsTheIdentityWhereNothingIsSmall) {
  const Embedding embedding = embedded(1).embedding;
  EXPECT_TRUE(embedding.placement.is_identity());
  EXPECT_EQ(embedding.canonical_positions(), embedding.positions);
}

TEST_P(Placement, SeamsAreElementsOfTheTargetsGroup) {
  const Embedding embedding = embedded(2).embedding;
  const SymmetryGroup group = group_of(embedding, 200);
  for (const Seam& seam : embedding.seams) EXPECT_GE(group.find(seam.transform), 0);
}

// Marks lie where the target has them, whatever the cut.
TEST_P(Placement, MarkZeroHasAnImageAtTheOrigin) {
  if (marks_.empty()) return;
  for (const std::uint64_t seed : {0, 5, 11}) {
    const Embedding embedding = embedded(seed).embedding;
    const std::vector<Isometry> group = group_of(embedding, 200).elements();
    const Vector3 mark = embedding.canonical_positions().row(marks_[0]);
    EXPECT_TRUE(std::any_of(group.begin(), group.end(),
                            [&](const Isometry& g) { return (g * mark - Space::origin()).norm() < 1e-9; }));
  }
}

// --- a limb that is resolved in another frame

// A sphere with a long thin finger, on which the map shrinks below what doubles resolve elsewhere.
Mesh fingered_sphere() {
  Mesh mesh = test::perturbed(test::icosphere(3), 0.01, 5);
  const Vector3 tip = mesh.V.row(7).transpose().normalized();
  for (int v = 0; v < test::vertex_count(mesh); ++v) {
    const Vector3 p = mesh.V.row(v);
    const double along = p.normalized().dot(tip);
    if (along > 0.93) mesh.V.row(v) += 40 * (along - 0.93) / 0.07 * tip.transpose();
  }
  return mesh;
}

TEST(PlacedElsewhere, CanonicalPositionsAreThoseOfTheCanonicalFrame) {
  for (const char* signature : {"432", "33", "442"}) {
    const Target target = parse_orbifold(signature);
    const Mesh mesh = fingered_sphere();
    std::vector<int> marks = {0, 3, 8};
    marks.resize(target.marks.size());
    EmbedOptions options;
    options.threads = 1;
    const EmbedResult result = embed(mesh, target, marks, options);
    const Embedding& embedding = result.embedding;
    const SymmetryGroup group = group_of(embedding, 200);
    for (const Seam& seam : embedding.seams) EXPECT_GE(group.find(seam.transform), 0) << signature;
    EXPECT_LE((embedding.placement.on_rows(embedding.canonical_positions()) - embedding.positions)
                  .cwiseAbs()
                  .maxCoeff(),
              1e-13);
  }
}

}  // namespace
}  // namespace orbitutte::placement_test
