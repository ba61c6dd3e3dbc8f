// SPDX-License-Identifier: MIT
// Cones and corners of any angles in the plane: targets, cuts along trees, tiles of free shape, and the
// conformal map.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <random>
#include <set>

#include "orbitutte/cones/extremities.h"
#include "orbitutte/cones/marked_cones.h"
#include "orbitutte/embed.h"
#include "orbitutte/orbifold/cone_target.h"
#include "orbitutte/orbifold/free_tile.h"
#include "orbitutte/orbifold/polygon.h"
#include "orbitutte/report/report.h"
#include "orbitutte/report/verification.h"
#include "sample_embeddings.h"

namespace orbitutte::cones_test {
namespace {

using std::numbers::pi;
using testing::HasSubstr;

Mark cone(double angle) { return {angle, ConeKind::rotation}; }
Mark corner(double angle) { return {angle, ConeKind::corner}; }

/// Angles of cones on a sphere, then of cones and corners of disks, that are flat.
const std::vector<std::vector<Mark>> flat_spheres = {
    {cone(pi), cone(pi), cone(pi), cone(pi)},
    {cone(0.5 * pi), cone(1.1 * pi), cone(0.4 * pi)},
    {cone(1.2 * pi), cone(1.6 * pi), cone(0.3 * pi), cone(1.9 * pi), cone(pi)},
    {cone(pi), cone(1.5 * pi), cone(1.5 * pi), cone(1.5 * pi), cone(1.25 * pi), cone(1.25 * pi)},
    {cone(0.5 * pi), cone(2.6 * pi), cone(0.5 * pi), cone(0.4 * pi)},
};
const std::vector<std::vector<Mark>> flat_disks = {
    {corner(0.5 * pi), corner(0.5 * pi), corner(0.5 * pi), corner(0.5 * pi)},
    {corner(0.2 * pi), corner(0.3 * pi), corner(0.5 * pi)},
    {corner(0.5 * pi), corner(0.5 * pi), corner(1.5 * pi), corner(0.5 * pi), corner(0.5 * pi),
     corner(0.5 * pi)},
    {corner(0.5 * pi), corner(0.5 * pi), corner(pi), corner(0.5 * pi), corner(0.5 * pi)},
    {cone(1.3 * pi), corner(0.5 * pi), corner(0.7 * pi), corner(0.5 * pi)},
    {cone(1.2 * pi), cone(1.5 * pi), corner(0.6 * pi), corner(0.7 * pi)},
    {cone(0.5 * pi), corner(0.5 * pi)},
    {cone(0.8 * pi), cone(1.2 * pi)},
};

Mesh sphere_mesh() { return test::perturbed(test::icosphere(3), 0.02, 7); }

Mesh disk_mesh() {
  Mesh mesh = test::round_disk(10);
  mesh.V.col(2) = 0.4 * mesh.V.col(0).array().square() - 0.2 * mesh.V.col(1).array();
  return test::perturbed(mesh, 0.02, 7);
}

struct Case {
  Mesh mesh;
  Target target;
  std::vector<int> vertices;
};

Case sphere_case(const std::vector<Mark>& marks) {
  const Mesh mesh = sphere_mesh();
  const Target target = cone_target(Topology::sphere, marks);
  return {mesh, target, choose_cones(mesh, target)};
}

Case disk_case(const std::vector<Mark>& marks) {
  const Mesh mesh = disk_mesh();
  const Target target = cone_target(Topology::disk, marks);
  return {mesh, target, choose_cones(mesh, target)};
}

std::vector<Case> all_cases() {
  std::vector<Case> cases;
  for (const auto& marks : flat_spheres) cases.push_back(sphere_case(marks));
  for (const auto& marks : flat_disks) cases.push_back(disk_case(marks));
  return cases;
}

std::string name_of_case(const Case& c) {
  std::string text = c.target.signature;
  for (const Mark& mark : c.target.marks)
    text += " " + name_of(mark.kind) + " " + std::to_string(mark.angle / pi) + " pi";
  return text;
}

EmbedOptions options(std::uint64_t cut_seed = 0, WeightKind kind = WeightKind::delaunay) {
  EmbedOptions result;
  result.threads = 1;
  result.weights.kind = kind;
  result.cut.seed = cut_seed;
  return result;
}

/// Cotangents of right angles stay zero, up to rounding.
EmbedOptions with_cotangents() {
  EmbedOptions result = options(0, WeightKind::cotan);
  result.weights.clamp = 1e-15;
  return result;
}

EmbedResult embedded(const Case& c, const EmbedOptions& how = options()) {
  return embed(c.mesh, c.target, c.vertices, how);
}

CutMesh tree_of(const Case& c, std::uint64_t seed = 0) {
  return cut_along_tree(test::unjudged(c.mesh), c.vertices, c.target.inner_marks, {seed});
}

std::string failures(const Certificate& certificate) {
  std::string failed;
  for (const Check& check : certificate.checks)
    if (!check.passed) failed += check.name + ": " + check.detail + "; ";
  return failed;
}

double conformality(const EmbedResult& result) {
  return result.minimum.energy / (2 * result.certificate.expected_area);
}

// ------------------------------------------------------------------------------------------- the targets

TEST(ConeTarget, GaussAndBonnetDecideTheSpace) {
  for (const auto& marks : flat_spheres)
    EXPECT_EQ(cone_target(Topology::sphere, marks).space, Space::plane());
  for (const auto& marks : flat_disks) EXPECT_EQ(cone_target(Topology::disk, marks).space, Space::plane());
  const std::vector<Mark> wide(4, cone(1.6 * pi)), narrow(5, cone(pi)), square(4, corner(0.6 * pi));
  EXPECT_EQ(cone_target(Topology::sphere, wide).space, Space::sphere());
  EXPECT_EQ(cone_target(Topology::sphere, narrow).space, Space::hyperbolic_plane());
  EXPECT_EQ(cone_target(Topology::disk, square).space, Space::sphere());
  EXPECT_NEAR(target_area(cone_target(Topology::sphere, wide)), 2.4 * pi, 1e-12);
  EXPECT_NEAR(target_area(cone_target(Topology::sphere, narrow)), pi, 1e-12);
  EXPECT_NEAR(target_area(cone_target(Topology::disk, square)), 0.4 * pi, 1e-12);
}

TEST(ConeTarget, RoundedAnglesAreMadeFlat) {
  const std::vector<Mark> typed = {cone(3.1415926536), cone(3.1415926536), cone(3.1415926536),
                                   cone(3.1415926536)};
  const Target target = cone_target(Topology::sphere, typed);
  EXPECT_EQ(target.space, Space::plane());
  EXPECT_NEAR(total_curvature(target.topology, target.marks), 0, 1e-14);
  EXPECT_EQ(cone_target(Topology::sphere, {cone(3.1416), cone(3.1416), cone(3.1416), cone(3.1416)}).space,
            Space::sphere())
      << "four digits are not enough";
}

TEST(ConeTarget, OfHalfTurnsIsThePillow) {
  const Target pillow = parse_orbifold("2222"), cones = cone_target(Topology::sphere, flat_spheres[0]);
  ASSERT_EQ(cones.marks.size(), pillow.marks.size());
  for (std::size_t k = 0; k < 4; ++k) EXPECT_EQ(cones.marks[k].angle, pillow.marks[k].angle);
  EXPECT_TRUE(pillow.has_free_tile);
  EXPECT_EQ(target_area(cones), target_area(pillow));
}

template <typename Make>
std::string refusal(const Make& make) {
  try {
    make();
  } catch (const Error& error) {
    return error.what();
  }
  return {};
}

TEST(ConeTarget, AnglesThatNoConeHasAreRefused) {
  for (const double angle : {0.0, -1.0, std::nan(""), std::numeric_limits<double>::infinity()})
    EXPECT_THAT(refusal([&] {
                  cone_target(Topology::sphere, {cone(1), cone(angle)});
                }),
                HasSubstr("the angle of mark 1 is"));
  EXPECT_THAT(refusal([] { cone_target(Topology::sphere, {cone(1), corner(1)}); }), HasSubstr("a sphere"));
  EXPECT_THAT(refusal([] { cone_target(Topology::disk, {corner(1), cone(1)}); }), HasSubstr("come first"));
  EXPECT_THAT(refusal([] { cone_target(Topology::projective_plane, {cone(1)}); }),
              HasSubstr("a sphere or a disk"));
}

TEST(ConeTarget, EmbeddingRefusesAnglesOfNoCurvedDisk) {
  Case c = disk_case(flat_disks[0]);
  c.target =
      cone_target(Topology::disk, {corner(0.5 * pi), corner(0.5 * pi), corner(0.9 * pi), corner(1.6 * pi)});
  EXPECT_THAT(refusal([&] { embedded(c); }), HasSubstr("the angle 1.6 pi of a corner is not supported"));
  c.target =
      cone_target(Topology::disk, {corner(0.2 * pi), corner(0.95 * pi), corner(0.95 * pi), corner(0.6 * pi)});
  EXPECT_THAT(refusal([&] { embedded(c); }), HasSubstr("Troyanov's bound"));
}

TEST(MarkedCones, VerticesOnTheBoundaryAreCornersAndComeLast) {
  const Mesh mesh = disk_mesh();
  const int outer = test::vertex_count(mesh) - 1;
  const MarkedCones marked = marked_cones(test::unjudged(mesh), "*cones", {outer, 0, outer - 5, 3},
                                          {0.6 * pi, 1.2 * pi, 0.7 * pi, 1.5 * pi});
  EXPECT_EQ(marked.vertices, (std::vector<int>{0, 3, outer, outer - 5}));
  EXPECT_EQ(marked.target.inner_marks, 2);
  EXPECT_NEAR(marked.target.marks[1].angle, 1.5 * pi, 1e-12);
  EXPECT_EQ(marked.target.marks[2].kind, ConeKind::corner);
  EXPECT_THAT(refusal([&] {
                marked_cones(test::unjudged(mesh), "*cones", {0}, {1, 2});
              }),
              HasSubstr("1 marked vertices, but 2 angles"));
}

// ------------------------------------------------------------------------------------------------- cuts

/// A disk: V - E + F = 1, and one boundary that passes no vertex twice.
void expect_disk(const CutMesh& cut) {
  const Connectivity connectivity = connectivity_of(cut.F, cut.vertex_count());
  EXPECT_EQ(cut.vertex_count() - static_cast<int>(connectivity.edges.size()) + cut.F.rows(), 1);
  const auto outer = std::count(connectivity.opposite.begin(), connectivity.opposite.end(), -1);
  EXPECT_EQ(outer, static_cast<long>(cut.boundary.size()));
  EXPECT_EQ(std::set<int>(cut.boundary.begin(), cut.boundary.end()).size(), cut.boundary.size());
}

/// The input vertices along a side, both ends included.
std::vector<int> vertices_of(const CutMesh& cut, std::size_t s) {
  const int end = s + 1 < cut.sides.size() ? cut.sides[s + 1].begin : static_cast<int>(cut.boundary.size());
  std::vector<int> result;
  for (int k = cut.sides[s].begin; k <= end; ++k)
    result.push_back(cut.source_vertex[cut.boundary[k % cut.boundary.size()]]);
  return result;
}

TEST(CutTree, ThroughAnyMarksGivesADiskWhoseSidesPair) {
  std::mt19937 generator(1);
  const Mesh sphere = sphere_mesh(), disk = disk_mesh();
  for (const bool is_disk : {false, true}) {
    const Mesh& mesh = is_disk ? disk : sphere;
    const Connectivity connectivity = test::edges_of(mesh);
    std::vector<char> on_boundary(test::vertex_count(mesh), 0);
    for (int h = 0; h < mesh.F.size(); ++h)
      if (connectivity.opposite[h] < 0) on_boundary[halfedge_origin(mesh.F, h)] = 1;
    for (int trial = 0; trial < 60; ++trial) {
      std::vector<int> marks;
      for (const int v : test::permutation(test::vertex_count(mesh), static_cast<std::uint32_t>(trial)))
        if (!on_boundary[v] && static_cast<int>(marks.size()) < 2 + trial % 20) marks.push_back(v);
      const int inner = static_cast<int>(marks.size());
      const CutMesh cut =
          cut_along_tree(test::unjudged(mesh), marks, inner, {static_cast<std::uint64_t>(trial)});
      expect_disk(cut);
      EXPECT_EQ(cut.arrangement.size(), cut.marks.size());
      EXPECT_EQ(cut.sides.front().begin, 0);
      for (std::size_t s = 0; s < cut.sides.size(); ++s) {
        const auto partner = static_cast<std::size_t>(cut.sides[s].partner);
        ASSERT_EQ(cut.sides[partner].partner, static_cast<int>(s));
        std::vector<int> here = vertices_of(cut, s), there = vertices_of(cut, partner);
        if (partner != s) std::reverse(there.begin(), there.end());
        EXPECT_EQ(here, there);
        EXPECT_TRUE(is_disk || partner != s);
      }
    }
  }
}

TEST(CutTree, WhereMarksFillTheMeshNothingIsBlocked) {
  const Mesh mesh = test::icosahedron();
  std::vector<int> marks;
  for (int v = 0; v < 12; ++v) {
    marks.push_back(v);
    if (v > 1) expect_disk(cut_along_tree(test::unjudged(mesh), marks, v + 1));
  }
}

TEST(CutTree, MarksThatCannotBeReachedAreRefused) {
  const Mesh two = test::united(test::octahedron(), test::octahedron());
  EXPECT_THAT(refusal([&] { cut_along_tree(test::unjudged(two), {0, 1, 6}, 3); }), HasSubstr("no edge path"));
  EXPECT_THAT(refusal([&] { cut_along_tree(test::unjudged(two), {0}, 1); }), HasSubstr("1 marked"));
}

// ------------------------------------------------------------------------------------------------ tiles

/// Positions of all input vertices whose marks have a random shape without closing defects.
Points random_positions(const Target& target, const CutMesh& cut, std::uint32_t seed) {
  std::mt19937 generator(seed);
  std::normal_distribution<double> normal;
  const TileShapes shapes = tile_shapes(target, cut);
  Eigen::VectorXcd shape = Eigen::VectorXcd::Zero(shapes.basis.rows());
  for (Eigen::Index j = 0; j < shapes.basis.cols(); ++j)
    shape += std::complex<double>(normal(generator), shapes.may_be_turned ? normal(generator) : 0) *
             shapes.basis.col(j);
  return positions_of_marks(cut, shape);
}

TEST(FreeTile, ShapesAreAsManyAsTheMarksLeaveOpen) {
  for (const Case& c : all_cases()) {
    const TileShapes shapes = tile_shapes(c.target, tree_of(c));
    const int inner = c.target.inner_marks, outer = static_cast<int>(c.target.marks.size()) - inner;
    const int expected = c.target.topology == Topology::sphere ? inner - 2 : 2 * inner + outer - 2;
    EXPECT_EQ(shapes.basis.cols(), expected + (c.target.topology == Topology::disk && outer == 0 ? 1 : 0))
        << name_of_case(c);
  }
}

TEST(FreeTile, GluingsOfAClosedShapeFitTogether) {
  for (const Case& c : all_cases()) {
    for (const std::uint64_t seed : {0, 1, 2}) {
      const CutMesh cut = tree_of(c, seed);
      const Points positions = random_positions(c.target, cut, static_cast<std::uint32_t>(seed));
      for (const double defect : closing_defects(c.target, cut, positions))
        EXPECT_NEAR(defect, 0, 1e-13) << name_of_case(c);
      const Tile tile = tile_through(c.target, cut, positions);
      for (std::size_t s = 0; s < tile.sides.size(); ++s) {
        const TileSide &side = tile.sides[s], &next = tile.sides[(s + 1) % tile.sides.size()];
        const TileSide &partner = tile.sides[side.partner],
                       &after = tile.sides[(side.partner + 1) % tile.sides.size()];
        EXPECT_NEAR((side.transform * partner.transform).difference({}), 0, 1e-13);
        if (side.partner == static_cast<int>(s)) {
          if (side.slides) continue;
          EXPECT_NEAR((side.transform * side.start - side.start).norm(), 0, 1e-13) << name_of_case(c);
        } else {
          EXPECT_NEAR((side.start - side.transform * after.start).norm(), 0, 1e-12) << name_of_case(c);
          EXPECT_NEAR((next.start - side.transform * partner.start).norm(), 0, 1e-12) << name_of_case(c);
        }
      }
    }
  }
}

TEST(FreeTile, AMarkThatMovesByItselfOpensTheTile) {
  for (const Case& c : all_cases()) {
    const CutMesh cut = tree_of(c);
    Points positions = random_positions(c.target, cut, 5);
    positions.row(cut.marks[0]) += Eigen::RowVector3d(0.1, 0.07, 0);
    double largest = 0;
    for (const double defect : closing_defects(c.target, cut, positions))
      largest = std::max(largest, std::abs(defect));
    EXPECT_GT(largest, 1e-3) << name_of_case(c);
  }
}

// ------------------------------------------------------------------------------------------------- maps

TEST(Cones, EveryCaseIsCertifiedAndNearlyConformal) {
  for (const Case& c : all_cases()) {
    const EmbedResult result = embedded(c);
    EXPECT_TRUE(result.certificate.bijective) << name_of_case(c) << " " << failures(result.certificate);
    EXPECT_EQ(result.minimum.termination, Termination::converged);
    EXPECT_NEAR(result.certificate.signed_area, target_area(c.target), 1e-10);
    EXPECT_GT(conformality(result), 1);
    EXPECT_LT(conformality(result), 1.1) << name_of_case(c);
  }
}

TEST(Cones, WeightsOfEveryKindGiveBijections) {
  for (const WeightKind kind : {WeightKind::cotan, WeightKind::uniform}) {
    for (const std::size_t k : {0, 3}) {
      const EmbedResult result = embedded(sphere_case(flat_spheres[k]), options(0, kind));
      EXPECT_TRUE(result.certificate.bijective) << name_of(kind) << failures(result.certificate);
    }
  }
}

TEST(Cones, MarksLieWhereTheFrameHasThem) {
  for (const Case& c : all_cases()) {
    const Points positions = embedded(c).embedding.positions;
    const Vector3 second = positions.row(c.vertices[1]);
    EXPECT_NEAR((Vector3(positions.row(c.vertices[0])) - Space::origin()).norm(), 0, 1e-14);
    EXPECT_NEAR(second.y(), 0, 1e-14);
    EXPECT_GT(second.x(), 0);
  }
}

// The map does not know the tree, which is a choice of gauge: its sides, its branches, or which marks it
// joins.
TEST(Cones, TheTreeChangesNoLength) {
  for (const Case& c : all_cases()) {
    const Eigen::VectorXd before = test::edge_lengths(c.mesh, embedded(c).embedding);
    for (std::uint64_t seed = 1; seed <= 20; ++seed) {
      const Eigen::VectorXd after = test::edge_lengths(c.mesh, embedded(c, options(seed)).embedding);
      EXPECT_LT((after - before).cwiseAbs().maxCoeff(), 1e-10) << name_of_case(c) << " " << seed;
    }
  }
}

TEST(Cones, TheOrderOfTheMarksChangesNoLength) {
  Case c = sphere_case(flat_spheres[2]);
  const Eigen::VectorXd before = test::edge_lengths(c.mesh, embedded(c).embedding);
  std::reverse(c.target.marks.begin(), c.target.marks.end());
  std::reverse(c.vertices.begin(), c.vertices.end());
  EXPECT_LT((test::edge_lengths(c.mesh, embedded(c).embedding) - before).cwiseAbs().maxCoeff(), 1e-10);
}

// Three cones leave no shape open.
TEST(Cones, ThreeConesGiveTheOrbifoldsMap) {
  const Mesh mesh = sphere_mesh();
  const Target orbifold = parse_orbifold("442");
  const std::vector<int> vertices = choose_cones(mesh, orbifold);
  const EmbedResult fixed = embed(mesh, orbifold, vertices, options());
  const EmbedResult free = embed(mesh, cone_target(Topology::sphere, orbifold.marks), vertices, options());
  const double scale = std::sqrt(fixed.certificate.expected_area / free.certificate.expected_area);
  const Eigen::VectorXd lengths = scale * test::edge_lengths(mesh, free.embedding);
  EXPECT_LT((test::edge_lengths(mesh, fixed.embedding) - lengths).cwiseAbs().maxCoeff(), 1e-8);
}

TEST(Cones, TheDoubleOfADiskIsMappedAsTheDisk) {
  const Case disk = disk_case(flat_disks[1]);
  const Connectivity connectivity = test::edges_of(disk.mesh);
  const int n = test::vertex_count(disk.mesh), m = test::face_count(disk.mesh);
  std::vector<int> other(n, -1);
  for (int h = 0; h < disk.mesh.F.size(); ++h)
    if (connectivity.opposite[h] < 0)
      other[halfedge_origin(disk.mesh.F, h)] = halfedge_origin(disk.mesh.F, h);
  int count = n;
  for (int& v : other) v = v >= 0 ? v : count++;
  Mesh twice = {Points(count, 3), Triangles(2 * m, 3)};
  for (int v = 0; v < n; ++v) twice.V.row(v) = twice.V.row(other[v]) = disk.mesh.V.row(v);
  for (int f = 0; f < m; ++f) {
    twice.F.row(f) = disk.mesh.F.row(f);
    twice.F.row(m + f) << other[disk.mesh.F(f, 0)], other[disk.mesh.F(f, 2)], other[disk.mesh.F(f, 1)];
  }
  std::vector<Mark> marks;
  for (const Mark& mark : disk.target.marks) marks.push_back(cone(2 * mark.angle));
  const EmbedResult half = embedded(disk, options(0, WeightKind::cotan));
  const EmbedResult whole =
      embed(twice, cone_target(Topology::sphere, marks), disk.vertices, options(0, WeightKind::cotan));
  EXPECT_TRUE(whole.certificate.bijective) << failures(whole.certificate);
  EXPECT_NEAR(whole.minimum.energy, 2 * half.minimum.energy, 1e-10);
  const Eigen::VectorXd in_half = test::edge_lengths(disk.mesh, half.embedding);
  const Eigen::VectorXd in_whole = test::edge_lengths(twice, whole.embedding);
  const Connectivity all = test::edges_of(twice);
  for (std::size_t e = 0; e < connectivity.edges.size(); ++e) {
    const auto at =
        std::lower_bound(all.edges.begin(), all.edges.end(), connectivity.edges[e]) - all.edges.begin();
    EXPECT_NEAR(in_half[static_cast<Eigen::Index>(e)], in_whole[at], 1e-10);
  }
}

/// A rectangle a x b in triangles, or with `sides` = 2 two of them glued along their boundary; its corners.
struct Flat {
  Mesh mesh;
  std::vector<int> corners;
};

Flat flat_rectangle(int columns, int rows, int sides) {
  std::map<std::array<int, 3>, int> index;
  std::vector<Vector3> points;
  std::vector<std::vector<int>> triangles;
  for (int side = 0; side < sides; ++side) {
    const auto vertex = [&](int i, int j) {
      const bool is_outer = i == 0 || j == 0 || i == columns || j == rows;
      const auto [at, is_new] =
          index.try_emplace({i, j, is_outer ? 0 : side}, static_cast<int>(points.size()));
      if (is_new) points.emplace_back(i, j, 0);
      return at->second;
    };
    const auto add = [&](int a, int b, int c) {
      triangles.push_back(side == 0 ? std::vector<int>{a, b, c} : std::vector<int>{a, c, b});
    };
    for (int i = 0; i < columns; ++i) {
      for (int j = 0; j < rows; ++j) {
        const int a = vertex(i, j), b = vertex(i + 1, j), c = vertex(i + 1, j + 1), d = vertex(i, j + 1);
        if ((i + j) % 2 == 0) {
          add(a, b, c), add(a, c, d);
        } else {
          add(a, b, d), add(b, c, d);
        }
      }
    }
  }
  return {
      test::mesh(points, triangles),
      {index.at({0, 0, 0}), index.at({columns, 0, 0}), index.at({columns, rows, 0}), index.at({0, rows, 0})}};
}

// The doubled rectangle is the quotient of a flat torus by its half turn, whatever its proportions: their
// maps are similarities, and E/2A is 1.
TEST(Cones, RectanglesAndTheirDoublesAreLaidOutAsTheyAre) {
  for (const int columns : {4, 6, 14}) {
    for (const int sides : {1, 2}) {
      const Flat flat = flat_rectangle(columns, 6, sides);
      const Target target = parse_orbifold(sides == 1 ? "*2222" : "2222");
      const EmbedResult result = embed(flat.mesh, target, flat.corners, with_cotangents());
      EXPECT_TRUE(result.certificate.bijective) << failures(result.certificate);
      EXPECT_NEAR(conformality(result), 1, 1e-12);
      const double scale = std::sqrt(1.0 / (columns * 6));
      const Eigen::VectorXd lengths = test::edge_lengths(flat.mesh, result.embedding);
      const Connectivity connectivity = test::edges_of(flat.mesh);
      for (Eigen::Index e = 0; e < lengths.size(); ++e) {
        const auto [i, j] = connectivity.edges[e];
        EXPECT_NEAR(lengths[e], scale * (flat.mesh.V.row(i) - flat.mesh.V.row(j)).norm(), 1e-11);
      }
    }
  }
}

// Flat L: a corner of 1.5 pi.
TEST(Cones, AnLIsLaidOutAsItIs) {
  const Flat whole = flat_rectangle(8, 8, 1);
  std::vector<int> beyond;
  for (int f = 0; f < test::face_count(whole.mesh); ++f) {
    Eigen::RowVector3d sum = Eigen::RowVector3d::Zero();
    for (const int v : whole.mesh.F.row(f)) sum += whole.mesh.V.row(v);
    if (sum.x() > 12 && sum.y() > 12) beyond.push_back(f);
  }
  const Mesh mesh = test::without_faces(whole.mesh, beyond);
  const auto vertex_at = [&](double x, double y) {
    for (int v = 0; v < test::vertex_count(mesh); ++v)
      if (mesh.V(v, 0) == x && mesh.V(v, 1) == y) return v;
    return -1;
  };
  const std::vector<int> corners = {vertex_at(0, 0), vertex_at(8, 0), vertex_at(8, 4),
                                    vertex_at(4, 4), vertex_at(4, 8), vertex_at(0, 8)};
  const Target target = cone_target(Topology::disk, {corner(pi / 2), corner(pi / 2), corner(pi / 2),
                                                     corner(1.5 * pi), corner(pi / 2), corner(pi / 2)});
  const EmbedResult result = embed(mesh, target, corners, with_cotangents());
  EXPECT_TRUE(result.certificate.bijective) << failures(result.certificate);
  EXPECT_NEAR(conformality(result), 1, 1e-12);
  EXPECT_NEAR(result.distortion.angle.max, 1, 1e-6);
}

// Faults that a report and an embedding may have.
TEST(Cones, PlantedFaultsAreSeen) {
  const Case c = sphere_case(flat_spheres[2]);
  const Embedding good = embedded(c).embedding;
  const Surface surface = test::unjudged(c.mesh);
  ASSERT_TRUE(certify(surface, good).bijective);
  Embedding other_angle = good;
  std::swap(other_angle.cones[0].mark, other_angle.cones[1].mark);
  EXPECT_FALSE(certify(surface, other_angle).bijective);
  Embedding other_space = good;
  other_space.cones[0].mark.angle += 0.1;
  EXPECT_FALSE(certify(surface, other_space).bijective) << "the angles are not those of the plane";
  Embedding turned = good;
  turned.seams[0].transform =
      Space::plane().rotation(good.positions.row(c.vertices[0]), 1e-3) * turned.seams[0].transform;
  EXPECT_FALSE(certify(surface, turned).bijective);
  Embedding scaled = good;
  scaled.positions.leftCols(2) *= 1.001;
  EXPECT_FALSE(certify(surface, scaled).bijective);
  Embedding moved = good;
  moved.positions.row(c.vertices[3]) += Eigen::RowVector3d(0.3, 0, 0);
  EXPECT_FALSE(certify(surface, moved).bijective);
  Embedding missing = good;
  missing.cones.pop_back();
  EXPECT_FALSE(certify(surface, missing).bijective);
}

TEST(Cones, ReportsAreReadAndVerifiedAgain) {
  for (const Case& c : {sphere_case(flat_spheres[3]), disk_case(flat_disks[5])}) {
    const EmbedResult result = embedded(c);
    const Report report = parse_report(report_json(result, {}));
    EXPECT_EQ(report.signature, c.target.signature);
    Embedding bare = result.embedding;
    bare.target = {};
    bare.cones.clear();
    bare.seams.clear();
    const Embedding read_back = with_report(bare, report);
    EXPECT_TRUE(read_back.target.has_free_tile);
    const Verdict verdict = verify(test::unjudged(c.mesh), read_back, report);
    for (const Check& check : verdict.checks) EXPECT_TRUE(check.passed) << check.name << " " << check.detail;
    EXPECT_TRUE(verdict.bijective);
  }
}

}  // namespace
}  // namespace orbitutte::cones_test
