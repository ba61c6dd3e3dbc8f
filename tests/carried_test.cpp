// SPDX-License-Identifier: MIT
// What a map carries from B to A: textures, colours, values, curves; and the files that these come in.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <set>
#include <string>

#include "orbitutte/cones/extremities.h"
#include "orbitutte/export/carried_files.h"
#include "orbitutte/export/overlay_pieces.h"
#include "orbitutte/export/texture_bake.h"
#include "orbitutte/inspect/recognition.h"
#include "orbitutte/io/curve_file.h"
#include "orbitutte/io/image_file.h"
#include "orbitutte/io/mesh_io.h"
#include "orbitutte/io/texture_file.h"
#include "orbitutte/map/composed_map.h"
#include "orbitutte/map/surface_map.h"
#include "orbitutte/page/map_page.h"
#include "orbitutte/report/overlay_distortion.h"
#include "test_meshes.h"

namespace orbitutte::carried_test {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

// Two surfaces of one shape, a map between them, and textures of both.
struct Pair {
  Pair(Mesh mesh_a, Mesh mesh_b, const std::vector<Landmark>& landmarks)
      : a(make_surface(std::move(mesh_a))),
        b(make_surface(std::move(mesh_b))),
        map(map_between(a, b, landmarks)),
        composed(compose(a, b, map)),
        layout_a(new_texture_layout(map.a.embedding)),
        layout_b(new_texture_layout(map.b.embedding)) {}

  TexturedSurface textured_a() const { return {a, map.a.embedding, layout_a}; }
  TexturedSurface textured_b() const { return {b, map.b.embedding, layout_b}; }

  Surface a, b;
  SurfaceMap map;
  ComposedMap composed;
  TextureLayout layout_a, layout_b;
};

Mesh bumpy_sphere() { return test::perturbed(test::icosphere(3), 0.02, 3); }

Mesh stretched_sphere() {
  Mesh mesh = test::perturbed(test::icosphere(3), 0.02, 5);
  mesh.V.col(0) *= 1.4;
  mesh.V.col(2).array() += 0.2 * mesh.V.col(0).array().square();
  return mesh;
}

std::vector<Landmark> landmarks_on(const Mesh& mesh, int count) {
  const Surface surface = make_surface(mesh);
  std::vector<Landmark> landmarks;
  for (const int v : choose_extremities(surface, {count, 0})) landmarks.push_back({v, v});
  return landmarks;
}

const Pair& stretched_pair() {
  static const Pair pair(bumpy_sphere(), stretched_sphere(), landmarks_on(bumpy_sphere(), 4));
  return pair;
}

const Pair& identical_pair() {
  static const Pair pair(bumpy_sphere(), bumpy_sphere(), landmarks_on(bumpy_sphere(), 3));
  return pair;
}

// Smooth, and different everywhere.
PixelImage smooth_picture(int side) {
  PixelImage picture = {side, side, {}};
  for (int row = 0; row < side; ++row)
    for (int column = 0; column < side; ++column) {
      const auto wave = [&](double x) {
        return static_cast<std::uint8_t>(std::lround(127 + 100 * std::sin(x / side)));
      };
      picture.pixels.push_back({wave(5.0 * column), wave(4.0 * row), wave(3.0 * (row + column)), 255});
    }
  return picture;
}

// The pixel at texture coordinates.
Pixel pixel_at(const PixelImage& picture, const Eigen::RowVector2d& uv) {
  const auto place = [](double share, int count) {
    return std::clamp(static_cast<int>(share * count), 0, count - 1);
  };
  return picture.at(place(uv[0], picture.width), place(1 - uv[1], picture.height));
}

int difference(const Pixel& first, const Pixel& second) {
  int largest = 0;
  for (int k = 0; k < 4; ++k) largest = std::max(largest, std::abs(first[k] - second[k]));
  return largest;
}

TEST(BakedTexture, OfTheIdentityIsTheTextureItself) {
  const Pair& pair = identical_pair();
  const PixelImage picture = smooth_picture(128),
                   baked = bake_texture(pair.composed.overlay, pair.textured_a(), pair.textured_b(), picture,
                                        {128, 128});
  for (const int row : pair.layout_a.of_corner) {
    const Eigen::RowVector2d uv = pair.layout_a.uv.row(row);
    EXPECT_LE(difference(pixel_at(baked, uv), pixel_at(picture, uv)), 6) << uv;
  }
}

// The vertices of both banks of the seams of an embedding.
std::set<int> seam_vertices(const Embedding& embedding) {
  std::set<int> vertices;
  for (const Seam& seam : embedding.seams)
    for (const std::vector<int>* bank : {&seam.left, &seam.right})
      vertices.insert(bank->begin(), bank->end());
  return vertices;
}

// Does a triangle of an embedding touch its seams, where its own texture breaks off?
bool touches_seams(const Embedding& embedding, int triangle, const std::set<int>& on_seams) {
  for (int k = 0; k < 3; ++k)
    if (on_seams.contains(embedding.triangles(triangle, k))) return true;
  return false;
}

TEST(BakedTexture, HasAtAVertexTheColourOfItsImage) {
  const Pair& pair = stretched_pair();
  const PixelImage picture = smooth_picture(256),
                   baked = bake_texture(pair.composed.overlay, pair.textured_a(), pair.textured_b(), picture,
                                        {512, 512});
  const Triangles rows_a = texture_triangles(pair.a, pair.layout_a),
                  rows_b = texture_triangles(pair.b, pair.layout_b);
  const VertexMap& images = pair.composed.a_to_b;
  const Embedding& b = pair.map.b.embedding;
  const std::set<int> on_seams_of_b = seam_vertices(b);
  int seen = 0;
  for (int t = 0; t < pair.a.triangle_count(); ++t) {
    const int v = pair.a.triangles(t, 0), on_b = images.images.triangle[v];
    if (touches_seams(b, on_b, on_seams_of_b)) continue;
    ++seen;
    Eigen::RowVector2d uv = Eigen::RowVector2d::Zero();
    for (int k = 0; k < 3; ++k) uv += images.images.barycentric(v, k) * pair.layout_b.uv.row(rows_b(on_b, k));
    EXPECT_LE(difference(pixel_at(baked, pair.layout_a.uv.row(rows_a(t, 0))), pixel_at(picture, uv)), 12)
        << "vertex " << v;
  }
  EXPECT_GT(seen, pair.a.triangle_count() / 2);
}

TEST(BakedTexture, AgreesOnBothBanksOfASeamOfA) {
  const Pair& pair = stretched_pair();
  const PixelImage baked = bake_texture(pair.composed.overlay, pair.textured_a(), pair.textured_b(),
                                        smooth_picture(256), {512, 512});
  const Embedding &a = pair.map.a.embedding, &b = pair.map.b.embedding;
  const std::set<int> on_seams_of_b = seam_vertices(b);
  int seen = 0;
  for (const Seam& seam : a.seams)
    for (std::size_t k = 0; k < seam.left.size(); ++k) {
      const int v = a.source_vertex[seam.left[k]], on_b = pair.composed.a_to_b.images.triangle[v];
      if (touches_seams(b, on_b, on_seams_of_b)) continue;
      EXPECT_LE(difference(pixel_at(baked, pair.layout_a.uv.row(seam.left[k])),
                           pixel_at(baked, pair.layout_a.uv.row(seam.right[k]))),
                12);
      ++seen;
    }
  EXPECT_GT(seen, 5);
}

// Far from all faces, too.
TEST(BakedTexture, IsPaddedEverywhere) {
  const Pair& pair = stretched_pair();
  const PixelImage red = {4, 4, std::vector<Pixel>(16, Pixel{200, 10, 20, 255})};
  const PixelImage baked =
      bake_texture(pair.composed.overlay, pair.textured_a(), pair.textured_b(), red, {64, 48});
  for (const Pixel& pixel : baked.pixels) EXPECT_LE(difference(pixel, {200, 10, 20, 255}), 1);
}

TEST(BakedTexture, RefusesAChartThatLiesOnItself) {
  const Pair& pair = stretched_pair();
  TextureLayout folded = pair.layout_a;
  for (Eigen::Index k = 0; k < folded.uv.rows(); ++k) folded.uv(k, 0) = std::abs(folded.uv(k, 0) - 0.5);
  const PixelImage picture = smooth_picture(16);
  const TexturedSurface a = {pair.a, pair.map.a.embedding, folded};
  EXPECT_THROW(bake_texture(pair.composed.overlay, a, pair.textured_b(), picture, {64, 64}), ArgumentError);
  EXPECT_THROW(bake_texture(pair.composed.overlay, pair.textured_a(), pair.textured_b(), picture, {0, 64}),
               ArgumentError);
  TextureLayout short_one = pair.layout_b;
  short_one.of_corner.pop_back();
  EXPECT_THROW(bake_texture(pair.composed.overlay, pair.textured_a(),
                            {pair.b, pair.map.b.embedding, short_one}, picture, {64, 64}),
               MeshError);
}

TEST(OverlayPieces, HaveTheirCornersInTheirTrianglesOfBothSurfaces) {
  const Pair& pair = stretched_pair();
  const OverlayPieces pieces = overlay_pieces(pair.composed.overlay);
  const auto place = [](const Surface& surface, const Embedding& embedding, int t, const Vector3& weights) {
    Vector3 at = Vector3::Zero();
    for (int k = 0; k < 3; ++k)
      at += weights[k] * Vector3(surface.V.row(embedding.source_vertex[embedding.triangles(t, k)]));
    return at;
  };
  for (int p = 0; p < pieces.count(); ++p)
    for (int k = 0; k < 3; ++k) {
      const int v = pieces.triangles(p, k), on_a = pieces.on_a[p], on_b = pieces.on_b[p];
      const Embedding &a = pair.map.a.embedding, &b = pair.map.b.embedding;
      const Overlay& overlay = pair.composed.overlay;
      const Vector3 at_a = place(pair.a, a, on_a, coordinates_in(a, overlay.on_a, v, on_a)),
                    at_b = place(pair.b, b, on_b, coordinates_in(b, overlay.on_b, v, on_b));
      EXPECT_LT((at_a - Vector3(pair.composed.overlay_on_a.row(v))).norm(), 1e-9);
      EXPECT_LT((at_b - Vector3(pair.composed.overlay_on_b.row(v))).norm(), 1e-9);
    }
}

TEST(OverlayDistortion, HasTheMeanOfTheWholeMap) {
  const Pair& pair = stretched_pair();
  const OverlayPieces pieces = overlay_pieces(pair.composed.overlay);
  const Points &from = pair.composed.overlay_on_a, &to = pair.composed.overlay_on_b;
  const std::vector<PieceDistortion> values = piece_distortions(pieces.triangles, from, to);
  double sum = 0, measured = 0, area_on_b = 0;
  for (int p = 0; p < pieces.count(); ++p) {
    const Vector3 a = from.row(pieces.triangles(p, 0)), b = from.row(pieces.triangles(p, 1)),
                  c = from.row(pieces.triangles(p, 2));
    const double area = (b - a).cross(c - a).norm();
    if (!std::isfinite(values[p].symmetric_dirichlet)) continue;
    EXPECT_GE(values[p].symmetric_dirichlet, 1 - 1e-6);
    sum += area * values[p].symmetric_dirichlet;
    area_on_b += area * values[p].area;
    measured += area;
  }
  const double mean = pair.composed.distortion.symmetric_dirichlet.mean;
  EXPECT_NEAR(sum / measured, mean, 1e-6 * mean);
  EXPECT_NEAR(area_on_b / measured, 1, 1e-6) << "both surfaces have area one";
}

TEST(CarriedColours, AreThoseOfThePartnersAtLandmarks) {
  const Pair& pair = stretched_pair();
  const Points colours = shown_colours(pair.b);
  EXPECT_GE(colours.minCoeff(), 0);
  EXPECT_LE(colours.maxCoeff(), 1);
  const Eigen::MatrixXd on_a = transfer(pair.composed.a_to_b, colours);
  for (const Landmark& landmark : pair.map.landmarks)
    EXPECT_EQ(on_a.row(landmark.a), colours.row(landmark.b));
  for (const std::string ending : {"ply", "obj"}) {
    const std::string name = "a." + ending;
    const PolygonMesh read = parse_mesh_file(name, coloured_mesh(name, pair.a, on_a));
    EXPECT_EQ(read.V, pair.a.V);
    EXPECT_LT((read.colours - on_a).cwiseAbs().maxCoeff(), 1.0 / 255);
    EXPECT_EQ(read.face_count(), pair.a.triangle_count());
  }
  EXPECT_THROW(coloured_mesh("a.stl", pair.a, on_a), ArgumentError);
}

TEST(CarriedCurves, OfTheIdentityPassThroughTheSameVertices) {
  const Pair& pair = identical_pair();
  const int v = pair.b.triangles(0, 0), w = pair.b.triangles(0, 1);
  const Embedding &a = pair.map.a.embedding, &b = pair.map.b.embedding;
  const Points curve = positions_on(pair.a.V, a, image_of_polyline(b, a, points_at_vertices(b, {v, w})));
  ASSERT_GE(curve.rows(), 2);
  EXPECT_LT((curve.row(0) - pair.a.V.row(v)).norm(), 1e-6);
  EXPECT_LT((curve.row(curve.rows() - 1) - pair.a.V.row(w)).norm(), 1e-6);
  EXPECT_THROW(points_at_vertices(b, {v, static_cast<int>(pair.b.V.rows())}), ArgumentError);
  EXPECT_THAT(curves_obj({curve}), HasSubstr("\nl 1 2"));
}

TEST(MorphFrames, BeginOnAAndEndOnB) {
  const std::vector<std::string> paths = frame_paths("folder/morph.ply", 3);
  EXPECT_EQ(paths,
            (std::vector<std::string>{"folder/morph_00.ply", "folder/morph_01.ply", "folder/morph_02.ply"}));
  const Pair& pair = stretched_pair();
  const Morph morph = morph_of(pair.composed.overlay, pair.composed.overlay_on_a, pair.composed.overlay_on_b);
  const std::string path = testing::TempDir() + "carried_morph.ply";
  write_morph_frames(path, morph, 3);
  EXPECT_EQ(read_mesh(frame_paths(path, 3).front()).V, pair.composed.overlay_on_a);
  EXPECT_EQ(read_mesh(frame_paths(path, 3).back()).V, pair.composed.overlay_on_b);
  EXPECT_THROW(frame_paths(path, 1), ArgumentError);
}

TEST(ImageFile, OfAPngIsReadAsItWasWritten) {
  PixelImage picture = smooth_picture(17);
  EXPECT_EQ(parse_image(png_bytes(picture)).pixels, picture.pixels);
  picture.pixels[5][3] = 77;
  const std::string bytes = png_bytes(picture);
  EXPECT_EQ(parse_image(bytes).pixels, picture.pixels);
  EXPECT_THROW(parse_image(bytes.substr(0, bytes.size() / 2)), FileError);
  EXPECT_THROW(parse_image("\xff\xd8\xff\xe0 no JPEG"), FileError);
  EXPECT_THROW(parse_image("GIF89a"), FileError);
  picture.pixels.pop_back();
  EXPECT_THROW(png_bytes(picture), ArgumentError);
}

TEST(TextureFile, IsReadAsItWasWritten) {
  const Pair& pair = stretched_pair();
  const std::string obj = textured_obj(pair.a, pair.layout_a, "a.mtl");
  const std::optional<TextureLayout> read = parse_obj_texture(obj);
  ASSERT_TRUE(read);
  EXPECT_EQ(read->of_corner, pair.layout_a.of_corner);
  EXPECT_EQ(read->uv, pair.layout_a.uv);
  EXPECT_EQ(parse_mesh(obj, MeshFormat::obj).V, pair.a.V);
}

std::string texture_refusal(const std::string& text) {
  try {
    parse_obj_texture(text);
  } catch (const MeshError& error) {
    return error.what();
  }
  return "";
}

TEST(TextureFile, KnowsAllKindsOfCorners) {
  const std::string head = "v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt 1 0 0\nvt 0.5 1\n";
  for (const std::string face : {"f 1/1 2/2 3/3", "f 1/1/1 2/2/1 3/3/1", "f -3/-3 -2/-2 -1/-1"}) {
    const auto layout = parse_obj_texture(head + face + "\n");
    ASSERT_TRUE(layout) << face;
    EXPECT_EQ(layout->of_corner, (std::vector<int>{0, 1, 2})) << face;
  }
  EXPECT_FALSE(parse_obj_texture(head + "f 1 2 3\n"));
  EXPECT_FALSE(parse_obj_texture(head + "f 1//1 2//1 3//1\n"));
  EXPECT_THAT(texture_refusal(head + "f 1/1 2 3/3\n"), HasSubstr("line 7"));
  EXPECT_THAT(texture_refusal(head + "f 1/0 2/2 3/3\n"), HasSubstr("texture index 0"));
  EXPECT_THAT(texture_refusal(head + "f 1/1 2/2 3/4\n"), HasSubstr("only 3 lines"));
  EXPECT_THAT(texture_refusal("vt x 0\n"), HasSubstr("line 1"));
}

TEST(CurveFile, HasACurveALine) {
  const std::vector<std::vector<int>> curves = {{1, 2, 3}, {5, 6}};
  EXPECT_EQ(parse_curves("1 2 3\n# a remark\n\n5,6\n"), curves);
  EXPECT_THROW(parse_curves("4\n"), MeshError);
  EXPECT_THROW(parse_curves("1 2.5\n"), MeshError);
}

TEST(MapPage, HoldsTheSceneAndNothingHostile) {
  const Pair& pair = stretched_pair();
  const std::string hostile = R"(a"'><img src=x onerror=alert(1)></script>{{style}})";
  const MapPageSubject subject = {pair.a, pair.b, pair.map, pair.composed, hostile, "b.ply"};
  const nlohmann::json scene = nlohmann::json::parse(map_scene(subject));
  EXPECT_EQ(scene["vertices"], pair.composed.overlay.vertex_count());
  EXPECT_EQ(scene["landmarks"].size(), pair.map.landmarks.size());
  for (std::size_t k = 0; k < pair.map.landmarks.size(); ++k) {
    const OverlayVertex& at = pair.composed.overlay.vertices[scene["landmarks"][k]["at"].get<int>()];
    EXPECT_EQ(at.a_vertex, pair.map.landmarks[k].a);
    EXPECT_EQ(at.b_vertex, pair.map.landmarks[k].b);
  }
  EXPECT_THAT(map_scene(subject), Not(HasSubstr("<")));
  const std::string page = map_page(subject);
  EXPECT_THAT(page, HasSubstr("Certified bijective"));
  EXPECT_THAT(page, Not(HasSubstr("<img")));
  EXPECT_THAT(page, HasSubstr("{{style}}"));
}

}  // namespace
}  // namespace orbitutte::carried_test
