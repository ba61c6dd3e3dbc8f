// SPDX-License-Identifier: MIT
#include "orbitutte/cones/scale_field.h"

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "orbitutte/cones/search.h"
#include "orbitutte/embed.h"
#include "orbitutte/io/mesh_io.h"
#include "orbitutte/orbifold/signature.h"
#include "orbitutte/samples/sample.h"
#include "sample_embeddings.h"

namespace orbitutte {
namespace {

// A surface, its map to 222 or *222, and the scale of all others.
struct Known {
  explicit Known(const Mesh& mesh)
      : surface(make_surface(mesh)),
        solver(mesh, {}),
        base(surface.topology == Topology::disk ? "*222" : "222"),
        map(solver.embed(parse_orbifold(base), choose_cones(surface, parse_orbifold(base)))),
        faces(measure_triangles(surface, map.embedding)),
        order(order_in_space(surface)),
        chart(map.embedding),
        neighbors(vertex_neighbors(surface.connectivity.edges, surface.vertex_count())),
        stars(surface) {}

  KnownMap known() const { return {surface, map.embedding, faces, order}; }
  ScaleField field(int count) const { return {chart, stars, scale_samples(known(), count, {})}; }

  Surface surface;
  EmbeddingSolver solver;
  std::string base;
  EmbedResult map;
  std::vector<FaceDistortion> faces;
  std::vector<int> order;
  OrbifoldChart chart;
  Neighbors neighbors;
  VertexStars stars;
};

const Known& figure() {
  static const Known known(sample_mesh({SampleShape::figure, 20000}));
  return known;
}

const Known& mask() {
  static const Known known(sample_mesh({SampleShape::mask, 20000}));
  return known;
}

constexpr int all = 1 << 30;

// Is the triangle almost similar to its images, so that the surface is fine enough there?
bool is_fine(const FaceDistortion& known, const FaceDistortion& solved) {
  constexpr double enough = 1.1;
  return known.angle < enough && solved.angle < enough;
}

enum class Where { everywhere, where_fine };

// The predicted u less the solved one: the root of the mean square over the area.
double error_of(const Known& known, const MarkedTarget& choice, const Embedding& solved,
                Where where = Where::everywhere) {
  const std::vector<FaceDistortion> faces = measure_triangles(known.surface, solved);
  ScaleField field = known.field(all);
  const std::vector<double> u = field.log_scale(choice);
  double squares = 0, weight = 0;
  std::size_t k = 0;
  for (const int f : known.order) {
    if (!(known.faces[f].area > 0)) continue;
    const double difference = u[k++] - 0.5 * std::log(faces[f].area);
    if (!(faces[f].area > 0)) continue;
    if (where == Where::where_fine && !is_fine(known.faces[f], faces[f])) continue;
    squares += faces[f].share * difference * difference;
    weight += faces[f].share;
  }
  return std::sqrt(squares / weight);
}

// Other cones than those of the map that the scale comes from.
std::vector<int> other_cones(const Known& known, const Target& target) {
  std::vector<int> cones = choose_cones(known.surface, target);
  if (target.inner_marks != 1 && cones.size() > 1) std::rotate(cones.begin(), cones.begin() + 1, cones.end());
  if (target.topology == Topology::sphere)
    cones[0] = known.neighbors.neighbor[known.neighbors.start[cones[0]]];
  return cones;
}

// How far off the prediction may be.
struct Bounds {
  double rms = 0, sigma = 0;
};

void expect_prediction(const Known& known, const std::string& signature, const Bounds& bounds) {
  const Target target = parse_orbifold(signature);
  const MarkedTarget choice = {target, other_cones(known, target)};
  EmbeddingSolver solver(std::make_shared<const Surface>(known.surface));
  const EmbedResult solved = solver.embed(target, choice.cones);
  ASSERT_TRUE(solved.certificate.bijective) << signature;
  EXPECT_LT(error_of(known, choice, solved.embedding), bounds.rms) << signature;
  EXPECT_NEAR(known.field(all).summary(choice).sigma, solved.distortion.sigma, bounds.sigma) << signature;
}

constexpr Bounds fine = {0.015, 0.01};

TEST(ScaleField, KnowsTheScaleOfMapsOfASphereWithThreeCones) {
  for (const std::string signature : {"222", "432", "532", "332", "223"})
    expect_prediction(figure(), signature, fine);
}

TEST(ScaleField, KnowsTheScaleOfMapsOfADisk) {
  for (const std::string signature : {"*222", "*432", "*223", "3*2", "2*2", "2*3", "2*", "3*"})
    expect_prediction(mask(), signature, fine);
}

TEST(ScaleField, IsThatOfMapsOfRealMeshesWhereTheyAreFine) {
  const std::string folder = std::string(ORBITUTTE_SHARED_DIR) + "/meshes/";
  if (!std::filesystem::exists(folder)) GTEST_SKIP() << "no real meshes here: " << folder << " is missing";
  for (const std::string file : {"itokawa.off", "spot.obj", "face.obj"}) {
    const Known known(to_triangle_mesh(read_mesh(folder + file)));
    for (const std::string signature : {"222", "432", "223"}) {
      const Target target = parse_orbifold((known.surface.topology == Topology::disk ? "*" : "") + signature);
      const MarkedTarget choice = {target, other_cones(known, target)};
      const EmbedResult solved =
          EmbeddingSolver(std::make_shared<const Surface>(known.surface)).embed(target, choice.cones);
      EXPECT_LT(error_of(known, choice, solved.embedding, Where::where_fine), 0.01) << file << signature;
      EXPECT_NEAR(known.field(all).sigma(choice), solved.distortion.sigma, 0.01) << file << signature;
    }
  }
}

// Where they come to rest along their axis is an estimate.
TEST(ScaleField, KnowsWhereMapsToTwoConesComeToRest) {
  for (const std::string signature : {"22", "33"}) expect_prediction(figure(), signature, {0.1, 0.05});
}

Mesh stretched_ball(int subdivisions) {
  Mesh mesh = test::icosphere(subdivisions);
  mesh.V.col(0) *= 3;
  return mesh;
}

double relative_error(const Known& known, const std::string& signature, const std::vector<int>& cones) {
  ScaleField field = known.field(100);
  return field.relative_error({parse_orbifold(signature), cones});
}

TEST(ScaleField, AnErrorIsKnownOnlyWhereMapsMaySlide) {
  const auto error = [](const Known& known, const std::string& signature) {
    return relative_error(known, signature, choose_cones(known.surface, parse_orbifold(signature)));
  };
  for (const std::string signature : {"432", "222", "442"})
    EXPECT_EQ(error(figure(), signature), 0) << signature;
  for (const std::string signature : {"2*", "*222"}) EXPECT_EQ(error(mask(), signature), 0) << signature;
  EXPECT_GT(error(mask(), "*22"), 0);
  EXPECT_GT(error(figure(), "22"), 0);
}

// It is what the elements at both cones cost, so finer meshes have less of it.
TEST(ScaleField, TheKnownErrorFallsWithTheSizeOfTriangles) {
  double before = 1;
  for (const int subdivisions : {2, 3, 4}) {
    const Known ball(stretched_ball(subdivisions));
    std::vector<int> ends(2);
    ball.surface.V.col(0).minCoeff(&ends[0]);
    ball.surface.V.col(0).maxCoeff(&ends[1]);
    const double error = relative_error(ball, "22", ends);
    EXPECT_LT(error, 0.8 * before) << subdivisions;
    EXPECT_GT(error, 0);
    before = error;
  }
}

TEST(ScaleField, KnowsTheScaleOfMapsToThePlane) {
  expect_prediction(figure(), "442", fine);
  expect_prediction(mask(), "*333", fine);
}

TEST(ScaleField, OfTheMapItselfIsThatMap) {
  ScaleField field = figure().field(all);
  const MarkedTarget same = {parse_orbifold("222"), choose_cones(figure().surface, parse_orbifold("222"))};
  EXPECT_NEAR(field.summary(same).sigma, figure().map.distortion.sigma, 1e-3);
  EXPECT_LT(error_of(figure(), same, figure().map.embedding), 1e-3);
}

// The mean of exp(2 u) is the area of the target's share, which is one. Sums over triangles are coarse near
// cones.
TEST(ScaleField, AreasAddUpToOne) {
  for (const Known* known : {&figure(), &mask()})
    for (const std::string signature : {"532", "432", "223", "22", "33"}) {
      const Target target = parse_orbifold((known == &mask() ? "*" : "") + signature);
      ScaleField field = known->field(all);
      const std::vector<double> u = field.log_scale({target, other_cones(*known, target)});
      double area = 0;
      for (std::size_t s = 0; s < u.size(); ++s) area += field.samples()[s].weight * std::exp(2 * u[s]);
      EXPECT_NEAR(area, 1, 0.05) << target.signature;
    }
}

TEST(ScaleField, FewSamplesTellWhatAllTell) {
  const Target target = parse_orbifold("432");
  const MarkedTarget choice = {target, other_cones(figure(), target)};
  EXPECT_NEAR(figure().field(1500).summary(choice).sigma, figure().field(all).summary(choice).sigma, 0.02);
}

TEST(ScaleField, SigmaAndSpreadAreThoseOfTheSummary) {
  const Target target = parse_orbifold("532");
  const MarkedTarget choice = {target, other_cones(figure(), target)};
  ScaleField field = figure().field(1500), other(field, scale_samples(figure().known(), 1500, {}));
  const ScaleSummary summary = field.summary(choice), spread = other.spread(choice);
  EXPECT_EQ(other.sigma(choice), summary.sigma);
  EXPECT_EQ(spread.sigma, summary.sigma);
  EXPECT_EQ(spread.range, summary.range);
  EXPECT_EQ(spread.log_least_length, summary.log_least_length);
}

// What is passed over by few samples may be better by many, but not by much.
TEST(ConeSearch, FindsAlmostTheSameWithAFirstLook) {
  const Target target = parse_orbifold("432");
  ScaleField few = figure().field(125), many(few, scale_samples(figure().known(), 1500, {}));
  const Candidates candidates = spread_candidates(figure().surface, {}, 40);
  const auto found = [&](double margin) {
    ConeSearch search(many, figure().surface, figure().neighbors, Objective::sigma);
    if (margin > 0) search.look_first_at(few, margin);
    MarkedTarget choice = {target, {candidates.inside.begin(), candidates.inside.begin() + 3}};
    return search.descend(choice, candidates, {}).value;
  };
  const double thorough = found(0);
  EXPECT_EQ(found(1e9), thorough);
  EXPECT_LT(found(0.1), 1.02 * thorough);
}

TEST(ConeSearch, NoOtherCandidateAndNoExchangeIsClearlyBetterThanWhatADescentFinds) {
  const Target target = parse_orbifold("432");
  ScaleField field = figure().field(125);
  ConeSearch search(field, figure().surface, figure().neighbors, Objective::sigma);
  const Candidates candidates = spread_candidates(figure().surface, {}, 30);
  for (const int first : {0, 4, 11}) {
    MarkedTarget found = {target, {candidates.inside.begin() + first, candidates.inside.begin() + first + 3}};
    const Score least = search.descend(found, candidates, {});
    EXPECT_EQ(least.value, search.score(found).value);
    for (int k = 0; k < 3; ++k) {
      for (const int v : candidates.inside) {
        MarkedTarget other = found;
        other.cones[k] = v;
        if (search.is_possible(other))
          EXPECT_FALSE(search.score(other).is_clearly_below(least)) << k << " " << v;
      }
      MarkedTarget exchanged = found;
      std::swap(exchanged.cones[k], exchanged.cones[(k + 1) % 3]);
      EXPECT_FALSE(search.score(exchanged).is_clearly_below(least)) << k;
    }
  }
}

TEST(ScaleField, IsThatOfOrbifoldsOfSphereAndDisk) {
  EXPECT_TRUE(has_closed_form(parse_orbifold("532")));
  EXPECT_TRUE(has_closed_form(parse_orbifold("333")));
  EXPECT_TRUE(has_closed_form(parse_orbifold("5*")));
  EXPECT_FALSE(has_closed_form(parse_orbifold("2222")));
  EXPECT_FALSE(has_closed_form(parse_orbifold("*2222")));
  EXPECT_FALSE(has_closed_form(parse_orbifold("3x")));
  ScaleField field = figure().field(100);
  EXPECT_THROW(field.log_scale({parse_orbifold("2222"), {0, 1, 2, 3}}), ArgumentError);
}

}  // namespace
}  // namespace orbitutte
