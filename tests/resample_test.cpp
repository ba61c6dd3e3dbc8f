// SPDX-License-Identifier: MIT
// Grids, and values from surfaces to grids and back.
#include "orbitutte/resample/resample.h"

#include <gmock/gmock.h>

#include <Eigen/Geometry>
#include <array>
#include <cmath>
#include <filesystem>
#include <limits>
#include <map>
#include <numbers>
#include <random>
#include <set>
#include <utility>

#include "orbitutte/inspect/recognition.h"
#include "orbitutte/io/mesh_io.h"
#include "orbitutte/map/point_map.h"
#include "orbitutte/mesh/connectivity.h"
#include "orbitutte/orbifold/symmetry_group.h"
#include "sample_embeddings.h"

namespace orbitutte::resample_test {
namespace {

using std::numbers::pi;
using test::sample_embedding;
using testing::HasSubstr;
using testing::ThrowsMessage;

std::vector<std::string> sphere_grids() {
  return {"ico:0",         "ico:4",
          "healpix:1",     "healpix:7",
          "healpix:16",    "healpix-nested:16",
          "octahedral:40", "equirectangular:64x33",
          "cube:1",        "cube:20"};
}

std::vector<std::string> images() { return {"octahedral:40", "equirectangular:64x33", "cube:20"}; }

Points random_directions(int count, unsigned seed) {
  std::mt19937 random(seed);
  std::normal_distribution<double> normal;
  Points points(count, 3);
  for (double& x : points.reshaped()) x = normal(random);
  points.rowwise().normalize();
  return points;
}

/// A sphere that is its own embedding, of 2562 irregular vertices.
Embedding round_sphere() {
  Mesh mesh = test::perturbed(test::icosphere(4), 0.004, 3);
  mesh.V.rowwise().normalize();
  Embedding embedding;
  embedding.target = parse_orbifold("1");
  embedding.positions = mesh.V;
  embedding.triangles = mesh.F;
  for (int v = 0; v < test::vertex_count(mesh); ++v) embedding.source_vertex.push_back(v);
  return embedding;
}

Surface surface_of(const Embedding& embedding) {
  Surface surface;
  surface.V = embedding.positions;
  surface.triangles = embedding.triangles;
  return surface;
}

Eigen::MatrixXd random_values(int rows, int columns) {
  std::mt19937 random(4);
  std::uniform_real_distribution<double> uniform(-1, 2);
  Eigen::MatrixXd values(rows, columns);
  for (double& x : values.reshaped()) x = uniform(random);
  return values;
}

// ---- Grids ----

class SphereGrid : public testing::TestWithParam<std::string> {};

TEST_P(SphereGrid, HasUnitVectorsWhoseCellsFillTheSphere) {
  const Grid grid = make_grid(parse_grid(GetParam()));
  EXPECT_LT((grid.points.rowwise().norm().array() - 1).abs().maxCoeff(), 1e-15);
  EXPECT_GT(grid.areas.minCoeff(), 0);
  EXPECT_NEAR(grid.areas.sum(), 4 * pi, 1e-11);
  EXPECT_LT((grid.points.transpose() * grid.areas).norm(), 0.02);  // centred
}

TEST_P(SphereGrid, HasPointsApartFromEachOther) {
  const Grid grid = make_grid(parse_grid(GetParam()));
  std::set<std::array<long long, 3>> places;
  for (const auto& p : grid.points.rowwise())
    places.insert({std::llround(p.x() * 1e9), std::llround(p.y() * 1e9), std::llround(p.z() * 1e9)});
  EXPECT_EQ(static_cast<int>(places.size()), grid.count());
}

TEST_P(SphereGrid, TrianglesAreAClosedSphere) {
  const Grid grid = make_grid(parse_grid(GetParam()));
  if (grid.triangles.rows() == 0) GTEST_SKIP() << "its values are not linear in triangles";
  const Connectivity connectivity = connectivity_of(grid.triangles, grid.count());
  for (const int opposite : connectivity.opposite) ASSERT_GE(opposite, 0);
  const auto edges = static_cast<Eigen::Index>(connectivity.edges.size());
  EXPECT_EQ(grid.count() - edges + grid.triangles.rows(), 2);
  double area = 0;
  for (const auto& t : grid.triangles.rowwise()) {
    const double one =
        Space::sphere().area(grid.points.row(t[0]), grid.points.row(t[1]), grid.points.row(t[2]));
    EXPECT_GT(one, 0);
    area += one;
  }
  EXPECT_NEAR(area, 4 * pi, 1e-10);
}

INSTANTIATE_TEST_SUITE_P(All, SphereGrid, testing::ValuesIn(sphere_grids()));

TEST(Grids, HaveTheSizesOfTheField) {
  EXPECT_EQ(make_grid(parse_grid("ico:2")).count(), 162);
  EXPECT_EQ(make_grid(parse_grid("ico:7")).count(), 163842);
  EXPECT_EQ(make_grid(parse_grid("healpix:8")).count(), 768);
  EXPECT_EQ(make_grid(parse_grid("equirectangular:512x256")).shape, (std::vector<int>{256, 512}));
  EXPECT_EQ(make_grid(parse_grid("equirectangular:512")).shape, (std::vector<int>{256, 512}));
  EXPECT_EQ(make_grid(parse_grid("cube:8")).shape, (std::vector<int>{6, 8, 8}));
}

TEST(Grids, OfALevelBeginWithThatBefore) {
  const Grid coarse = make_grid(parse_grid("ico:2")), fine = make_grid(parse_grid("ico:3"));
  EXPECT_LT((fine.points.topRows(coarse.count()) - coarse.points).norm(), 1e-14);
}

TEST(Grids, OfASphereFileKeepTheirOrder) {
  const Mesh sphere = test::perturbed(test::icosphere(2), 0.02, 5);
  const Grid grid = sphere_grid(100 * sphere.V, sphere.F);
  EXPECT_LT((grid.points - sphere.V.rowwise().normalized()).norm(), 1e-13);
  Triangles turned = sphere.F;
  turned.col(0).swap(turned.col(1));
  EXPECT_NEAR(sphere_grid(sphere.V, turned).areas.sum(), 4 * pi, 1e-11);
  Points away = sphere.V;
  away.col(0).array() += 5;
  EXPECT_THAT([&] { sphere_grid(away, sphere.F); }, ThrowsMessage<MeshError>(HasSubstr("around the origin")));
}

struct BadGrid {
  std::string text, message;
};

class Unsuitable : public testing::TestWithParam<BadGrid> {};

TEST_P(Unsuitable, GridsAreRefused) {
  EXPECT_THAT([] { parse_grid(GetParam().text); },
              ThrowsMessage<ArgumentError>(HasSubstr(GetParam().message)));
}

INSTANTIATE_TEST_SUITE_P(
    All, Unsuitable,
    testing::Values(BadGrid{"", "ico"}, BadGrid{"ico", "size is missing"}, BadGrid{"ico:", "give its size"},
                    BadGrid{"ico:-1", "give its size"}, BadGrid{"ico:7x", "give its size"},
                    BadGrid{"ico:30", "more than"}, BadGrid{"healpix:0", "at least 1"},
                    BadGrid{"healpix-nested:12", "power of two"}, BadGrid{"equirectangular:511x256", "even"},
                    BadGrid{"equirectangular:x5", "give its size"},
                    BadGrid{"equirectangular:99999999999", "give"}, BadGrid{"octahedral:33", "even"},
                    BadGrid{"sphere:5", "ico"}, BadGrid{"cube:2x2", "give"},
                    BadGrid{"healpix:60000", "more than"}, BadGrid{"periodic:1", "at least 2"}));

// ---- HEALPix ----

// The definition of the nested order: pixel p of a level lies where 4 p .. 4 p + 3 of the next do.
TEST(Healpix, NestedPixelsDivideIntoFour) {
  const Grid coarse = make_grid(parse_grid("healpix-nested:8")),
             fine = make_grid(parse_grid("healpix-nested:16"));
  const double size = std::sqrt(4 * pi / coarse.count());
  for (int p = 0; p < coarse.count(); ++p)
    for (int k = 0; k < 4; ++k)
      EXPECT_LT((fine.points.row(4 * p + k) - coarse.points.row(p)).norm(), 0.6 * size);
}

// Pixels along a ring have one height, and heights fall.
TEST(Healpix, RingsGoFromNorthToSouth) {
  const Grid grid = make_grid(parse_grid("healpix:5"));
  for (int p = 1; p < grid.count(); ++p) EXPECT_LE(grid.points(p, 2), grid.points(p - 1, 2) + 1e-15);
}

// ---- To the grid and back ----

class ThroughTheSphere : public testing::TestWithParam<std::string> {};

// A function that is linear in space is linear in triangles but for their bulge.
TEST_P(ThroughTheSphere, LinearFunctionsComeBack) {
  const Embedding embedding = round_sphere();
  const Grid grid = make_grid(parse_grid(GetParam()));
  if (grid.count() < 1000) GTEST_SKIP() << "too coarse";
  const SparseTable there = table_to_grid(embedding, grid, ResampleKind::linear),
                    back = table_to_surface(embedding, grid, ResampleKind::linear);
  const Eigen::MatrixXd on_grid = apply(there, embedding.positions), again = apply(back, on_grid);
  EXPECT_LT((on_grid - grid.points).cwiseAbs().maxCoeff(), 0.002);
  // The coarsest have 1500 points, of which the poles of the equirectangular one are the least even.
  EXPECT_LT((again - embedding.positions).cwiseAbs().maxCoeff(), 0.02);
  EXPECT_LT((again - embedding.positions).norm() / embedding.positions.norm(), 0.006);
}

TEST_P(ThroughTheSphere, RowsAddUpToOne) {
  const Embedding embedding = round_sphere();
  const Grid grid = make_grid(parse_grid(GetParam()));
  for (const ResampleKind kind : {ResampleKind::linear, ResampleKind::nearest}) {
    const SparseTable there = table_to_grid(embedding, grid, kind),
                      back = table_to_surface(embedding, grid, kind);
    EXPECT_EQ(there.rows(), grid.count());
    EXPECT_EQ(there.columns, embedding.positions.rows());
    EXPECT_LT((row_sums(there).array() - 1).abs().maxCoeff(), 1e-14);
    EXPECT_LT((row_sums(back).array() - 1).abs().maxCoeff(), 1e-14);
    for (const SparseTable* const table : {&there, &back})
      for (const double weight : table->weight) EXPECT_GT(weight, -1e-15);
  }
}

TEST_P(ThroughTheSphere, TheIntegralIsKept) {
  const Embedding embedding = round_sphere();
  Surface surface = surface_of(embedding);
  surface.V.col(0) *= 3;  // another surface than the sphere
  const Grid grid = make_grid(parse_grid(GetParam()));
  const Eigen::VectorXd areas = surface.vertex_areas();
  const ConservativeTables tables = conservative_tables(embedding, grid, areas);
  const Eigen::MatrixXd values = random_values(static_cast<int>(areas.size()), 2);
  const Eigen::MatrixXd on_grid = apply(tables.to_grid, values), back = apply(tables.to_surface, on_grid);
  for (int map = 0; map < 2; ++map) {
    const double before = areas.dot(values.col(map)), scale = areas.dot(values.col(map).cwiseAbs());
    EXPECT_NEAR(tables.cell_areas.dot(on_grid.col(map)), before, 1e-12 * scale);
    EXPECT_NEAR(areas.dot(back.col(map)), before, 1e-12 * scale);
  }
  EXPECT_NEAR(tables.cell_areas.sum(), areas.sum(), 1e-12 * areas.sum());
  EXPECT_GT(tables.cell_areas.minCoeff(), 0);
  // Constants stay, both ways.
  EXPECT_LT((row_sums(tables.to_grid).array() - 1).abs().maxCoeff(), 1e-14);
  EXPECT_LT((row_sums(tables.to_surface).array() - 1).abs().maxCoeff(), 1e-14);
}

INSTANTIATE_TEST_SUITE_P(All, ThroughTheSphere, testing::ValuesIn(sphere_grids()));

// A conservative table is no more than a blur of about a cell.
TEST(Conservative, SmoothFunctionsStay) {
  const Embedding embedding = round_sphere();
  const Grid grid = make_grid(parse_grid("ico:4"));
  const ConservativeTables tables =
      conservative_tables(embedding, grid, surface_of(embedding).vertex_areas());
  EXPECT_LT((apply(tables.to_grid, embedding.positions) - grid.points).cwiseAbs().maxCoeff(), 0.02);
}

// ---- Least squares ----

struct LinearTables {
  SparseTable to_grid, to_surface;
};

LinearTables linear_tables(const Embedding& embedding, const Grid& grid) {
  return {table_to_grid(embedding, grid, ResampleKind::linear),
          table_to_surface(embedding, grid, ResampleKind::linear)};
}

// Where the grid is finer than the surface, even values that change from vertex to vertex come back, and
// smooth ones much better than those that are linear both ways.
TEST(LeastSquares, ComeBackFromAFinerGrid) {
  const Embedding embedding = round_sphere();
  const LinearTables tables = linear_tables(embedding, make_grid(parse_grid("ico:6")));
  const Points& V = embedding.positions;
  const auto off = [&](const Eigen::MatrixXd& on_grid, const Eigen::MatrixXd& values) {
    return (apply(tables.to_surface, on_grid) - values).cwiseAbs().maxCoeff();
  };
  const Eigen::MatrixXd fitted = least_squares_values(tables.to_surface, tables.to_grid, V);
  EXPECT_LT(off(fitted, V), 0.05 * off(apply(tables.to_grid, V), V));
  EXPECT_LT((fitted - apply(tables.to_grid, V)).cwiseAbs().maxCoeff(), 2e-3);
  const Eigen::MatrixXd noise = random_values(static_cast<int>(V.rows()), 2);
  EXPECT_LT(off(least_squares_values(tables.to_surface, tables.to_grid, noise, {60, 1e-12}), noise), 1e-3);
}

// Where it is coarser, the residual is orthogonal to all that the grid can make: P^T (f - P g) = 0.
TEST(LeastSquares, AreNearestFromACoarserGrid) {
  const Embedding embedding = round_sphere();
  const LinearTables tables = linear_tables(embedding, make_grid(parse_grid("ico:2")));
  const Eigen::MatrixXd values = random_values(static_cast<int>(embedding.positions.rows()), 2);
  const Eigen::MatrixXd fitted =
      least_squares_values(tables.to_surface, tables.to_grid, values, {1000, 1e-12});
  const Eigen::MatrixXd residual = values - apply(tables.to_surface, fitted),
                        linear = values - apply(tables.to_surface, apply(tables.to_grid, values));
  EXPECT_LT(apply(transposed(tables.to_surface), residual).norm(), 1e-9 * values.norm());
  EXPECT_LT(residual.norm(), linear.norm());
}

TEST(LeastSquares, KeepConstantsAndLeaveOutWhatIsMissing) {
  const Embedding embedding = round_sphere();
  const LinearTables tables = linear_tables(embedding, make_grid(parse_grid("ico:5")));
  Eigen::MatrixXd values = Eigen::MatrixXd::Constant(embedding.positions.rows(), 1, 0.3);
  const auto fitted = [&] { return least_squares_values(tables.to_surface, tables.to_grid, values); };
  EXPECT_LT((fitted().array() - 0.3).abs().maxCoeff(), 1e-13);
  values(17) = std::numeric_limits<double>::quiet_NaN();
  const Eigen::MatrixXd with_gap = fitted(), linear = apply(tables.to_grid, values);
  for (Eigen::Index k = 0; k < linear.size(); ++k) {
    EXPECT_EQ(std::isnan(with_gap(k)), std::isnan(linear(k)));
    EXPECT_TRUE(std::isnan(linear(k)) || std::abs(with_gap(k) - 0.3) < 1e-13);
  }
  EXPECT_GT(with_gap.array().isNaN().count(), 0);
}

TEST(LeastSquares, AreNoProductWithATable) {
  const Embedding embedding = round_sphere();
  const Grid grid = make_grid(parse_grid("ico:2"));
  EXPECT_THAT([&] { table_to_grid(embedding, grid, ResampleKind::least_squares); },
              ThrowsMessage<ArgumentError>(HasSubstr("least_squares_values")));
  EXPECT_EQ(table_to_surface(embedding, grid, ResampleKind::least_squares).weight,
            table_to_surface(embedding, grid, ResampleKind::linear).weight);
  const SparseTable other = table_to_grid(embedding, make_grid(parse_grid("ico:1")), ResampleKind::linear);
  EXPECT_THAT(
      [&] {
        least_squares_values(table_to_surface(embedding, grid, ResampleKind::linear), other,
                             embedding.positions);
      },
      ThrowsMessage<ArgumentError>(HasSubstr("one surface and one grid")));
}

// Eight labels of octants.
Eigen::VectorXd octants(const Points& points) {
  Eigen::VectorXd labels(points.rows());
  for (Eigen::Index k = 0; k < points.rows(); ++k)
    labels[k] = (points(k, 0) > 0.1) + 2 * (points(k, 1) > 0.2) + 4 * (points(k, 2) > -0.1);
  return labels;
}

TEST(Labels, KeepTheirAreas) {
  const Embedding embedding = round_sphere();
  const Grid grid = make_grid(parse_grid("ico:6"));
  const Eigen::VectorXd labels = octants(embedding.positions), areas = surface_of(embedding).vertex_areas();
  const ConservativeTables tables = conservative_tables(embedding, grid, areas);
  for (const SparseTable& table : {table_to_grid(embedding, grid, ResampleKind::nearest), tables.to_grid}) {
    const Eigen::VectorXd on_grid = apply_to_labels(table, labels);
    for (int label = 0; label < 8; ++label) {
      const double before = (labels.array() == label).select(areas, 0).sum(),
                   after = (on_grid.array() == label).select(tables.cell_areas, 0).sum();
      EXPECT_NEAR(after, before, 0.01 * before);
    }
  }
}

// The areas of labels, those that are wanted over those that are there; 1 for all that are kept.
std::map<double, double> kept_shares(const Eigen::VectorXd& from, const Eigen::VectorXd& from_areas,
                                     const Eigen::VectorXd& to, const Eigen::VectorXd& to_areas) {
  std::map<double, double> before, share;
  for (Eigen::Index k = 0; k < from.size(); ++k) before[from[k]] += from_areas[k];
  for (const auto& [label, area] : before)
    share[label] = (to.array() == label).select(to_areas, 0).sum() / area;
  return share;
}

// Even on a grid of which a cell holds many vertices.
TEST(Labels, KeepTheirAreasNearlyExactlyIfThatIsAskedFor) {
  const Embedding embedding = round_sphere();
  const Eigen::VectorXd labels = octants(embedding.positions), areas = surface_of(embedding).vertex_areas();
  for (const auto& [grid, within] : {std::pair("ico:3", 0.02), std::pair("ico:6", 0.002)}) {
    const ConservativeTables tables = conservative_tables(embedding, make_grid(parse_grid(grid)), areas);
    const Eigen::VectorXd there = labels_keeping_areas(tables.to_grid, labels, {tables.cell_areas, areas}),
                          back = labels_keeping_areas(tables.to_surface, there, {areas, tables.cell_areas});
    for (const auto& [label, share] : kept_shares(labels, areas, there, tables.cell_areas))
      EXPECT_NEAR(share, 1, within) << grid << " " << label;
    for (const auto& [label, share] : kept_shares(there, tables.cell_areas, back, areas))
      EXPECT_NEAR(share, 1, within) << grid << " " << label;
    // A label is taken only by cells that have a part of it.
    const Eigen::MatrixXd one_hot = (labels.array() == 3).cast<double>();
    const Eigen::VectorXd part = apply(tables.to_grid, one_hot);
    for (Eigen::Index k = 0; k < there.size(); ++k) EXPECT_TRUE(there[k] != 3 || part[k] > 0);
  }
}

TEST(Labels, WithoutAreasToTradeAreThoseOfTheLargestWeight) {
  SparseTable table;
  table.columns = 3;
  table.start = {0, 2, 3, 3, 4};
  table.index = {0, 1, 1, 2};
  table.weight = {0.6, 0.4, 1, 1};
  const double none = std::numeric_limits<double>::quiet_NaN();
  const Eigen::VectorXd labels = Eigen::Vector3d(4, 7, none), rows = Eigen::Vector4d(1, 1, 1, 1),
                        columns = Eigen::Vector3d(1, 1, 1);
  const Eigen::MatrixXd result = labels_keeping_areas(table, labels, {rows, columns});
  EXPECT_EQ(result(0), 4);
  EXPECT_EQ(result(1), 7);
  EXPECT_TRUE(std::isnan(result(2)) && std::isnan(result(3)));
  EXPECT_THAT(
      [&] {
        labels_keeping_areas(table, labels, {columns, rows});
      },
      ThrowsMessage<ArgumentError>(HasSubstr("areas of 3 rows and 4 columns")));
}

TEST(Labels, AreNeverMixed) {
  SparseTable table;
  table.columns = 4;
  table.start = {0, 4, 4, 5};
  table.index = {0, 1, 2, 3, 2};
  table.weight = {0.3, 0.4, 0.2, 0.1, 1};
  Eigen::MatrixXd labels(4, 1);
  labels << 5, 9, 5, 7;
  const Eigen::MatrixXd result = apply_to_labels(table, labels);
  EXPECT_EQ(result(0, 0), 5);
  EXPECT_TRUE(std::isnan(result(1, 0)));
  EXPECT_EQ(result(2, 0), 5);
  EXPECT_THAT([&] { apply(table, labels.topRows(2)); },
              ThrowsMessage<ArgumentError>(HasSubstr("2 values for 4")));
}

// For each point, which of so many of the points, spread over their list, is the nearest.
Eigen::VectorXd nearest_of(const Points& points, int count) {
  Eigen::VectorXd nearest(points.rows());
  for (Eigen::Index v = 0; v < points.rows(); ++v) {
    double least = std::numeric_limits<double>::infinity();
    for (int c = 0; c < count; ++c) {
      const double distance = (points.row(v) - points.row(points.rows() * c / count)).squaredNorm();
      if (distance < least) least = distance, nearest[v] = c;
    }
  }
  return nearest;
}

// What a cortex keeps on the icosphere of the field, and back.
TEST(Cortex, KeepsPositionsIntegralAndLabels) {
  const std::string path = std::string(ORBITUTTE_SHARED_DIR) + "/meshes/cortex_icbm152_lh.off";
  if (!std::filesystem::exists(path)) GTEST_SKIP() << path << " is missing";
  const Surface surface = make_surface(read_mesh(path));
  EmbedOptions options;
  options.quotient.centre = Centre::area;
  const Embedding embedding = embed(surface, parse_orbifold("1"), {}, options).embedding;
  const Grid grid = make_grid(parse_grid("ico:7"));
  const Eigen::MatrixXd back = apply(table_to_surface(embedding, grid, ResampleKind::linear),
                                     apply(table_to_grid(embedding, grid, ResampleKind::linear), surface.V));
  const double size = (surface.V.colwise().maxCoeff() - surface.V.colwise().minCoeff()).norm();
  const Eigen::VectorXd off = (back - surface.V).rowwise().norm() / size;
  EXPECT_LT(std::sqrt(off.squaredNorm() / static_cast<double>(off.size())), 5e-4);
  EXPECT_GT((off.array() < 1e-3).cast<double>().mean(), 0.99);
  EXPECT_LT(off.maxCoeff(), 5e-3);  // in folds that the map shrinks below the grid

  // The same by least squares; some vertices lie where many share a point of the grid.
  const LinearTables linear = linear_tables(embedding, grid);
  const Eigen::VectorXd left =
      (apply(linear.to_surface, least_squares_values(linear.to_surface, linear.to_grid, surface.V)) -
       surface.V)
          .rowwise()
          .norm() /
      size;
  EXPECT_LT(std::sqrt(left.squaredNorm() / static_cast<double>(left.size())), 1e-4);
  EXPECT_LT((left.array() > 1e-3).count(), 40);
  EXPECT_LT(left.maxCoeff(), 2.5e-3);

  const Eigen::VectorXd areas = surface.vertex_areas();
  const ConservativeTables tables = conservative_tables(embedding, grid, areas);
  const Eigen::MatrixXd on_grid = apply(tables.to_grid, surface.V);
  for (int c = 0; c < 3; ++c)
    EXPECT_NEAR(tables.cell_areas.dot(on_grid.col(c)), areas.dot(surface.V.col(c)),
                1e-12 * areas.dot(surface.V.col(c).cwiseAbs()));

  // Forty regions, there and back.
  const Eigen::VectorXd labels = nearest_of(surface.V, 40);
  const Eigen::VectorXd there = labels_keeping_areas(tables.to_grid, labels, {tables.cell_areas, areas}),
                        again = labels_keeping_areas(tables.to_surface, there, {areas, tables.cell_areas});
  for (const auto& [label, share] : kept_shares(labels, areas, there, tables.cell_areas))
    EXPECT_NEAR(share, 1, 0.01) << label;
  for (const auto& [label, share] : kept_shares(labels, areas, again, areas))
    EXPECT_NEAR(share, 1, 0.01) << label;

  // Eight large ones keep them by the nearest corner, too.
  const Eigen::VectorXd large = octants(surface.V.rowwise() - surface.V.colwise().mean()),
                        moved = apply_to_labels(table_to_grid(embedding, grid, ResampleKind::nearest), large);
  for (const auto& [label, share] : kept_shares(large, areas, moved, tables.cell_areas))
    EXPECT_NEAR(share, 1, 0.01) << label;
}

// At the next level there are points enough for all.
TEST(Cortex, HasAllPositionsWithinAThousandthByLeastSquares) {
  const std::string path = std::string(ORBITUTTE_SHARED_DIR) + "/meshes/cortex_icbm152_lh.off";
  if (!std::filesystem::exists(path)) GTEST_SKIP() << path << " is missing";
  const Surface surface = make_surface(read_mesh(path));
  const Embedding embedding = embed(surface, parse_orbifold("1"), {}, {}).embedding;
  const LinearTables tables = linear_tables(embedding, make_grid(parse_grid("ico:8")));
  const Eigen::MatrixXd back =
      apply(tables.to_surface, least_squares_values(tables.to_surface, tables.to_grid, surface.V));
  const double size = (surface.V.colwise().maxCoeff() - surface.V.colwise().minCoeff()).norm();
  EXPECT_LT((back - surface.V).rowwise().norm().maxCoeff() / size, 5e-4);
}

// ---- Through orbifolds ----

class OverOrbifolds : public testing::TestWithParam<std::string> {};

// What the walk finds is what the point locator finds, whose signs are exact.
TEST_P(OverOrbifolds, EveryPointOfTheSphereHasTheValueOfItsPlaceOnTheSurface) {
  const Embedding& embedding = sample_embedding(GetParam()).embedding();
  const Points& V = sample_embedding(GetParam()).mesh.V;
  Grid grid = make_grid(parse_grid("ico:3"));
  const Eigen::MatrixXd values = apply(table_to_grid(embedding, grid, ResampleKind::linear), V);
  const SurfacePoints found = PointLocator(embedding).locate(grid.points);
  for (int k = 0; k < grid.count(); ++k) {
    Eigen::RowVector3d expected = Eigen::RowVector3d::Zero();
    for (int i = 0; i < 3; ++i)
      expected +=
          found.barycentric(k, i) * V.row(embedding.source_vertex[embedding.triangles(found.triangle[k], i)]);
    EXPECT_LT((values.row(k) - expected).norm(), 1e-9) << k;
  }
}

TEST_P(OverOrbifolds, TheIntegralIsKept) {
  const test::SampleEmbedding& sample = sample_embedding(GetParam());
  Surface surface;
  surface.V = sample.mesh.V;
  surface.triangles = sample.mesh.F;
  const Eigen::VectorXd areas = surface.vertex_areas();
  const ConservativeTables tables =
      conservative_tables(sample.embedding(), make_grid(parse_grid("healpix:4")), areas);
  const Eigen::MatrixXd values = random_values(static_cast<int>(areas.size()), 1);
  EXPECT_NEAR(tables.cell_areas.dot(apply(tables.to_grid, values).col(0)), areas.dot(values.col(0)),
              1e-12 * areas.sum());
}

INSTANTIATE_TEST_SUITE_P(Some, OverOrbifolds,
                         testing::Values("532", "223", "*332", "2*3", "3*", "3x", "1", "*"));

TEST(OverOrbifolds, PolygonsHaveNoValuesOutside) {
  Embedding embedding = round_sphere();
  embedding.target = parse_orbifold("*");
  embedding.target.marks = {};
  embedding.triangles.conservativeResize(embedding.triangles.rows() / 2, 3);
  const SparseTable table = table_to_grid(embedding, make_grid(parse_grid("ico:3")), ResampleKind::linear);
  const Eigen::MatrixXd values = apply(table, embedding.positions);
  EXPECT_GT(values.array().isNaN().count(), 0);
  EXPECT_LT(values.array().isNaN().count(), values.size());
}

// ---- Images ----

class Image : public testing::TestWithParam<std::string> {};

// Beyond a side lie the pixels that are nearest there: the image with its margin has no larger steps than
// itself.
TEST_P(Image, MarginsHaveNoJump) {
  const Grid grid = make_grid(parse_grid(GetParam()));
  const int images = grid.shape.size() == 3 ? 6 : 1;
  const auto largest_step = [&](int margin, int around) {
    const std::vector<int> points = padded_points(grid, margin), shape = padded_shape(grid, margin);
    const int height = shape[shape.size() - 2], width = shape.back();
    double largest = 0;
    for (int image = 0; image < images; ++image)
      for (int i = 0; i < height; ++i)
        for (int j = 0; j < width; ++j) {
          const auto at = [&](int row, int column) {
            return grid.points.row(points[(static_cast<std::size_t>(image) * height + row) * width + column]);
          };
          // Corners of a cube have no image.
          const auto is_at = [&](int row, int column) {
            return (row >= around && row < height - around) || (column >= around && column < width - around);
          };
          if (!is_at(i, j)) continue;
          if (j + 1 < width && is_at(i, j + 1)) largest = std::max(largest, (at(i, j) - at(i, j + 1)).norm());
          if (i + 1 < height && is_at(i + 1, j))
            largest = std::max(largest, (at(i, j) - at(i + 1, j)).norm());
        }
    return largest;
  };
  EXPECT_LT(largest_step(3, 3), 1.2 * largest_step(0, 0));
}

TEST_P(Image, MarginsOfNothingAreTheImage) {
  const Grid grid = make_grid(parse_grid(GetParam()));
  const std::vector<int> points = padded_points(grid, 0);
  for (int k = 0; k < grid.count(); ++k) EXPECT_EQ(points[k], k);
  EXPECT_THAT([&] { padded_points(grid, 1000); }, ThrowsMessage<ArgumentError>(HasSubstr("margin")));
  EXPECT_THAT([&] { padded_points(grid, -1); }, ThrowsMessage<ArgumentError>(HasSubstr("margin")));
}

INSTANTIATE_TEST_SUITE_P(All, Image, testing::ValuesIn(images()));

TEST(Grids, ThatAreNoImagesHaveNoMargin) {
  EXPECT_THAT([] { padded_points(make_grid(parse_grid("ico:2")), 1); },
              ThrowsMessage<ArgumentError>(HasSubstr("only images")));
}

class FlatImages : public testing::TestWithParam<std::string> {};

// The point of the plane that a pixel is at, also beyond the sides.
Vector3 place_of(const Grid& grid, int row, int column) {
  const FlatImage& flat = grid.flat;
  return flat.lattice * Vector3(flat.across * (column + 0.5) / grid.shape[1],
                                flat.up * (1 - (row + 0.5) / grid.shape[0]), 1);
}

// Values that are found on the surface at the places of a margin are those that it takes from the image.
void expect_margins_as_the_surface_has_them(const std::string& signature, const std::string& request) {
  const test::SampleEmbedding& sample = sample_embedding(signature);
  const Grid grid = make_grid(parse_grid(request), sample.embedding());
  const Eigen::MatrixXd values =
      apply(table_to_grid(sample.embedding(), grid, ResampleKind::linear), sample.mesh.V);
  const int margin = 5;
  const std::vector<int> points = padded_points(grid, margin), shape = padded_shape(grid, margin);
  Grid beyond = grid;
  beyond.points.resize(static_cast<Eigen::Index>(points.size()), 3);
  for (int row = 0; row < shape[0]; ++row)
    for (int column = 0; column < shape[1]; ++column)
      beyond.points.row(static_cast<Eigen::Index>(row) * shape[1] + column) =
          place_of(grid, row - margin, column - margin).transpose();
  const Eigen::MatrixXd expected =
      apply(table_to_grid(sample.embedding(), beyond, ResampleKind::linear), sample.mesh.V);
  double worst = 0;
  for (std::size_t k = 0; k < points.size(); ++k)
    worst = std::max(worst, (values.row(points[k]) - expected.row(static_cast<Eigen::Index>(k))).norm());
  EXPECT_LT(worst, 1e-11) << signature << " " << request;
}

TEST_P(FlatImages, MarginsAreWhatTheGroupHasThere) {
  expect_margins_as_the_surface_has_them(GetParam(), "periodic:24x20");
  if (GetParam() == "442" || GetParam() == "2222" || GetParam() == "*2222")
    expect_margins_as_the_surface_has_them(GetParam(), "tile:24");
}

TEST_P(FlatImages, PeriodicImagesHaveNoJumpAcrossTheirSides) {
  const test::SampleEmbedding& sample = sample_embedding(GetParam());
  const int size = 40;
  const Grid grid = make_grid(parse_grid("periodic:40"), sample.embedding());
  const Eigen::MatrixXd values =
      apply(table_to_grid(sample.embedding(), grid, ResampleKind::linear), sample.mesh.V);
  double inside = 0, across = 0;
  for (int row = 0; row < size; ++row)
    for (int column = 0; column < size; ++column) {
      const double
          right = (values.row(row * size + column) - values.row(row * size + (column + 1) % size)).norm(),
          down = (values.row(row * size + column) - values.row((row + 1) % size * size + column)).norm();
      (column + 1 < size ? inside : across) = std::max(column + 1 < size ? inside : across, right);
      (row + 1 < size ? inside : across) = std::max(row + 1 < size ? inside : across, down);
    }
  EXPECT_LE(across, inside * (1 + 1e-9));
  EXPECT_GT(across, 0);
}

TEST_P(FlatImages, ComeBack) {
  const test::SampleEmbedding& sample = sample_embedding(GetParam());
  for (const std::string& request : {std::string("periodic:200"), std::string("tile:200")}) {
    const bool has_tile = GetParam() == "442" || GetParam() == "2222" || GetParam() == "*2222";
    if (request.starts_with("tile") && !has_tile) continue;
    const Grid grid = make_grid(parse_grid(request), sample.embedding());
    const Eigen::MatrixXd values =
        apply(table_to_grid(sample.embedding(), grid, ResampleKind::linear), sample.mesh.V);
    const Eigen::MatrixXd back =
        apply(table_to_surface(sample.embedding(), grid, ResampleKind::linear), values);
    EXPECT_LT((back - sample.mesh.V).norm() / sample.mesh.V.norm(), 0.03) << request;
  }
}

TEST_P(FlatImages, KeepTheIntegral) {
  const test::SampleEmbedding& sample = sample_embedding(GetParam());
  Surface surface;
  surface.V = sample.mesh.V;
  surface.triangles = sample.mesh.F;
  const Eigen::VectorXd areas = surface.vertex_areas();
  const Grid grid = make_grid(parse_grid("periodic:16"), sample.embedding());
  const ConservativeTables tables = conservative_tables(sample.embedding(), grid, areas);
  const Eigen::MatrixXd values = random_values(static_cast<int>(areas.size()), 1);
  EXPECT_NEAR(tables.cell_areas.dot(apply(tables.to_grid, values).col(0)), areas.dot(values.col(0)),
              1e-12 * areas.sum());
}

INSTANTIATE_TEST_SUITE_P(All, FlatImages,
                         testing::Values("442", "2222", "333", "632", "*442", "*2222", "*632"));

TEST(FlatImages, CoverTheTileAsOftenAsTheGroupHasDirections) {
  const std::map<std::string, int> sheets = {{"442", 4}, {"2222", 2}, {"333", 3}, {"632", 6}, {"*442", 8}};
  for (const auto& [signature, count] : sheets) {
    const Embedding& embedding = sample_embedding(signature).embedding();
    const Grid grid = make_grid(parse_grid("periodic:8"), embedding);
    EXPECT_EQ(static_cast<int>(grid.flat.sheets.size()), count);
    double tile = 0;
    for (const auto& t : embedding.triangles.rowwise())
      tile += embedding.space().area(embedding.positions.row(t[0]), embedding.positions.row(t[1]),
                                     embedding.positions.row(t[2]));
    EXPECT_NEAR(grid.areas.sum(), count * tile, 1e-9 * tile) << signature;
  }
}

TEST(FlatImages, OfATileAreTheLowerLeftPartOfThePeriodicOne) {
  for (const std::string& signature : {std::string("442"), std::string("2222"), std::string("*2222")}) {
    const Embedding& embedding = sample_embedding(signature).embedding();
    const bool is_half = signature == "2222";
    const Grid cell = make_grid(parse_grid("periodic:20x20"), embedding),
               tile = make_grid(parse_grid(is_half ? "tile:10x20" : "tile:10"), embedding);
    const int above = 20 - tile.shape[0];
    for (int row = 0; row < tile.shape[0]; ++row)
      for (int column = 0; column < 10; ++column)
        EXPECT_LT((tile.points.row(row * 10 + column) - cell.points.row((row + above) * 20 + column)).norm(),
                  1e-12);
  }
}

TEST(FlatImages, BelongToThePlane) {
  const Embedding& sphere = sample_embedding("532").embedding();
  const Embedding& plane = sample_embedding("442").embedding();
  EXPECT_THAT([&] { make_grid(parse_grid("periodic:8"), sphere); },
              ThrowsMessage<ArgumentError>(HasSubstr("take a grid of the sphere")));
  EXPECT_THAT([&] { make_grid(parse_grid("ico:2"), plane); },
              ThrowsMessage<ArgumentError>(HasSubstr("take periodic")));
  EXPECT_THAT([&] { make_grid(parse_grid("tile:8"), sample_embedding("333").embedding()); },
              ThrowsMessage<ArgumentError>(HasSubstr("take periodic")));
}

}  // namespace
}  // namespace orbitutte::resample_test
