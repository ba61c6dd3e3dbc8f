// SPDX-License-Identifier: MIT
#include "orbitutte/render/short_pieces.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <map>
#include <numbers>
#include <optional>

#include "orbitutte/render/ray_scene.h"

namespace orbitutte::short_pieces_test {
namespace {

// A double pyramid: two vertices of so many edges.
struct Hub {
  Points V;
  Triangles F;
};

Hub hub(int edges) {
  Hub hub = {Points::Zero(edges + 2, 3), Triangles(2 * edges, 3)};
  hub.V.bottomRows(2) << 0, 0, 1, 0, 0, -1;
  for (int k = 0; k < edges; ++k) {
    const double angle = 2 * std::numbers::pi * k / edges;
    hub.V.row(k) << std::cos(angle), std::sin(angle), 0;
    const int next = (k + 1) % edges;
    hub.F.row(2 * k) << k, next, edges;
    hub.F.row(2 * k + 1) << next, k, edges + 1;
  }
  return hub;
}

Vector3 corner(const Pieces& pieces, const Piece& piece, int k) {
  return pieces.positions.row(piece.corners[k]);
}

double area(const Vector3& a, const Vector3& b, const Vector3& c) {
  return 0.5 * (b - a).cross(c - a).norm();
}

TEST(ShortPieces, LeaveStoutTrianglesWhole) {
  const Hub octahedron = hub(4);
  const Pieces pieces = short_pieces(octahedron.V, octahedron.F);
  ASSERT_EQ(pieces.pieces.size(), 8U);
  EXPECT_EQ(pieces.positions, octahedron.V);
  for (int f = 0; f < 8; ++f) EXPECT_EQ(pieces.pieces[f].face, f);
}

// Whether triangles were divided or not.
TEST(RayScene, HitsTrianglesInTheirOwnCoordinates) {
  for (const int edges : {4, 7, 500}) {
    const Hub mesh = hub(edges);
    RayScene scene;
    scene.add_triangles(mesh.V, mesh.F);
    scene.commit();
    int hits = 0;
    for (int k = 0; k < 400; ++k) {
      const Ray ray = {
          {-0.95F + 0.1F * static_cast<float>(k % 20), -0.95F + 0.1F * static_cast<float>(k / 20), 2},
          {0, 0, -1}};
      const std::optional<Hit> hit = scene.first_hit(ray);
      if (!hit) continue;
      const auto corner = [&](int i) {
        return Vector3f(mesh.V.row(mesh.F(hit->primitive, i)).cast<float>());
      };
      const Vector3f place = (1 - hit->u - hit->v) * corner(0) + hit->u * corner(1) + hit->v * corner(2);
      EXPECT_LT((place - (ray.origin + hit->distance * ray.direction)).norm(), 1e-4)
          << edges << " edges, ray " << k;
      ++hits;
    }
    EXPECT_GT(hits, 100);
  }
}

TEST(ShortPieces, CoverEachTriangleOnceOnTheSameSide) {
  const Hub mesh = hub(500);
  const Pieces pieces = short_pieces(mesh.V, mesh.F);
  EXPECT_GT(pieces.pieces.size(), 10000U);
  std::vector<double> covered(mesh.F.rows(), 0.0);
  for (const Piece& piece : pieces.pieces) {
    const auto of_face = [&](int k) -> Vector3 { return mesh.V.row(mesh.F(piece.face, k)); };
    const Vector3 normal = (of_face(1) - of_face(0)).cross(of_face(2) - of_face(0));
    const Vector3 a = corner(pieces, piece, 0), b = corner(pieces, piece, 1), c = corner(pieces, piece, 2);
    EXPECT_GT((b - a).cross(c - a).dot(normal), 0);
    covered[piece.face] += area(a, b, c);
    for (int k = 0; k < 3; ++k) {
      const double u = piece.places[k][0], v = piece.places[k][1];
      const Vector3 place = (1 - u - v) * of_face(0) + u * of_face(1) + v * of_face(2);
      EXPECT_LT((corner(pieces, piece, k) - place).norm(), 1e-6);
    }
  }
  for (int f = 0; f < static_cast<int>(mesh.F.rows()); ++f)
    EXPECT_NEAR(covered[f],
                area(mesh.V.row(mesh.F(f, 0)), mesh.V.row(mesh.F(f, 1)), mesh.V.row(mesh.F(f, 2))), 1e-12);
}

TEST(ShortPieces, MeetTheirNeighboursEdgeToEdge) {
  Hub mesh = hub(300);
  mesh.V.row(300) << 0.9, 0, 1;  // so that triangles are not alike
  const Pieces pieces = short_pieces(mesh.V, mesh.F);
  std::map<std::pair<int, int>, int> faces_at;
  for (const Piece& piece : pieces.pieces)
    for (int k = 0; k < 3; ++k) ++faces_at[{piece.corners[k], piece.corners[(k + 1) % 3]}];
  for (const auto& [edge, count] : faces_at) {
    EXPECT_EQ(count, 1);
    EXPECT_EQ(faces_at.count({edge.second, edge.first}), 1U);
  }
}

}  // namespace
}  // namespace orbitutte::short_pieces_test
