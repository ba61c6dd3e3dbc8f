// SPDX-License-Identifier: MIT
// Disks with corners and cones on the sphere and in the hyperbolic plane.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "orbitutte/embed.h"
#include "orbitutte/inspect/recognition.h"
#include "orbitutte/mesh/intrinsic_triangulation.h"
#include "orbitutte/orbifold/cone_target.h"
#include "orbitutte/orbifold/free_tile.h"
#include "orbitutte/orbifold/signature.h"
#include "orbitutte/parallel.h"
#include "orbitutte/solve/moduli_energy.h"
#include "orbitutte/solve/placement.h"
#include "sample_embeddings.h"
#include "test_meshes.h"

namespace orbitutte::curved_disk_test {
namespace {

using std::numbers::pi;

Mark cone(double angle) { return {angle * pi, ConeKind::rotation}; }
Mark corner(double angle) { return {angle * pi, ConeKind::corner}; }

// Cones and corners of disks, some of them of a sphere, the others hyperbolic.
const std::vector<std::vector<Mark>> curved_disks = {
    {corner(0.6), corner(0.6), corner(0.6)},
    {corner(0.8), corner(0.7), corner(0.9), corner(0.75)},
    {cone(1.6), corner(0.9), corner(0.8)},
    {cone(1.7), cone(1.5)},
    {corner(0.2), corner(0.3), corner(0.4)},
    {corner(0.5), corner(0.5), corner(0.5), corner(0.5), corner(0.5)},
    {corner(0.6), corner(0.8), corner(0.5), corner(0.7), corner(0.4), corner(0.6), corner(0.9), corner(0.5)},
    {corner(0.3), corner(0.4), corner(1.5), corner(0.3), corner(0.2)},
    {cone(1), corner(0.5), corner(0.5), corner(0.5)},
    {cone(0.8), cone(1.3), corner(0.6), corner(0.7)},
    {cone(1), cone(2.0 / 3)},
    {cone(0.4), corner(0.5)},
    {cone(0.6), corner(0.8), corner(0.85)},
};

Mesh disk_mesh() {
  Mesh mesh = test::round_disk(10);
  mesh.V.col(2) = 0.4 * mesh.V.col(0).array().square() - 0.2 * mesh.V.col(1).array();
  return test::perturbed(mesh, 0.02, 7);
}

EmbedOptions options(std::uint64_t cut_seed = 0, WeightKind kind = WeightKind::delaunay) {
  EmbedOptions result;
  result.threads = 1;
  result.weights.kind = kind;
  result.cut.seed = cut_seed;
  return result;
}

std::string failures(const Certificate& certificate) {
  std::string text;
  for (const Check& check : certificate.checks)
    if (!check.passed) text += check.name + ": " + check.detail + "; ";
  return text;
}

std::string name_of_marks(const std::vector<Mark>& marks) {
  std::string text;
  for (const Mark& mark : marks)
    text += (mark.kind == ConeKind::corner ? "corner " : "cone ") + std::to_string(mark.angle / pi) + " ";
  return text;
}

TEST(CurvedDisk, IsCertifiedAndConformalAndTheSameForAllCuts) {
  const Mesh mesh = disk_mesh();
  for (const std::vector<Mark>& marks : curved_disks) {
    SCOPED_TRACE(name_of_marks(marks));
    const Target target = cone_target(Topology::disk, marks);
    const std::vector<int> vertices = choose_cones(mesh, target);
    Eigen::VectorXd first;
    for (const std::uint64_t seed : {0u, 4u}) {
      const EmbedResult result = embed(mesh, target, vertices, options(seed));
      EXPECT_TRUE(result.certificate.bijective) << failures(result.certificate);
      EXPECT_TRUE(result.moved_vertices.empty());
      EXPECT_NEAR(result.minimum.energy / (2 * free_tile_area(target)), 1, 0.05);
      const Eigen::VectorXd lengths = test::edge_lengths(mesh, result.embedding);
      if (first.size() == 0) first = lengths;
      EXPECT_LT((lengths - first).cwiseAbs().maxCoeff(), 1e-8) << "seed " << seed;
    }
  }
}

// Three angles leave a triangle no freedom: that of *532 has a tile of its own.
TEST(CurvedDisk, ATriangleIsThatOfItsSphericalOrbifold) {
  const Mesh mesh = disk_mesh();
  for (const char* symbol : {"*532", "*432", "3*2"}) {
    const Target orbifold = parse_orbifold(symbol);
    const std::vector<int> vertices = choose_cones(mesh, orbifold);
    const EmbedResult fixed = embed(mesh, orbifold, vertices, options()),
                      free = embed(mesh, cone_target(Topology::disk, orbifold.marks), vertices, options());
    EXPECT_TRUE(free.certificate.bijective) << failures(free.certificate);
    EXPECT_LT((test::edge_lengths(mesh, fixed.embedding) - test::edge_lengths(mesh, free.embedding))
                  .cwiseAbs()
                  .maxCoeff(),
              1e-8)
        << symbol;
  }
}

TEST(CurvedDisk, HyperbolicOrbifoldsWithMirrorsAreCertified) {
  const Mesh mesh = disk_mesh();
  for (const char* symbol : {"*2,2,2,2,2", "*7,3,2", "2*2,2,2", "2,3*", "2,2*3", "*2,2,2,2,2,2,2,2"}) {
    const Target target = parse_orbifold(symbol);
    const EmbedResult result = embed(mesh, target, choose_cones(mesh, target), options());
    EXPECT_TRUE(result.certificate.bijective) << symbol << ": " << failures(result.certificate);
    EXPECT_NEAR(result.certificate.signed_area, free_tile_area(target), 1e-9) << symbol;
  }
}

// Two copies of a disk, glued along the boundary; the first half of the vertices are the disk's.
Mesh doubled(const Mesh& disk) {
  const Connectivity connectivity = test::edges_of(disk);
  const int n = test::vertex_count(disk), m = test::face_count(disk);
  std::vector<int> other(n, -1);
  for (int h = 0; h < disk.F.size(); ++h)
    if (connectivity.opposite[h] < 0) other[halfedge_origin(disk.F, h)] = halfedge_origin(disk.F, h);
  int count = n;
  for (int& v : other) v = v >= 0 ? v : count++;
  Mesh twice = {Points(count, 3), Triangles(2 * m, 3)};
  for (int v = 0; v < n; ++v) twice.V.row(v) = twice.V.row(other[v]) = disk.V.row(v);
  for (int f = 0; f < m; ++f) {
    twice.F.row(f) = disk.F.row(f);
    twice.F.row(m + f) << other[disk.F(f, 0)], other[disk.F(f, 2)], other[disk.F(f, 1)];
  }
  return twice;
}

TEST(CurvedDisk, IsHalfOfItsDouble) {
  const Mesh disk = disk_mesh(), twice = doubled(disk);
  for (const std::size_t k : {1u, 5u}) {
    const Target target = cone_target(Topology::disk, curved_disks[k]);
    std::vector<Mark> marks;
    for (const Mark& mark : target.marks) marks.push_back({2 * mark.angle, ConeKind::rotation});
    const std::vector<int> vertices = choose_cones(disk, target);
    const EmbedResult half = embed(disk, target, vertices, options(0, WeightKind::cotan)),
                      whole = embed(twice, cone_target(Topology::sphere, marks), vertices,
                                    options(0, WeightKind::cotan));
    EXPECT_TRUE(whole.certificate.bijective) << failures(whole.certificate);
    EXPECT_NEAR(whole.minimum.energy, 2 * half.minimum.energy, 1e-9);
    const Eigen::VectorXd in_half = test::edge_lengths(disk, half.embedding),
                          in_whole = test::edge_lengths(twice, whole.embedding);
    const Connectivity one = test::edges_of(disk), both = test::edges_of(twice);
    for (std::size_t e = 0; e < one.edges.size(); ++e) {
      const auto at =
          std::lower_bound(both.edges.begin(), both.edges.end(), one.edges[e]) - both.edges.begin();
      EXPECT_NEAR(in_half[static_cast<Eigen::Index>(e)], in_whole[at], 1e-8);
    }
  }
}

// As the angles become flat, from either side, so do the disks.
TEST(CurvedDisk, OfLittleAreaMeetsTheFlatOne) {
  const Mesh mesh = disk_mesh();
  const std::vector<Mark> flat_marks = {corner(0.4), corner(0.7), corner(0.5), corner(0.4)};
  const Target flat = cone_target(Topology::disk, flat_marks);
  const std::vector<int> vertices = choose_cones(mesh, flat);
  const Eigen::VectorXd in_plane = test::edge_lengths(mesh, embed(mesh, flat, vertices, options()).embedding);
  for (const double area : {1e-3, -1e-3}) {
    std::vector<Mark> marks = flat_marks;
    for (Mark& mark : marks) mark.angle += area / 4;
    const EmbedResult curved = embed(mesh, cone_target(Topology::disk, marks), vertices, options());
    EXPECT_TRUE(curved.certificate.bijective) << failures(curved.certificate);
    const Eigen::VectorXd lengths = test::edge_lengths(mesh, curved.embedding) / std::sqrt(std::abs(area));
    EXPECT_LT((lengths - in_plane).cwiseAbs().maxCoeff(), 1e-3);
  }
}

// All that a search for the shape of a disk begins with.
struct CutDisk {
  CutDisk(const std::vector<Mark>& marks, std::uint64_t seed)
      : surface(make_surface(disk_mesh())),
        target(cone_target(Topology::disk, marks)),
        cones(choose_cones(surface, target)),
        weights(edge_weights(surface, {})),
        cut(cut_along_tree(surface, cones, target.inner_marks, {seed})),
        moduli(moduli_of(target, cut)),
        words(edge_words(surface, weights.triangulation.get(), cut)),
        energy(moduli, words, words.weights(weights.w), cones_as_met(cut)) {}

  // Positions in the space around (0, 0, 1), the marks where a closed disk has them.
  Points scattered() const {
    std::mt19937 random(3);
    std::uniform_real_distribution<double> uniform(-0.4, 0.4);
    Points x(surface.vertex_count(), 3);
    for (Eigen::Index v = 0; v < x.rows(); ++v)
      x.row(v) = target.space.lift(uniform(random), uniform(random)).transpose();
    return energy.with_cones(x, polygon());
  }

  Points polygon() const { return moduli.closed(moduli.inscribed_polygon()).value(); }

  Surface surface;
  Target target;
  std::vector<int> cones;
  EdgeWeights weights;
  CutMesh cut;
  Moduli moduli;
  EdgeWords words;
  ModuliEnergy energy;
};

class EveryCutDisk : public testing::TestWithParam<std::size_t> {
 protected:
  CutDisk cut_disk(std::uint64_t seed = 0) const { return {curved_disks[GetParam()], seed}; }
};

INSTANTIATE_TEST_SUITE_P(Marks, EveryCutDisk, testing::Values(1, 6, 7, 8, 9, 10, 12));

// Vertices that lie on their mirrors make mirror images of the same length.
TEST_P(EveryCutDisk, WordsGlueEdgesAsTheTileDoes) {
  for (const std::uint64_t seed : {0u, 5u}) {
    const CutDisk s = cut_disk(seed);
    Points x = s.scattered();
    const Tile tile = tile_through(s.target, s.cut, x);
    const BoundaryConditions boundary = glue(s.cut, tile, s.target);
    boundary.make_feasible(x);
    EdgeWeights with_images;
    with_images.w = s.words.weights(s.weights.w);
    const DirichletEnergy by_words(s.energy.glued(s.polygon()), with_images, boundary);
    const GluingProblem problem = {s.surface, s.cut, s.target, s.weights, {}, tile, boundary};
    const DirichletEnergy by_tile(glued_along(problem, boundary), s.weights, boundary);
    EXPECT_FALSE(s.words.mirrored.empty());
    const DirichletEnergy::Value a = by_words.evaluate(x), b = by_tile.evaluate(x);
    EXPECT_NEAR(a.energy, b.energy, 1e-9 * b.energy) << "seed " << seed;
    EXPECT_LT((a.gradient - b.gradient).cwiseAbs().maxCoeff(), 1e-9 * b.energy) << "seed " << seed;
  }
}

TEST_P(EveryCutDisk, TheEnergysDerivativesByTheMarksAreThoseOfDifferences) {
  const CutDisk s = cut_disk();
  const Points x = s.scattered(), marks = s.polygon();
  const auto moved = [&](const Eigen::VectorXd& step) {
    Points result;
    move_points(s.target.space, marks, s.moduli.tangents(marks, step), 1, result);
    return result;
  };
  const Eigen::VectorXd gradient = s.energy.cone_gradient(x, marks);
  const Eigen::Index count = gradient.size();
  const ModuliEnergy::Curvature second =
      s.energy.curvature(x, marks, Eigen::MatrixXd::Identity(count, count));
  constexpr double h = 1e-5, wide = 2e-4;
  const double here = s.energy.energy(x, marks);
  for (Eigen::Index q = 0; q < count; ++q) {
    const Eigen::VectorXd step = Eigen::VectorXd::Unit(count, q);
    const Points ahead = moved(h * step), behind = moved(-h * step);
    EXPECT_NEAR(gradient[q], (s.energy.energy(x, ahead) - s.energy.energy(x, behind)) / (2 * h),
                1e-6 * gradient.norm())
        << q;
    const Points change = (s.energy.gradient(x, ahead) - s.energy.gradient(x, behind)) / (2 * h);
    EXPECT_LT((second.gradient[q] - change).norm(), 1e-6 * change.norm() + 1e-6) << q;
    const double bend =
        (s.energy.energy(x, moved(wide * step)) - 2 * here + s.energy.energy(x, moved(-wide * step))) /
        (wide * wide);
    EXPECT_NEAR(second.energy(q, q), bend, 1e-4 * second.energy.norm()) << q;
  }
}

}  // namespace
}  // namespace orbitutte::curved_disk_test
