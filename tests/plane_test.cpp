// SPDX-License-Identifier: MIT
// Euclidean orbifolds, through the same tiles, cuts, seams and certificate as spherical ones.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

#include "orbitutte/embed.h"
#include "orbitutte/orbifold/polygon.h"
#include "orbitutte/orbifold/tile.h"
#include "test_meshes.h"

namespace orbitutte::plane_test {
namespace {

using std::numbers::pi;

const std::vector<std::string> closed_symbols = {"333", "442", "244", "424", "632", "236", "326"};
const std::vector<std::string> mirrored_symbols = {"*333", "*442", "*244", "*632", "*263"};

/// Those whose tile has the shape of the surface (cones_test.cpp).
const std::vector<std::string> free_symbols = {"2222", "*2222"};

std::vector<std::string> all_symbols() {
  std::vector<std::string> all = closed_symbols;
  all.insert(all.end(), mirrored_symbols.begin(), mirrored_symbols.end());
  return all;
}

EmbedOptions with(WeightKind kind, std::uint64_t cut_seed = 0) {
  EmbedOptions options;
  options.threads = 1;
  options.weights.kind = kind;
  options.cut.seed = cut_seed;
  return options;
}

struct Sample {
  Mesh mesh;
  std::vector<int> marks;
  EmbedResult result;
};

Sample sample(const std::string& symbol, const EmbedOptions& options = with(WeightKind::cotan)) {
  const Target orbifold = parse_orbifold(symbol);
  const Mesh mesh = orbifold.topology == Topology::sphere ? test::perturbed(test::icosphere(3), 0.02, 7)
                                                          : test::perturbed(test::round_disk(10), 0.02, 7);
  const std::vector<int> marks = choose_cones(mesh, orbifold);
  return {mesh, marks, embed(mesh, orbifold, marks, options)};
}

/// The lengths of the edges of the uncut mesh in the plane.
Eigen::VectorXd edge_lengths(const Sample& sample) {
  const Connectivity connectivity = connectivity_of(sample.mesh.F, test::vertex_count(sample.mesh));
  Eigen::VectorXd lengths(static_cast<Eigen::Index>(connectivity.edges.size()));
  const Embedding& embedding = sample.result.embedding;
  for (int h = 0; h < static_cast<int>(embedding.triangles.size()); ++h)
    lengths[connectivity.edge_of[h]] = (embedding.positions.row(halfedge_origin(embedding.triangles, h)) -
                                        embedding.positions.row(halfedge_target(embedding.triangles, h)))
                                           .norm();
  return lengths;
}

// ------------------------------------------------------------------------------------------------------
// tiles

TEST(PlaneTile, SidesCloseUpAndCarryTheirPartners) {
  for (const std::string& symbol : all_symbols()) {
    const Target orbifold = parse_orbifold(symbol);
    const Tile tile = basic_tile(orbifold, first_arrangement(orbifold));
    const int n = static_cast<int>(tile.sides.size());
    for (int k = 0; k < n; ++k) {
      const TileSide &side = tile.sides[k], &next = tile.sides[(k + 1) % n],
                     &partner = tile.sides[side.partner];
      EXPECT_NEAR((side.point(side.length) - next.start).norm(), 0, 1e-14) << symbol;
      EXPECT_EQ(side.start.z(), 1);
      for (const double t : {0.0, 0.3, 1.0}) {
        const double s = t * side.length, other = side.partner_reverses() ? side.length - s : s;
        EXPECT_NEAR((side.point(s) - side.transform * partner.point(other)).norm(), 0, 1e-14)
            << symbol << " " << k;
      }
      EXPECT_NEAR((side.transform * partner.transform).difference({}), 0, 1e-14);
      EXPECT_NEAR(side.transform.inverse().difference(partner.transform), 0, 1e-14);
    }
  }
}

TEST(PlaneTile, AnglesAroundAMarkAddUpToItsOrdersShare) {
  for (const std::string& symbol : all_symbols()) {
    const Target orbifold = parse_orbifold(symbol);
    const Tile tile = basic_tile(orbifold, first_arrangement(orbifold));
    std::vector<double> angle(orbifold.marks.size(), 0);
    const std::size_t n = tile.sides.size();
    for (std::size_t k = 0; k < n; ++k)
      angle[tile.sides[k].mark] += Space::plane().angle(tile.sides[k].start, tile.sides[(k + 1) % n].start,
                                                        tile.sides[(k + n - 1) % n].start);
    for (std::size_t m = 0; m < angle.size(); ++m) {
      const double expected =
          (orbifold.marks[m].kind == ConeKind::rotation ? 2 : 1) * pi / orbifold.marks[m].order();
      EXPECT_NEAR(std::remainder(angle[m] - expected, 2 * pi), 0, 1e-12) << symbol << " " << m;
    }
    EXPECT_GT(target_area(orbifold), 0);
  }
}

TEST(PlaneTile, OnlyTheEightFamiliesLieInThePlane) {
  for (const char* symbol : {"3*3", "22*", "22x", "4*2", "2*22", "7", "", "abc"})
    EXPECT_THROW(parse_orbifold(symbol), ArgumentError) << symbol;
  for (const char* symbol : {"532", "22", "*22", "x", "33"})
    EXPECT_EQ(parse_orbifold(symbol).space, Space::sphere()) << symbol;
  for (const auto& symbols : {all_symbols(), free_symbols})
    for (const std::string& symbol : symbols)
      EXPECT_EQ(parse_orbifold(symbol).space, Space::plane()) << symbol;
}

// -------------------------------------------------------------------------------------------------------
// maps

TEST(Plane, EverySymbolIsCertified) {
  for (const WeightKind kind : {WeightKind::cotan, WeightKind::delaunay, WeightKind::uniform}) {
    for (const std::string& symbol : all_symbols()) {
      const Sample s = sample(symbol, with(kind));
      std::string failed;
      for (const Check& check : s.result.certificate.checks)
        if (!check.passed) failed += check.name + ": " + check.detail + "; ";
      EXPECT_TRUE(s.result.certificate.bijective) << symbol << " " << name_of(kind) << " " << failed;
      EXPECT_LT(s.result.certificate.max_seam_residual, 1e-12);
      EXPECT_LT(s.result.minimum.gradient_norm, 1e-11);
      EXPECT_EQ(s.result.embedding.space(), Space::plane());
    }
  }
}

// A map of degree one covers the tile, so E is twice its area at least, and that only where it is conformal.
TEST(Plane, EnergyIsAboveTwiceTheArea) {
  for (const std::string& symbol : all_symbols()) {
    const Sample s = sample(symbol);
    EXPECT_GT(s.result.minimum.energy, 2 * s.result.certificate.signed_area) << symbol;
  }
}

TEST(Plane, TheCutChangesNothing) {
  for (const std::string& symbol : closed_symbols) {
    const Eigen::VectorXd before = edge_lengths(sample(symbol));
    for (const std::uint64_t seed : {1, 2, 3})
      EXPECT_LT((edge_lengths(sample(symbol, with(WeightKind::cotan, seed))) - before).cwiseAbs().maxCoeff(),
                1e-12)
          << symbol << " " << seed;
  }
}

// A mirrored map, and one with a vertex across an edge, are no embeddings.
TEST(Plane, PlantedFaultsAreSeen) {
  const Sample s = sample("442");
  Embedding moved = s.result.embedding, mirrored = moved, lifted = moved;
  int inner = 0;
  while (std::count(moved.source_vertex.begin(), moved.source_vertex.end(), inner) > 1) ++inner;
  moved.positions.row(inner) += Eigen::RowVector3d(1, 0, 0);
  EXPECT_FALSE(certify(test::unjudged(s.mesh), moved).bijective);
  mirrored.positions.col(0) *= -1;
  EXPECT_FALSE(certify(test::unjudged(s.mesh), mirrored).bijective);
  lifted.positions.col(2).array() += 0.1;
  EXPECT_FALSE(certify(test::unjudged(s.mesh), lifted).bijective);
  Embedding sheared = s.result.embedding;
  Matrix3 shear = sheared.seams[0].transform.matrix();
  shear(0, 1) += 0.01;
  sheared.seams[0].transform = Space::plane().isometry(shear);
  EXPECT_FALSE(certify(test::unjudged(s.mesh), sheared).bijective);
  Embedding round = s.result.embedding;
  round.target = parse_orbifold("432");
  EXPECT_FALSE(certify(test::unjudged(s.mesh), round).bijective)
      << "a map into the plane taken for one into the sphere";
}

// ----------------------------------------------------------------------------------------------- exact
// solutions

/// The positions in the mesh's own plane are, up to a similarity, those of the embedding.
void expect_laid_out_as_it_is(const Mesh& mesh, const EmbedResult& result, const std::string& symbol) {
  EXPECT_TRUE(result.certificate.bijective) << symbol;
  const Eigen::VectorXd lengths = edge_lengths({mesh, {}, result});
  const Connectivity connectivity = connectivity_of(mesh.F, test::vertex_count(mesh));
  for (Eigen::Index e = 0; e < lengths.size(); ++e) {
    const auto [i, j] = connectivity.edges[e];
    EXPECT_NEAR(lengths[e], (mesh.V.row(i) - mesh.V.row(j)).norm(), 1e-12) << symbol;
  }
  EXPECT_NEAR(result.distortion.angle.max, 1, 1e-6);
  EXPECT_NEAR(result.distortion.area.max, 1, 1e-6);
}

struct Marked {
  Mesh mesh;
  std::vector<int> corners;
};

/// An equilateral triangle of n^2 triangles, and its corners.
Marked flat_triangle(int n) {
  const Vector3 right(1, 0, 0), up(0.5, std::sqrt(0.75), 0);
  std::vector<Vector3> points;
  std::vector<std::vector<int>> triangles;
  const auto vertex = [n](int i, int j) { return i * (n + 1) - i * (i - 1) / 2 + j; };  // row by row
  for (int i = 0; i <= n; ++i)
    for (int j = 0; i + j <= n; ++j)
      points.push_back(std::sqrt(0.75) / n * (i * right + j * up));  // as large as the tile
  for (int i = 0; i < n; ++i) {
    for (int j = 0; i + j < n; ++j) {
      triangles.push_back({vertex(i, j), vertex(i + 1, j), vertex(i, j + 1)});
      if (i + j + 1 < n) triangles.push_back({vertex(i + 1, j), vertex(i + 1, j + 1), vertex(i, j + 1)});
    }
  }
  return {test::mesh(points, triangles), {vertex(0, 0), vertex(n, 0), vertex(0, n)}};
}

TEST(Plane, TheEquilateralTriangleIsLaidOutAsItIs) {
  const Marked flat = flat_triangle(6);
  const Target orbifold = parse_orbifold("*333");
  expect_laid_out_as_it_is(flat.mesh, embed(flat.mesh, orbifold, flat.corners, with(WeightKind::cotan)),
                           "*333");
}

/// The unit square in 2 n^2 triangles, their diagonals towards the corners, or with `sides` = 2 two of them
/// glued along their boundary.
Marked flat_square(int n, int sides) {
  std::map<std::array<int, 3>, int> index;  // by row, column and side; side 0 for the boundary
  std::vector<Vector3> points;
  std::vector<std::vector<int>> triangles;
  for (int side = 0; side < sides; ++side) {
    const auto vertex = [&](int i, int j) {
      const bool outer = i == 0 || j == 0 || i == n || j == n;
      const auto [at, is_new] = index.try_emplace({i, j, outer ? 0 : side}, static_cast<int>(points.size()));
      if (is_new) points.emplace_back(double(i) / n, double(j) / n, 0);
      return at->second;
    };
    const auto add = [&](int a, int b, int c) {
      triangles.push_back(side == 0 ? std::vector<int>{a, b, c} : std::vector<int>{a, c, b});
    };
    for (int i = 0; i < n; ++i) {
      for (int j = 0; j < n; ++j) {
        const int a = vertex(i, j), b = vertex(i + 1, j), c = vertex(i + 1, j + 1), d = vertex(i, j + 1);
        if ((i + j) % 2 == 0) {
          add(a, b, c), add(a, c, d);
        } else {
          add(a, b, d), add(b, c, d);
        }
      }
    }
  }
  return {test::mesh(points, triangles),
          {index.at({0, 0, 0}), index.at({n, 0, 0}), index.at({n, n, 0}), index.at({0, n, 0})}};
}

/// The half of it below the diagonal.
Marked half_square(int n) {
  Marked result = flat_square(n, 1);
  std::vector<int> above;
  for (int f = 0; f < test::face_count(result.mesh); ++f) {
    const auto v = result.mesh.F.row(f);
    const Eigen::RowVector3d sum =
        result.mesh.V.row(v[0]) + result.mesh.V.row(v[1]) + result.mesh.V.row(v[2]);
    if (sum.y() > sum.x()) above.push_back(f);
  }
  result.mesh = test::without_faces(result.mesh, above);
  result.corners.pop_back();
  result.mesh.V *= std::sqrt(0.5);  // as large as the tile
  return result;
}

TEST(Plane, TheHalfSquareIsLaidOutAsItIs) {
  const Marked flat = half_square(6);
  const Target orbifold = parse_orbifold("*424");
  expect_laid_out_as_it_is(flat.mesh, embed(flat.mesh, orbifold, flat.corners, with(WeightKind::cotan)),
                           "*424");
}

// The doubled square is the quotient of a flat torus.
TEST(Plane, TheSquareAndItsDoubleAreLaidOutAsTheyAre) {
  for (const int sides : {1, 2}) {
    const Marked flat = flat_square(6, sides);
    const std::string symbol = sides == 1 ? "*2222" : "2222";
    const Target orbifold = parse_orbifold(symbol);
    expect_laid_out_as_it_is(flat.mesh, embed(flat.mesh, orbifold, flat.corners, with(WeightKind::cotan)),
                             symbol);
  }
}

}  // namespace
}  // namespace orbitutte::plane_test
