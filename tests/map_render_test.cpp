// SPDX-License-Identifier: MIT
// The sheet of a map between two surfaces.
#include <gtest/gtest.h>

#include <array>
#include <cstdint>
#include <random>
#include <set>

#include "orbitutte/cones/extremities.h"
#include "orbitutte/export/common_view.h"
#include "orbitutte/inspect/recognition.h"
#include "orbitutte/io/image_file.h"
#include "orbitutte/render/map_sheet.h"
#include "orbitutte/render/piece_finder.h"
#include "test_meshes.h"

namespace orbitutte::map_render_test {
namespace {

struct Pair {
  Pair() {
    Mesh mesh = test::perturbed(test::icosphere(2), 0.03, 7);
    a = make_surface(mesh);
    mesh.V.col(0) *= 1.5;
    b = make_surface(mesh);
    std::vector<Landmark> landmarks;
    for (const int v : choose_extremities(a, {3, 0})) landmarks.push_back({v, v});
    map = map_between(a, b, landmarks);
    composed = compose(a, b, map);
  }

  Surface a, b;
  SurfaceMap map;
  ComposedMap composed;
};

const Pair& sample_pair() {
  static const Pair pair;
  return pair;
}

TEST(PieceFinder, FindsThePieceThatHoldsAPoint) {
  const Pair& pair = sample_pair();
  const OverlayPieces pieces = overlay_pieces(pair.composed.overlay);
  const Embedding& a = pair.map.a.embedding;
  const PieceFinder finder(pair.composed.overlay, pieces, a);
  std::mt19937 random(1);
  std::uniform_real_distribution<double> share(0, 1);
  for (int trial = 0; trial < 2000; ++trial) {
    const int t = static_cast<int>(random() % a.triangles.rows());
    Vector3 weights(share(random), share(random), share(random));
    weights /= weights.sum();
    const PiecePoint found = finder.find(t, weights);
    ASSERT_GE(found.piece, 0);
    EXPECT_EQ(pieces.on_a[found.piece], t);
    Vector3 wanted = Vector3::Zero(), here = Vector3::Zero();
    for (int k = 0; k < 3; ++k) {
      wanted += weights[k] * Vector3(pair.a.V.row(a.source_vertex[a.triangles(t, k)]));
      here += found.weights[k] * Vector3(pair.composed.overlay_on_a.row(pieces.triangles(found.piece, k)));
    }
    EXPECT_LT((wanted - here).norm(), 1e-9);
  }
}

TEST(CommonView, FindsTheTurnBetweenCopies) {
  const Points points = Points::Random(50, 3);
  Matrix3 turn = Eigen::AngleAxisd(2, Vector3(1, 2, 3).normalized()).toRotationMatrix();
  const Points turned = 3 * points * turn.transpose();
  EXPECT_LT((best_turn(points, turned) - turn).norm(), 1e-12);
  EXPECT_LT((turn_of_views(points, turned) - turn).norm(), 1e-12);
  EXPECT_EQ(turn_of_views(points, points), Matrix3(Matrix3::Identity()));
  const Points mirrored = -points;
  EXPECT_NEAR(best_turn(points, mirrored).determinant(), 1, 1e-12);
}

TEST(MapSheet, IsAPicture) {
  const Pair& pair = sample_pair();
  MapSheet sheet = {pair.a, pair.b, pair.map, pair.composed, "a.ply", "b.ply"};
  sheet.width = 400;
  const PixelImage image = parse_image(map_sheet_png(sheet));
  EXPECT_EQ(image.width, 400);
  const std::set<std::array<std::uint8_t, 4>> colours(image.pixels.begin(), image.pixels.end());
  EXPECT_GT(colours.size(), 1000U) << "shaded surfaces and scales of colours";
  EXPECT_THROW(write_map_sheet("sheet.svg", sheet), ArgumentError);
  sheet.width = 0;
  EXPECT_THROW(map_sheet_png(sheet), ArgumentError);
}

}  // namespace
}  // namespace orbitutte::map_render_test
