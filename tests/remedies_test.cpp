// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <random>
#include <ranges>

#include "orbitutte/embed.h"
#include "orbitutte/orbifold/cone_target.h"
#include "orbitutte/orbifold/exact_positions.h"
#include "orbitutte/solve/kernel.h"
#include "orbitutte/solve/lbfgs.h"
#include "orbitutte/solve/repair.h"
#include "solve_cases.h"

namespace orbitutte::remedies_test {
namespace {

using test::solve_case;
using test::SolveCase;

// The conditions of a star-shaped polygon around a point near the origin: inside of every edge.
std::vector<KernelCondition> random_star(std::mt19937& generator, int corners) {
  std::uniform_real_distribution<double> uniform(0.3, 1);
  std::vector<Eigen::Vector2d> points;
  for (int k = 0; k < corners; ++k) {
    const double angle = 2 * M_PI * k / corners;
    points.emplace_back(uniform(generator) * std::cos(angle), uniform(generator) * std::sin(angle));
  }
  std::vector<KernelCondition> conditions;
  for (int k = 0; k < corners; ++k) {
    const Eigen::Vector2d a = points[k], along = (points[(k + 1) % corners] - a).normalized();
    const Eigen::Vector2d inward(-along.y(), along.x());
    conditions.push_back({inward, -inward.dot(a), uniform(generator)});
  }
  return conditions;
}

double least_margin(const std::vector<KernelCondition>& conditions, const Eigen::Vector2d& step) {
  double least = INFINITY;
  for (const KernelCondition& condition : conditions) least = std::min(least, condition.margin(step));
  return least;
}

TEST(Kernel, NoStepHasALargerLeastMargin) {
  std::mt19937 generator(1);
  for (const int corners : {3, 4, 6, 7, 12, 60, 500}) {
    const std::vector<KernelCondition> conditions = random_star(generator, corners);
    const KernelStep widest = widest_step(conditions, {1, 1});
    EXPECT_NEAR(widest.margin, least_margin(conditions, widest.step), 1e-12);
    for (int k = 0; k < 2000; ++k) {
      std::uniform_real_distribution<double> uniform(-1, 1);
      const Eigen::Vector2d step(uniform(generator), uniform(generator));
      EXPECT_LE(least_margin(conditions, step), widest.margin + 1e-9) << corners;
    }
  }
}

TEST(Kernel, StepsStayWithinReach) {
  std::mt19937 generator(2);
  const std::vector<KernelCondition> conditions = random_star(generator, 6);
  EXPECT_EQ(widest_step(conditions, {1, 0}).step.y(), 0);
  EXPECT_LE(widest_step({{{1, 0}, 0, 1}}, {0.25, 0.5}).step.cwiseAbs().maxCoeff(), 0.5);
  EXPECT_NEAR(widest_step({{{1, 0}, 0, 1}}, {0.25, 0.5}).step.x(), 0.25, 1e-12);
}

// A minimum, and all that moves its vertices.
struct MinimumCase {
  explicit MinimumCase(const std::string& signature)
      : of(solve_case(signature)),
        surface(test::unjudged(of->mesh)),
        energy(of->glued, of->weights, of->boundary),
        stars(of->cut, of->boundary, {}, elements),
        may_move(of->boundary.basis_of.size()) {
    const LaplacianSolver laplacian(of->cut, of->glued, of->weights, of->boundary, {});
    LbfgsOptions options;
    options.tolerance = 1e-12;
    positions = minimize(energy, laplacian,
                         initial_embedding(surface, of->cut, of->tile, of->boundary, laplacian), options)
                    .positions;
    for (std::size_t v = 0; v < may_move.size(); ++v) may_move[v] = of->boundary.basis_of[v] != held_in_place;
  }

  // A vertex inside whose neighbours are as well.
  int vertex_inside() const {
    for (int v = 0; v < static_cast<int>(may_move.size()); ++v) {
      const std::vector<StarTriangle> star = stars.around(v);
      if (of->boundary.basis_of[v] == in_space &&
          std::all_of(star.begin(), star.end(),
                      [&](const StarTriangle& at) { return of->boundary.basis_of[at.a] == in_space; }))
        return v;
    }
    return -1;
  }

  std::unique_ptr<SolveCase> of;
  Surface surface;
  Elements elements;
  DirichletEnergy energy;
  Stars stars;
  std::vector<char> may_move;
  Points positions;
  Gluing gluing = {of->cut, of->boundary, elements};
};

class EveryFamilyMended : public testing::TestWithParam<std::string> {};

TEST_P(EveryFamilyMended, StarsGoOnceAroundEveryVertex) {
  MinimumCase c(GetParam());
  const MovablePositions positions(c.gluing, c.positions);
  for (int v = 0; v < static_cast<int>(c.may_move.size()); ++v) {
    if (c.of->boundary.basis_of[v] != in_space) continue;
    double angle = 0;
    for (const StarTriangle& at : c.stars.around(v)) {
      const Vector3 p = positions.rounded(v);
      angle += c.of->boundary.space.angle(p, p + positions.difference(v, at.a, at.element_a),
                                          p + positions.difference(v, at.b, at.element_b));
    }
    EXPECT_NEAR(angle, 2 * M_PI, 1e-9) << v;
  }
}

TEST_P(EveryFamilyMended, ALocalMinimumIsThatOfAllVertices) {
  MinimumCase c(GetParam());
  const Points minimum = c.positions;
  const int v = c.vertex_inside();
  ASSERT_GE(v, 0);
  std::vector<int> vertices = {v};
  for (const StarTriangle& at : c.stars.around(v)) vertices.push_back(at.a);
  std::sort(vertices.begin(), vertices.end());
  MovablePositions positions(c.gluing, c.positions);
  std::vector<Neighbourhood> neighbourhoods;
  for (const int u : vertices) {
    positions.move(u, Vector3(0.01, -0.02, 0.01));
    neighbourhoods.push_back({u, c.energy.neighbours(u, c.elements)});
  }
  // The Hessian is that of the places that were left: steps gain less than ten digits, but many.
  const LocalMinimum local(c.gluing, positions, neighbourhoods);
  int steps = 0;
  while (steps < 1000 && local.step(positions).largest > 1e-12) ++steps;
  EXPECT_LT(steps, 25);
  EXPECT_LT((c.positions - minimum).cwiseAbs().maxCoeff(), 1e-8);
  positions.take_back(0);
  EXPECT_EQ(c.positions, minimum);
}

TEST_P(EveryFamilyMended, ATurnedStarIsRepairedAndNothingElseMoves) {
  MinimumCase c(GetParam());
  const int v = c.vertex_inside();
  ASSERT_GE(v, 0);
  MovablePositions positions(c.gluing, c.positions);
  const StarTriangle first = c.stars.around(v).front();
  positions.move(v, 1.5 * positions.difference(v, first.a, first.element_a));
  const Points before = c.positions;
  const auto is_turned = [&](int f) { return !positions.is_positive(f); };
  ASSERT_TRUE(std::ranges::any_of(std::views::iota(0, static_cast<int>(c.of->cut.F.rows())), is_turned));
  const std::vector<int> moved = repair({c.surface, c.gluing, c.stars, c.may_move}, positions);
  ASSERT_FALSE(moved.empty());
  for (int f = 0; f < static_cast<int>(c.of->cut.F.rows()); ++f) EXPECT_TRUE(positions.is_positive(f)) << f;
  for (int u = 0; u < static_cast<int>(c.may_move.size()); ++u) {
    const bool may_differ = std::binary_search(moved.begin(), moved.end(), u);
    EXPECT_TRUE(may_differ || c.positions.row(u) == before.row(u)) << u;
    EXPECT_EQ(c.of->boundary.feasible(u, c.positions.row(u)).isApprox(c.positions.row(u).transpose(), 1e-14),
              true)
        << u;
  }
}

INSTANTIATE_TEST_SUITE_P(Remedies, EveryFamilyMended, testing::ValuesIn(test::all_signatures()),
                         [](const auto& info) {
                           std::string name = info.param;
                           for (char& c : name)
                             if (c == '*') c = 's';
                           return name;
                         });

// A ball with spikes beside each other, each `length` long.
Mesh spiked(double length, const std::vector<int>& spikes) {
  Mesh mesh = test::icosphere(3);
  for (const int v : spikes) {
    const Vector3 axis = mesh.V.row(v).normalized();
    for (Eigen::Index u = 0; u < mesh.V.rows(); ++u)
      if (const double closeness = axis.dot(mesh.V.row(u)); closeness > 0.95)
        mesh.V.row(u) += length * std::pow((closeness - 0.95) / 0.05, 2) * axis.transpose();
  }
  return mesh;
}

TEST(Limbs, OfAnyLengthAreCertified) {
  const Target target = parse_orbifold("432");
  for (const double length : {3.0, 30.0, 100.0}) {
    const Mesh mesh = spiked(length, {0, 5});
    const EmbedResult result = embed(mesh, target, {1, 2, 3});
    EXPECT_TRUE(result.certificate.bijective) << length;
    EXPECT_TRUE(certify(make_surface(mesh), result.embedding).bijective);
  }
}

// The neighbours of a vertex, counterclockwise.
std::vector<int> ring_around(const Mesh& mesh, int v) {
  std::map<int, int> next;
  for (Eigen::Index f = 0; f < mesh.F.rows(); ++f)
    for (int k = 0; k < 3; ++k)
      if (mesh.F(f, k) == v) next[mesh.F(f, (k + 1) % 3)] = mesh.F(f, (k + 2) % 3);
  std::vector<int> ring = {next.begin()->first};
  while (ring.size() < next.size()) ring.push_back(next.at(ring.back()));
  return ring;
}

// A tube of so many rings in place of the star of a vertex, which closes it. The rings are the last vertices.
Mesh with_limb(const Mesh& mesh, int v, int rings) {
  const std::vector<int> base = ring_around(mesh, v);
  const int around = static_cast<int>(base.size()), n = static_cast<int>(mesh.V.rows());
  const Vector3 axis = mesh.V.row(v).normalized();
  const double height = (mesh.V.row(base[0]) - mesh.V.row(base[1])).norm();
  Mesh result = mesh;
  result.V.conservativeResize(n + rings * around, 3);
  const auto vertex = [&](int ring, int k) {
    return ring == 0 ? base[k % around] : n + (ring - 1) * around + k % around;
  };
  std::vector<Eigen::RowVector3i> faces;
  for (Eigen::Index f = 0; f < mesh.F.rows(); ++f)
    if ((mesh.F.row(f).array() != v).all()) faces.emplace_back(mesh.F.row(f));
  for (int ring = 1; ring <= rings; ++ring) {
    for (int k = 0; k < around; ++k) {
      result.V.row(vertex(ring, k)) = mesh.V.row(base[k]) + ring * height * axis.transpose();
      const int a = vertex(ring - 1, k), b = vertex(ring - 1, k + 1), c = vertex(ring, k + 1),
                d = vertex(ring, k);
      faces.emplace_back(a, b, c);
      faces.emplace_back(a, c, d);
    }
  }
  for (int k = 0; k < around; ++k) faces.emplace_back(vertex(rings, k), vertex(rings, k + 1), v);
  result.V.row(v) += rings * height * axis.transpose();
  result.F.resize(static_cast<Eigen::Index>(faces.size()), 3);
  for (std::size_t f = 0; f < faces.size(); ++f) result.F.row(static_cast<Eigen::Index>(f)) = faces[f];
  return result;
}

// Two limbs, and cones beside them; the last one in the middle of the first limb, so that seams run there.
struct LimbCase {
  Mesh mesh;
  std::vector<int> cones;
};

LimbCase with_cone_in_limb(int cones, int rings) {
  LimbCase result = {with_limb(with_limb(test::icosphere(2), 6, rings), 10, rings), {0, 1, 3, 2, 8, 9}};
  result.cones.resize(cones);
  result.cones.back() = static_cast<int>(test::icosphere(2).V.rows()) + 5 * (rings / 2);
  return result;
}

std::string failed_checks(const Certificate& certificate) {
  std::string failed;
  for (const Check& check : certificate.checks)
    if (!check.passed) failed += check.name + ": " + check.detail + "; ";
  return failed;
}

std::vector<Target> targets_with_free_tiles() {
  const auto cones = [](const std::vector<double>& angles) {
    std::vector<Mark> marks;
    for (const double angle : angles) marks.push_back({angle * M_PI, ConeKind::rotation});
    return cone_target(Topology::sphere, marks);
  };
  return {parse_orbifold("2222"), cones({0.9, 1, 0.8, 0.6, 0.7}), cones({0.8, 0.9, 1, 0.7}),
          cones({0.9, 0.8, 0.9})};
}

TEST(Limbs, OfFreeTilesAreCertifiedWithMoreDigits) {
  for (const Target& target : targets_with_free_tiles()) {
    SCOPED_TRACE(target.signature + " " + target.space.name());
    // With longer limbs the search for a hyperbolic shape does not converge.
    const int rings = target.space == Space::hyperbolic_plane() ? 42 : 48;
    const LimbCase c = with_cone_in_limb(static_cast<int>(target.marks.size()), rings);
    const EmbedResult result = embed(c.mesh, target, c.cones);
    EXPECT_TRUE(result.certificate.bijective) << failed_checks(result.certificate);
    const std::vector<Offset>& offsets = result.embedding.offsets;
    for (const ConeCopies& cone : result.embedding.cones)
      for (const int copy : cone.copies)
        EXPECT_TRUE(std::any_of(offsets.begin(), offsets.end(), [&](const Offset& offset) {
          return offset.vertex == copy;
        })) << "a mark says how the tile is glued";
    EXPECT_TRUE(certify(make_surface(c.mesh), result.embedding).bijective);
  }
}

Target with_cones(const std::vector<double>& shares_of_pi) {
  std::vector<Mark> marks;
  for (const double share : shares_of_pi) marks.push_back({share * M_PI, ConeKind::rotation});
  return cone_target(Topology::sphere, marks);
}

// Spherical, flat and hyperbolic.
const std::vector<std::vector<double>> with_a_great_cone = {
    {1.6, 0.8, 0.8, 0.8}, {1.6, 1.5, 1.4, 1.5}, {1.6, 0.5, 0.5, 0.5}};

// On the way to a tip with a cone of more than pi, what reverses orientations comes to prevail over what
// keeps them.
TEST(Limbs, WithGreatConesAtTheirTipsAreUnrolled) {
  const Mesh mesh = with_limb(test::icosphere(2), 6, 16);
  for (const std::vector<double>& shares : with_a_great_cone) {
    const Target target = with_cones(shares);
    const EmbedResult result = embed(mesh, target, {6, 1, 3, 2});
    EXPECT_TRUE(result.certificate.bijective) << target.space.name() << failed_checks(result.certificate);
    EXPECT_FALSE(result.moved_vertices.empty()) << target.space.name();
  }
}

// Unrolled, the tip's edges are shorter than doubles resolve.
TEST(Limbs, OfAnyLengthAreUnrolledWithMoreDigits) {
  const Mesh mesh = with_limb(test::icosphere(2), 6, 100);
  for (const double share : {1.2, 1.4, 1.6}) {
    const double rest = (4 - share) / 3;
    const EmbedResult result = embed(mesh, with_cones({share, rest, rest, rest}), {6, 1, 3, 2});
    EXPECT_TRUE(result.certificate.bijective) << share << failed_checks(result.certificate);
    EXPECT_EQ(result.requested_weights, std::nullopt) << "other weights were taken";
    EXPECT_FALSE(result.embedding.offsets.empty()) << share;
  }
}

TEST(Limbs, WithGreatConesAreUnrolledBesideLimbsWithMoreDigits) {
  const Mesh mesh = with_limb(with_limb(test::icosphere(2), 6, 16), 9, 48);
  for (const std::vector<double>& shares : with_a_great_cone) {
    const Target target = with_cones(shares);
    const EmbedResult result = embed(mesh, target, {6, 1, 3, 2});
    EXPECT_TRUE(result.certificate.bijective) << target.space.name() << failed_checks(result.certificate);
    EXPECT_EQ(result.requested_weights, std::nullopt) << "other weights were taken";
    EXPECT_FALSE(result.moved_vertices.empty()) << target.space.name();
    EXPECT_FALSE(result.embedding.offsets.empty()) << target.space.name();
  }
}

// Pairs of the seam in the limb, and the lengths of its edges there, the smallest first.
struct SeamInLimb {
  std::vector<std::pair<int, int>> pairs;
  std::vector<double> lengths;
};

SeamInLimb seam_in_limb(const Embedding& embedding) {
  const ExactPositions positions(embedding);
  std::map<double, std::pair<int, int>> by_length;
  for (const Seam& seam : embedding.seams)
    for (std::size_t k = 1; k + 1 < seam.left.size(); ++k)
      if (positions.has_offsets(seam.left[k]))
        by_length[positions.chord(seam.left[k], seam.left[k + 1])] = {seam.left[k], seam.right[k]};
  SeamInLimb result;
  for (const auto& [length, pair] : by_length) {
    result.pairs.push_back(pair);
    result.lengths.push_back(length);
  }
  return result;
}

TEST(Limbs, FaultsInTheSeamsOfFreeTilesAreSeen) {
  const Target target = parse_orbifold("2222");
  const LimbCase c = with_cone_in_limb(4, 48);
  const EmbedResult result = embed(c.mesh, target, c.cones);
  ASSERT_TRUE(result.certificate.bijective) << failed_checks(result.certificate);
  const Surface surface = make_surface(c.mesh);
  const auto [pairs, lengths] = seam_in_limb(result.embedding);
  ASSERT_GT(pairs.size(), 4u);
  const auto is_certified = [&](const Embedding& embedding) { return certify(surface, embedding).bijective; };
  const auto exchanged = [&](int a, int b) {
    Embedding embedding = result.embedding;
    Points& X = embedding.positions;
    X.row(a).swap(X.row(b));
    for (Offset& offset : embedding.offsets)
      offset.vertex = offset.vertex == a ? b : offset.vertex == b ? a : offset.vertex;
    return embedding;
  };
  for (std::size_t k = 1; k < pairs.size(); ++k)
    EXPECT_FALSE(is_certified(exchanged(pairs[k - 1].second, pairs[k].second))) << k;
  // A mark that is moved by a part of the smallest edges turns the group away from the positions.
  const double smallest = lengths.front();
  ASSERT_LT(smallest, 1e-6);
  const auto with_mark_moved = [&](int mark, double step) {
    Embedding embedding = result.embedding;
    for (const int copy : embedding.cones[mark].copies)
      embedding.offsets.push_back({copy, Vector3(step, step, 0)});
    return embedding;
  };
  EXPECT_EQ(failed_checks(certify(surface, with_mark_moved(3, 1e-10 * smallest))), "");
  EXPECT_FALSE(is_certified(with_mark_moved(3, 0.1 * smallest)));
}

}  // namespace
}  // namespace orbitutte::remedies_test
