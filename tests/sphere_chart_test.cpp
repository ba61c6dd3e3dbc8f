// SPDX-License-Identifier: MIT
#include <numbers>

#include "orbitutte/cones/chart.h"
#include "orbitutte/geometry/space.h"
#include "sample_embeddings.h"

namespace orbitutte {
namespace {

using std::numbers::pi;
using test::sample_embedding;

// The chord between two points of the Riemann sphere, of diameter 1.
double chord(const ChartPoint& a, const ChartPoint& b) {
  const auto size = [](const ChartPoint& p) {
    return std::sqrt(std::norm(p.numerator) + std::norm(p.denominator));
  };
  return std::abs(bracket(a, b)) / (size(a) * size(b));
}

double charted_area(const Embedding& embedding) {
  const OrbifoldChart chart(embedding);
  double area = 0;
  for (int f = 0; f < embedding.triangles.rows(); ++f) {
    const auto v = embedding.triangles.row(f);
    area += Space::sphere().area(sphere_point(chart.of_vertex(v[0])), sphere_point(chart.of_vertex(v[1])),
                                 sphere_point(chart.of_vertex(v[2])));
  }
  return area;
}

// The embedding turned as a whole, with the placement that says so.
Embedding turned(Embedding embedding, const Isometry& turn) {
  embedding.placement = turn * embedding.placement;
  embedding.positions = turn.on_rows(embedding.positions);
  return embedding;
}

TEST(OrbifoldChart, AllCopiesOfAVertexHaveOnePlace) {
  const Embedding& embedding = sample_embedding("222").embedding();
  const OrbifoldChart chart(embedding);
  int copies = 0;
  for (int v = 0; v < embedding.positions.rows(); ++v) {
    if (embedding.source_vertex[v] == v) continue;
    ++copies;
    EXPECT_LT(chord(chart.of_vertex(v), chart.of_vertex(embedding.source_vertex[v])), 1e-12) << v;
  }
  EXPECT_GT(copies, 5);
}

TEST(OrbifoldChart, CoversTheSphereOnceAndKeepsItsOrientation) {
  EXPECT_NEAR(charted_area(sample_embedding("222").embedding()), 4 * pi, 1e-9);
  EXPECT_NEAR(charted_area(sample_embedding("*222").embedding()), 2 * pi, 1e-9);
}

TEST(OrbifoldChart, ConesLieAtInfinityOneAndZero) {
  for (const std::string signature : {"222", "*222"}) {
    const Embedding& embedding = sample_embedding(signature).embedding();
    const OrbifoldChart chart(embedding);
    const ChartPoint places[] = {{1, 0, nullptr}, {1, 1, nullptr}, {0, 1, nullptr}};
    for (int k = 0; k < 3; ++k)
      for (const int v : embedding.cones[k].copies) EXPECT_LT(chord(chart.of_vertex(v), places[k]), 1e-12);
  }
}

TEST(OrbifoldChart, TheBoundaryOfADiskIsReal) {
  const Embedding& embedding = sample_embedding("*222").embedding();
  const OrbifoldChart chart(embedding);
  for (const Seam& mirror : embedding.seams)
    for (const int v : mirror.left)
      EXPECT_LT(chord(chart.of_vertex(v), conjugate(chart.of_vertex(v))), 1e-12);
}

TEST(OrbifoldChart, DoesNotDependOnThePlacement) {
  const Embedding& embedding = sample_embedding("222").embedding();
  const Embedding moved = turned(embedding, Space::sphere().rotation(Vector3(1, 2, 2) / 3, 0.7));
  const OrbifoldChart chart(embedding), moved_chart(moved);
  for (int v = 0; v < embedding.positions.rows(); ++v)
    EXPECT_LT(chord(chart.of_vertex(v), moved_chart.of_vertex(v)), 1e-12);
}

// A limb beyond doubles at any place: two vertices that differ by offsets alone.
TEST(OrbifoldChart, TellsVerticesApartThatDifferByOffsets) {
  Embedding embedding = sample_embedding("222").embedding();
  const Vector3 p = embedding.positions.row(30), along = Vector3(p.y(), -p.x(), 0).normalized();
  embedding.positions.row(31) = p;
  embedding.positions.row(32) = p;
  embedding.offsets = {{30, -1e-30 * along}, {31, 1e-30 * along}, {32, 3e-30 * along}};
  const OrbifoldChart chart(embedding);
  const ChartPoint a = chart.of_vertex(30), b = chart.of_vertex(31), c = chart.of_vertex(32);
  EXPECT_GT(chord(a, b), 1e-32);
  EXPECT_NEAR(chord(a, c) / chord(a, b), 2, 1e-12);
  EXPECT_NEAR(chord(conjugate(a), conjugate(b)) / chord(a, b), 1, 1e-12);
}

// The derivative of Z vanishes at the cones, where doubles that are added to 1 would be lost.
TEST(OrbifoldChart, TellsVerticesApartNearEachCone) {
  Embedding embedding = sample_embedding("222").embedding();
  for (int axis = 0; axis < 3; ++axis) {
    Vector3 p = Vector3::Unit(axis);
    for (int k = 0; k < 3; ++k) {
      p[(axis + 1) % 3] = k * 1e-20;
      embedding.positions.row(30 + k) = p;
    }
    const OrbifoldChart chart(embedding);
    const ChartPoint a = chart.of_vertex(30), b = chart.of_vertex(31), c = chart.of_vertex(32);
    EXPECT_GT(chord(a, b), 4e-41);
    EXPECT_LT(chord(a, b), 1.1e-40);
    EXPECT_NEAR(chord(a, c) / chord(a, b), 4, 1e-9);
  }
}

TEST(OrbifoldChart, IsMadeFromThatOrbifoldAlone) {
  EXPECT_THROW(OrbifoldChart(sample_embedding("223").embedding()), ArgumentError);
  EXPECT_THROW(OrbifoldChart(sample_embedding("3*2").embedding()), ArgumentError);
}

}  // namespace
}  // namespace orbitutte
