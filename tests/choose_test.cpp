// SPDX-License-Identifier: MIT
#include "orbitutte/choose.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <random>
#include <set>

#include "orbitutte/cones/search.h"
#include "orbitutte/io/mesh_io.h"
#include "orbitutte/orbifold/signature.h"
#include "orbitutte/report/choices.h"
#include "orbitutte/samples/sample.h"
#include "sample_embeddings.h"

namespace orbitutte {
namespace {

std::shared_ptr<const Surface> shared_surface(const Mesh& mesh) {
  return std::make_shared<const Surface>(make_surface(mesh));
}

const std::shared_ptr<const Surface>& figure() {
  static const auto surface = shared_surface(sample_mesh({SampleShape::figure, 4000}));
  return surface;
}

const std::shared_ptr<const Surface>& mask() {
  static const auto surface = shared_surface(sample_mesh({SampleShape::mask, 4000}));
  return surface;
}

const BestEmbedding& best_of_figure() {
  static const BestEmbedding best = embed_best(figure());
  return best;
}

TEST(Choose, TheBestIsCertifiedAndDistortsLessThanExtremities) {
  const Target usual = parse_orbifold("432");
  const EmbedResult before = embed(*figure(), usual, choose_cones(*figure(), usual));
  const BestEmbedding& best = best_of_figure();
  EXPECT_TRUE(best.result.certificate.bijective);
  EXPECT_LT(best.result.distortion.sigma, 0.95 * before.distortion.sigma);
}

TEST(Choose, TheTableHasEveryFamilyOnceTheBestFirst) {
  const std::vector<Choice>& rows = best_of_figure().choices;
  EXPECT_EQ(rows.size(), 5u);
  for (std::size_t k = 1; k < rows.size(); ++k)
    EXPECT_LE(rows[k - 1].predicted->sigma, rows[k].predicted->sigma);
  EXPECT_EQ(choose(mask(), {}, 0).size(), 8u);
}

TEST(Choose, WhatIsPredictedIsWhatIsFound) {
  for (const Choice& row : choose(figure(), {}, 3))
    if (row.solved) EXPECT_NEAR(row.predicted->sigma, row.solved->sigma, 0.03) << row.target.signature;
}

TEST(Choose, TheSameComesOutEveryTime) {
  const BestEmbedding again = embed_best(figure());
  EXPECT_EQ(again.choice().cones, best_of_figure().choice().cones);
  EXPECT_EQ(again.choice().target.signature, best_of_figure().choice().target.signature);
  ChooseOptions one_thread;
  one_thread.embed.threads = 1;
  EXPECT_EQ(embed_best(figure(), one_thread).choice().cones, again.choice().cones);
}

// Vertices at one, two, four and eight rings from a cone.
std::vector<int> around(const Surface& surface, int cone) {
  const Neighbors graph = vertex_neighbors(surface.connectivity.edges, surface.vertex_count());
  std::vector<int> distance(surface.vertex_count(), -1), queue = {cone}, result;
  distance[cone] = 0;
  for (std::size_t k = 0; k < queue.size(); ++k) {
    const int v = queue[k];
    const bool is_wanted = distance[v] == 1 || distance[v] == 2 || distance[v] == 4 || distance[v] == 8;
    if (is_wanted && v % 7 == 0) result.push_back(v);
    for (int e = graph.start[v]; e < graph.start[v + 1] && distance[v] < 8; ++e)
      if (distance[graph.neighbor[e]] < 0) {
        distance[graph.neighbor[e]] = distance[v] + 1;
        queue.push_back(graph.neighbor[e]);
      }
  }
  return result;
}

TEST(Choose, NoConeIsBetterNearby) {
  const BestEmbedding& best = best_of_figure();
  EmbeddingSolver solver(figure());
  for (std::size_t k = 0; k < best.choice().cones.size(); ++k)
    for (const int v : around(*figure(), best.choice().cones[k])) {
      std::vector<int> cones = best.choice().cones;
      if (std::find(cones.begin(), cones.end(), v) != cones.end()) continue;
      cones[k] = v;
      EXPECT_GT(solver.embed(best.choice().target, cones).distortion.sigma,
                0.98 * best.result.distortion.sigma)
          << k << ": " << v;
    }
}

// A ball with bumps, on which a descent from few starts ends in local minima.
Mesh bumpy_ball(std::uint32_t seed) {
  std::mt19937 random(seed);
  const auto number = [&](double from, double to) { return from + (to - from) * (random() / 4294967296.0); };
  Mesh mesh = test::icosphere(4);
  Eigen::VectorXd radius = Eigen::VectorXd::Ones(mesh.V.rows());
  for (int bump = 0; bump < 6; ++bump) {
    const Vector3 top = Vector3(number(-1, 1), number(-1, 1), number(-1, 1)).normalized();
    const double height = number(0.2, 0.6), steepness = number(2, 6);
    for (Eigen::Index v = 0; v < mesh.V.rows(); ++v)
      radius[v] += height * std::exp(-steepness * (mesh.V.row(v).transpose() - top).squaredNorm());
  }
  for (Eigen::Index v = 0; v < mesh.V.rows(); ++v)
    mesh.V.row(v) = (radius[v] * mesh.V.row(v)).cwiseProduct(Eigen::RowVector3d(1.5, 1, 0.8));
  return mesh;
}

// Of every ordered triple of the vertices, by the closed form.
double least_sigma(ScaleField& field, const Target& target, const std::vector<int>& vertices) {
  double least = 1e300;
  for (const int a : vertices)
    for (const int b : vertices)
      for (const int c : vertices)
        if (a != b && b != c && c != a) least = std::min(least, field.sigma({target, {a, b, c}}));
  return least;
}

TEST(Choose, NoTripleOfFarVerticesIsClearlyBetter) {
  for (const std::uint32_t seed : {1, 2, 3, 4}) {
    const auto surface = shared_surface(bumpy_ball(seed));
    const Target base = parse_orbifold("222");
    const EmbedResult map = embed(*surface, base, choose_cones(*surface, base));
    const std::vector<FaceDistortion> faces = measure_triangles(*surface, map.embedding);
    const std::vector<int> order = order_in_space(*surface);
    const OrbifoldChart chart(map.embedding);
    const VertexStars stars(*surface);
    const KnownMap known = {*surface, map.embedding, faces, order};
    ScaleField some(chart, stars, scale_samples(known, 600, {})),
        all(some, scale_samples(known, 1 << 30, {}));
    ChooseOptions options;
    options.target = parse_orbifold("432");
    const Choice best = choose(surface, options, 0).front();
    const double least = least_sigma(some, best.target, spread_candidates(*surface, {}, 22).inside);
    EXPECT_LT(all.sigma({best.target, best.cones}), 1.02 * least) << seed;
  }
}

double best_sigma(const std::shared_ptr<const Surface>& surface, const std::string& signature) {
  ChooseOptions options;
  options.target = parse_orbifold(signature);
  return embed_best(surface, options).result.distortion.sigma;
}

// Its scale is an estimate, which coarse meshes make larger than it is.
TEST(Choose, TwoConesAreTakenWhereTheirMapDistortsClearlyLess) {
  const auto expect_taken = [](const std::shared_ptr<const Surface>& surface, const std::string& name) {
    EXPECT_LE(embed_best(surface).result.distortion.sigma, 1.02 * best_sigma(surface, "22")) << name;
  };
  for (const double stretch : {2.0, 3.5}) {
    Mesh mesh = test::icosphere(3);
    mesh.V.col(0) *= stretch;
    expect_taken(shared_surface(mesh), fmt::format("stretched by {}", stretch));
  }
  const std::string man = std::string(ORBITUTTE_SHARED_DIR) + "/meshes/my_man_maxp.off";
  if (std::filesystem::exists(man)) expect_taken(shared_surface(to_triangle_mesh(read_mesh(man))), man);
}

TEST(Choose, KeepsTheSymbolAndTheVerticesThatAreGiven) {
  ChooseOptions options;
  options.target = parse_orbifold("432");
  EXPECT_EQ(embed_best(figure(), options).choice().target.signature, "432");
  options.cones = {best_vertex, 17, best_vertex};
  const Choice kept = embed_best(figure(), options).choice();
  EXPECT_EQ(kept.target.signature, "432");
  EXPECT_EQ(kept.cones[1], 17);
}

TEST(Choose, AVertexThatIsGivenStandsWhereItWasGivenWhateverItsOrder) {
  ChooseOptions options;
  options.cones = {17, best_vertex, best_vertex};
  for (const Choice& row : choose(figure(), options, 0)) {
    EXPECT_EQ(row.cones.size(), 3u);
    EXPECT_EQ(row.cones[0], 17) << row.target.signature;
    EXPECT_EQ(row.target.marks.size(), 3u);
  }
  options.cones = {17, best_vertex};
  const std::vector<Choice> two = choose(figure(), options, 0);
  ASSERT_EQ(two.size(), 1u);
  EXPECT_EQ(two[0].target.marks.size(), 2u);
}

TEST(Choose, OrdersAloneMayBeChosen) {
  ChooseOptions options;
  options.cones = choose_cones(*figure(), parse_orbifold("222"));
  const Choice best = embed_best(figure(), options).choice();
  EXPECT_EQ(best.cones, options.cones);
}

TEST(Choose, OtherObjectivesHaveLessOfWhatTheyAreNamedAfter) {
  ChooseOptions options;
  options.target = parse_orbifold("432");
  const ScaleSummary by_sigma = *choose(figure(), options, 0).front().predicted;
  options.objective = Objective::range;
  EXPECT_LE(choose(figure(), options, 0).front().predicted->range, by_sigma.range * 1.001);
  options.objective = Objective::symmetric_dirichlet;
  EXPECT_LE(choose(figure(), options, 0).front().predicted->symmetric_dirichlet,
            by_sigma.symmetric_dirichlet * 1.001);
}

TEST(Choose, DisksAndProjectivePlanesHaveABestToo) {
  EXPECT_TRUE(embed_best(mask()).result.certificate.bijective);
  const BestEmbedding plane = embed_best(shared_surface(test::projective_plane(2)));
  EXPECT_TRUE(plane.result.certificate.bijective);
  EXPECT_EQ(plane.choice().target.marks.size(), 1u);
}

// Nothing is predicted there, so all choices are embedded.
TEST(Choose, TheTableOfAProjectivePlaneHasEverySymbolOnceTheBestFirst) {
  const std::vector<Choice> rows = choose(shared_surface(test::projective_plane(2)), {}, 1);
  ASSERT_GT(rows.size(), 1u);
  std::set<std::string> symbols;
  for (std::size_t k = 0; k < rows.size(); ++k) {
    EXPECT_TRUE(symbols.insert(rows[k].target.signature).second) << rows[k].target.signature;
    ASSERT_TRUE(rows[k].solved);
    if (k > 0 && rows[k].is_certified) EXPECT_LE(rows[k - 1].solved->sigma, rows[k].solved->sigma);
  }
}

TEST(Choose, OnlyFiniteGroupsAreChosenFromUnlessATargetIsGiven) {
  for (const Choice& row : best_of_figure().choices) EXPECT_GT(row.target.group_order, 0);
  ChooseOptions options;
  options.target = parse_orbifold("442");
  EXPECT_EQ(choose(figure(), options, 0).front().target.signature, "442");
}

TEST(Choose, SmallMeshesHaveOne) {
  for (const Mesh& mesh : {test::octahedron(), test::icosahedron()})
    EXPECT_TRUE(embed_best(shared_surface(mesh)).result.certificate.bijective);
}

TEST(Choose, WhatCannotBeIsRefusedInASentence) {
  ChooseOptions options;
  options.cones = {1000000, best_vertex, best_vertex};
  EXPECT_THROW(embed_best(figure(), options), MeshError);
  options.cones = {5, 5, best_vertex};
  EXPECT_THROW(embed_best(figure(), options), MeshError);
  options.cones = {1, 2, 3, 4};
  EXPECT_THROW(embed_best(figure(), options), MeshError);
  options.cones = {best_vertex, best_vertex};
  options.target = parse_orbifold("432");
  EXPECT_THROW(embed_best(figure(), options), MeshError);
  options.target = parse_orbifold("*432");
  options.cones = {};
  EXPECT_THROW(embed_best(figure(), options), MeshError);
}

TEST(Choose, TheReportNamesTheChoice) {
  const std::string report = report_json(best_of_figure(), {});
  EXPECT_NE(report.find("\"choice\""), std::string::npos);
  EXPECT_NE(report.find("\"taken\""), std::string::npos);
  EXPECT_EQ(parse_report(report).signature, best_of_figure().choice().target.signature);
  EXPECT_EQ(
      report_json(BestEmbedding{Objective::sigma, {}, 0, best_of_figure().result}, {}).find("\"choice\""),
      std::string::npos);
}

}  // namespace
}  // namespace orbitutte
