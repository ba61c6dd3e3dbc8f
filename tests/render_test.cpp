// SPDX-License-Identifier: MIT
#include "orbitutte/render/render.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <Eigen/Geometry>
#include <cmath>
#include <filesystem>
#include <functional>
#include <map>
#include <numbers>
#include <numeric>
#include <regex>
#include <set>

#include "orbitutte/export/palette.h"
#include "orbitutte/io/file.h"
#include "orbitutte/io/image_file.h"
#include "orbitutte/page/svg_chart.h"
#include "orbitutte/parallel.h"
#include "orbitutte/render/chart_drawing.h"
#include "orbitutte/render/checkerboard.h"
#include "orbitutte/render/colour_table.h"
#include "orbitutte/render/default_view.h"
#include "orbitutte/render/exposure_grid.h"
#include "orbitutte/render/sphere_figure.h"
#include "orbitutte/report/charts.h"
#include "orbitutte/report/comparison.h"
#include "sample_embeddings.h"

// Cairo keeps fonts until the program ends, in fontconfig's memory: the leak sanitizer should not count them.
// It calls this function; without sanitizers nobody does.
extern "C" const char* __lsan_default_suppressions() { return "leak:libfontconfig\n"; }

namespace orbitutte::render_test {
namespace {

using test::icosphere;
using test::sample_embedding;
using testing::HasSubstr;

std::vector<std::string> one_signature_of_each_family() {
  return {"532", "432", "332", "223", "33", "*532", "*432", "*332", "*223", "*33", "3*2", "2*3", "5*", "3x"};
}

Report report_of(const EmbedResult& result) {
  Report report;
  report.signature = result.embedding.target.signature;
  report.group_order = result.embedding.target.group_order;
  report.seams = result.embedding.seams;
  report.cones = result.embedding.cones;
  report.energy = result.minimum.energy;
  report.history = result.minimum.history;
  report.bijective = result.certificate.bijective;
  return report;
}

/// What a picture is made of, with the report that it refers to.
struct Subject {
  const test::SampleEmbedding& sample;
  Surface surface = test::unjudged(sample.mesh);
  Report report = report_of(sample.result);

  explicit Subject(const std::string& signature) : sample(sample_embedding(signature)) {}
  RenderSubject get() const { return {surface, sample.embedding(), report, "sample"}; }
};

RenderOptions options_of(Panel panel, int width, int height) {
  RenderOptions options;
  options.panel = panel;
  options.width = width, options.height = height;
  return options;
}

/// A decoded picture.
struct Picture {
  int width = 0, height = 0;
  std::vector<std::uint8_t> bytes;  // red, green, blue

  explicit Picture(const std::string& png) {
    const PixelImage image = parse_image(png);
    width = image.width;
    height = image.height;
    bytes.reserve(3 * image.pixels.size());
    for (const Pixel& pixel : image.pixels) bytes.insert(bytes.end(), pixel.begin(), pixel.begin() + 3);
  }

  bool is_paper(int column, int row) const {
    const std::uint8_t* const pixel = &bytes[3 * (static_cast<std::size_t>(row) * width + column)];
    return pixel[0] == 255 && pixel[1] == 255 && pixel[2] == 255;
  }

  /// The box of all that is not paper: left, top, right, bottom, inclusive.
  std::array<int, 4> inked_box() const {
    std::array<int, 4> box = {width, height, -1, -1};
    for (int row = 0; row < height; ++row)
      for (int column = 0; column < width; ++column)
        if (!is_paper(column, row))
          box = {std::min(box[0], column), std::min(box[1], row), std::max(box[2], column),
                 std::max(box[3], row)};
    return box;
  }

  double inked_share() const {
    double count = 0;
    for (int row = 0; row < height; ++row)
      for (int column = 0; column < width; ++column) count += is_paper(column, row) ? 0 : 1;
    return count / (static_cast<double>(width) * height);
  }
};

double mean_difference(const Picture& a, const Picture& b) {
  double sum = 0;
  for (std::size_t k = 0; k < a.bytes.size(); ++k) sum += std::abs(int{a.bytes[k]} - int{b.bytes[k]});
  return sum / static_cast<double>(a.bytes.size());
}

TEST(Render, EveryPanelOfEveryFamilyShowsSomething) {
  for (const std::string& signature : one_signature_of_each_family()) {
    const Subject subject(signature);
    for (const Panel panel : {Panel::source, Panel::sphere, Panel::area, Panel::angle, Panel::checkerboard,
                              Panel::histogram, Panel::convergence}) {
      const Picture picture(render_png(subject.get(), options_of(panel, 80, 72)));
      EXPECT_EQ(picture.width, 80);
      EXPECT_EQ(picture.height, 72);
      EXPECT_GT(picture.inked_share(), 0.03) << signature << " " << name_of(panel);
      EXPECT_LT(picture.inked_share(), 0.99) << signature << " " << name_of(panel);
    }
  }
}

TEST(Render, FigureFillsTheFrame) {
  for (const std::string signature : {"432", "*432", "3x"}) {
    const Subject subject(signature);
    for (const Panel panel : {Panel::source, Panel::sphere, Panel::checkerboard}) {
      const Picture picture(render_png(subject.get(), options_of(panel, 240, 200)));
      const auto [left, top, right, bottom] = picture.inked_box();
      const double filled = std::max((right - left + 1) / 240.0, (bottom - top + 1) / 200.0);
      EXPECT_GT(filled, 0.75) << signature << " " << name_of(panel);
      EXPECT_LT(filled, 0.96) << signature << " " << name_of(panel);
      EXPECT_NEAR(left + right, 240, 24);
      EXPECT_NEAR(top + bottom, 200, 24);
    }
  }
}

TEST(Render, SameBytesOnEveryRunAndForAnyNumberOfThreads) {
  const Subject subject("*332");
  const RenderOptions options = options_of(Panel::sheet, 480, 400);
  const auto png = [&] { return render_png(subject.get(), options); };
  const std::string first = with_threads(1, png);
  EXPECT_TRUE(with_threads(1, png) == first);
  EXPECT_TRUE(with_threads(2, png) == first);
  const RenderOptions plot = options_of(Panel::histogram, 300, 200);
  EXPECT_TRUE(render_svg(subject.get(), plot) == render_svg(subject.get(), plot));
}

TEST(Render, TurningMeshAndViewTogetherLeavesThePicture) {
  const Subject subject("223");
  RenderOptions options = options_of(Panel::source, 160, 160);
  options.view = Vector3(0.3, 0.4, 1), options.up = Vector3::UnitY();
  const Picture picture(render_png(subject.get(), options));

  const Matrix3 R = Eigen::AngleAxisd(1.1, Vector3(1, 2, 3).normalized()).toRotationMatrix();
  Mesh turned = subject.sample.mesh;
  turned.V = turned.V * R.transpose();
  options.view = R * *options.view, options.up = R * *options.up;
  const Picture same(
      render_png({test::unjudged(turned), subject.sample.embedding(), subject.report, ""}, options));
  EXPECT_LT(mean_difference(picture, same), 3);
  options.view = -*options.view;
  const Picture other(
      render_png({test::unjudged(turned), subject.sample.embedding(), subject.report, ""}, options));
  EXPECT_GT(mean_difference(picture, other), 3);
}

TEST(Render, SphereHasARoundOutline) {
  const Subject subject("*532");
  const SphereFigure sphere(subject.sample.embedding(),
                            std::vector<float>(subject.sample.embedding().source_vertex.size(), 1));
  const Camera camera = sphere_camera(subject.sample.embedding(), {}, {101, 101}, 0.9);
  Ornaments none;
  none.commit();
  const Image image = sphere.draw(camera, none);
  for (int row = 0; row < 101; ++row)
    for (int column = 0; column < 101; ++column) {
      const double radius = std::hypot(column - 50.0, row - 50.0) * camera.pixel;
      if (radius < 1 - camera.pixel) EXPECT_EQ(image.at(column, row)[3], 1);
      if (radius > 1 + camera.pixel) EXPECT_EQ(image.at(column, row)[3], 0);
    }
}

TEST(Render, SphereShowsTheTileInItsMiddle) {
  for (const std::string signature : {"432", "*223", "33", "5*", "3x"}) {
    const Embedding& embedding = sample_embedding(signature).embedding();
    const SphereFigure sphere(embedding, std::vector<float>(embedding.source_vertex.size(), 1));
    const Camera camera =
        sphere_camera(embedding, {tile_centre(embedding), Vector3(0.1, 0.2, 0.9)}, {31, 31}, 0.9);
    Ornaments none;
    none.commit();
    const Rgba middle = sphere.draw(camera, none).at(15, 15);
    EXPECT_GT(middle[2], 1.5F * middle[0]) << signature << ": the bold colour is blue, its copies are pale";
  }
}

/// Where a ray from outside straight down to the sphere meets an ornament: its height over the sphere.
std::optional<double> height_of_ornament(const Ornaments& ornaments, const Vector3& point) {
  const Vector3f down = -point.cast<float>();
  const auto hit = ornaments.first_hit({-2 * down, down});
  if (!hit) return std::nullopt;
  return 1.0 - hit->distance;
}

TEST(Render, SeamsStandOutOfTheSphereAllAlongTheirArcs) {
  Embedding embedding = sample_embedding("5*").embedding();
  // An arc of a quarter of a great circle, as next to cones that the map shrinks to.
  embedding.positions.conservativeResize(2, 3);
  embedding.positions << 1, 0, 0, 0, 1, 0;
  embedding.triangles.resize(0, 3);
  embedding.seams.resize(1);
  embedding.seams[0].left = embedding.seams[0].right = {0, 1};
  embedding.cones.clear();
  const Ornaments ornaments = sphere_ornaments(embedding, {}, sphere_camera(embedding, {}, {200, 200}, 0.9));
  for (int k = 0; k <= 40; ++k) {
    const double angle = k * std::numbers::pi / 80;
    const auto height = height_of_ornament(ornaments, {std::cos(angle), std::sin(angle), 0});
    ASSERT_TRUE(height) << k;
    EXPECT_GT(*height, 0.7 * seam_radius(embedding.target)) << k;
  }
}

TEST(Render, BallsOfTheNearSideAreSeenWhole) {
  Embedding embedding = sample_embedding("5*").embedding();
  embedding.cones.resize(1);
  embedding.cones[0].copies = {0};
  embedding.seams.clear();
  const Camera camera = sphere_camera(embedding, {}, {200, 200}, 0.9);
  const double radius = ball_radius(embedding, camera.pixel);
  EXPECT_GT(radius / camera.pixel, 6) << "large enough for its number";
  for (const double colatitude : {0.0, 0.6, 1.1, 1.4}) {
    embedding.positions.row(0) << std::sin(colatitude), 0, std::cos(colatitude);
    const Ornaments ornaments = sphere_ornaments(embedding, {}, camera);
    for (int k = 0; k < 12; ++k) {
      const double angle = k * std::numbers::pi / 6;
      const Eigen::Vector2d place = Eigen::Vector2d(std::sin(colatitude), 0) +
                                    0.9 * radius * Eigen::Vector2d(std::cos(angle), std::sin(angle));
      const Ray ray = {Vector3f(static_cast<float>(place[0]), static_cast<float>(place[1]), 3),
                       -Vector3f::UnitZ()};
      const auto ball = ornaments.first_hit(ray);
      ASSERT_TRUE(ball) << colatitude << " " << k;
      if (place.norm() < 1)
        EXPECT_LT(ball->distance, 3 - std::sqrt(1 - place.squaredNorm())) << colatitude << " " << k;
    }
  }
}

TEST(Render, AMapOntoAPolygonIsShownAlone) {
  Embedding embedding = sample_embedding("*532").embedding();
  embedding.seams.clear();
  embedding.target.group_order = 1;
  const SphereFigure sphere(embedding, std::vector<float>(embedding.source_vertex.size(), 1));
  EXPECT_EQ(sphere.copies().size(), 1U);
}

/// A comparison of maps whose triangles have these log2 A, on a mesh of as many triangles.
std::string compared(const std::vector<std::vector<double>>& log_areas, const std::string& ending) {
  Mesh mesh = icosphere(2);
  mesh.V.rightCols(2) *= 0.08;  // few pixels to shade
  const Surface surface = test::unjudged(mesh);
  Comparison comparison = {surface, {0, 1, 2}, {}};
  for (const std::vector<double>& areas : log_areas) {
    ComparedMap map = {"a map", {1, 1, 1, 1}, std::vector<FaceDistortion>(mesh.F.rows())};
    for (std::size_t f = 0; f < map.faces.size(); ++f)
      map.faces[f] = {1, std::exp2(areas[f % areas.size()]), 1.5};
    comparison.maps.push_back(map);
  }
  const std::string path = testing::TempDir() + "orbitutte_comparison_" + std::to_string(::getpid()) + ending;
  write_comparison(path, comparison);
  const std::string bytes = read_file(path);
  std::filesystem::remove(path);
  return bytes;
}

/// How many pixels differ between two boxes of the same size: a box is left, top, right, bottom.
int count_differences(const Picture& a, const std::array<int, 2>& at, const Picture& b,
                      const std::array<int, 2>& there, const std::array<int, 2>& size) {
  int count = 0;
  for (int row = 0; row < size[1]; ++row)
    for (int byte = 0; byte < 3 * size[0]; ++byte)
      count += a.bytes[3 * (static_cast<std::size_t>(at[1] + row) * a.width + at[0]) + byte] !=
               b.bytes[3 * (static_cast<std::size_t>(there[1] + row) * b.width + there[0]) + byte];
  return count;
}

TEST(Comparison, MapsShareAxesAndColours) {
  const std::vector<double> narrow = {-0.5, 0, 0.2, 0.5, 0.5}, wide = {-5, -4, -1, 0, 1, 2, 4, 5};
  const Picture both(compared({narrow, wide}, ".png")), same(compared({narrow, narrow}, ".png"));
  const int half = both.width / 2, height = both.height;
  for (const int top : {0, 860})  // the colours of areas, and below their scale those of angles
    EXPECT_EQ(count_differences(same, {0, top}, same, {half, top}, {half / 2, 620}), 0)
        << "equal maps look the same, figures included";
  EXPECT_EQ(count_differences(both, {0, height - 95}, both, {half, height - 95}, {half, 95}), 0)
      << "the numbers of the horizontal axes are the same";
  EXPECT_EQ(count_differences(both, {0, height - 500}, both, {half, height - 500}, {110, 500}), 0)
      << "the numbers of the vertical axes are the same";
  EXPECT_GT(count_differences(both, {0, height - 95}, same, {0, height - 95}, {half, 95}), 0)
      << "a wide map widens the axis of its neighbour";
  EXPECT_GT(count_differences(both, {0, 120}, same, {0, 120}, {half, 600}), 0)
      << "and the scale of its neighbour's colours";
}

TEST(Comparison, SameBytesOnEveryRun) {
  for (const std::string ending : {".png", ".svg"}) {
    const std::string first = compared({{-1, 0, 1}, {0, 2}}, ending);
    EXPECT_TRUE(compared({{-1, 0, 1}, {0, 2}}, ending) == first) << ending;
  }
  EXPECT_THROW(compared({{0}}, ".jpg"), ArgumentError);
}

TEST(Render, PngAndSvgSayTheirSize) {
  const Subject subject("332");
  const std::string png = render_png(subject.get(), options_of(Panel::convergence, 300, 170));
  EXPECT_EQ(png.substr(0, 8), "\x89PNG\r\n\x1a\n");
  const auto big_endian = [&](std::size_t at) {
    int value = 0;
    for (std::size_t k = at; k < at + 4; ++k) value = 256 * value + static_cast<unsigned char>(png[k]);
    return value;
  };
  EXPECT_EQ(big_endian(16), 300);
  EXPECT_EQ(big_endian(20), 170);
  const std::string svg = render_svg(subject.get(), options_of(Panel::convergence, 300, 170));
  EXPECT_THAT(svg, HasSubstr("viewBox=\"0 0 300 170\""));
}

/// Every element that opens closes, in order.
void expect_well_formed(const std::string& xml) {
  static const std::regex tag("<(/?)([A-Za-z][A-Za-z0-9:]*)([^<>]*?)(/?)>");
  std::vector<std::string> open;
  for (std::sregex_iterator at(xml.begin(), xml.end(), tag), end; at != end; ++at) {
    if ((*at)[1].length() > 0) {
      ASSERT_FALSE(open.empty());
      ASSERT_EQ(open.back(), (*at)[2].str());
      open.pop_back();
    } else if ((*at)[4].length() == 0) {
      open.push_back((*at)[2].str());
    }
  }
  EXPECT_TRUE(open.empty());
}

TEST(Comparison, SvgIsWellFormed) { expect_well_formed(compared({{-1, 0, 1}, {0, 20}}, ".svg")); }

TEST(Render, SvgIsWellFormed) {
  const Subject subject("*33");
  for (const Panel panel : {Panel::histogram, Panel::convergence}) {
    const std::string svg = render_svg(subject.get(), options_of(panel, 400, 300));
    EXPECT_TRUE(svg.starts_with("<?xml"));
    EXPECT_THAT(svg, HasSubstr("<svg "));
    expect_well_formed(svg);
  }
}

/// All texts of an SVG that the page shows, each once.
std::set<std::string> texts_of_page(const Chart& chart) {
  const Content content = svg_chart(chart);
  std::set<std::string> texts = {content.at("y_title").at("text").get<std::string>()};
  for (const Content& text : content.at("texts")) texts.insert(text.at("text").get<std::string>());
  return texts;
}

std::set<std::string> texts_of_picture(const Chart& chart) {
  Canvas canvas(PictureFormat::svg, {600, 400}, 14);
  draw_chart(canvas, {0, 0, 600, 400}, chart);
  return {canvas.texts().begin(), canvas.texts().end()};
}

TEST(Charts, PageAndPicturesShowTheSameTextsLinesAndBars) {
  for (const std::string& signature : {"432", "*532", "5*", "3x"}) {
    const Subject subject(signature);
    const std::vector<double> areas =
        values_of(Measure::area, measure_triangles(subject.surface, subject.sample.embedding()));
    for (const Chart& chart : {area_histogram(areas), convergence_chart(subject.report.history)}) {
      EXPECT_EQ(texts_of_page(chart), texts_of_picture(chart)) << signature;
      for (const ChartAxis& axis : {chart.x, chart.y}) EXPECT_EQ(texts_of_page(chart).count(axis.title), 1U);
      for (const ChartLine& line : chart.lines) EXPECT_EQ(texts_of_picture(chart).count(line.label), 1U);
      EXPECT_EQ(svg_chart(chart).at("bars").size(), chart.bars.size());
      EXPECT_EQ(svg_chart(chart).at("lines").size(), 2 * chart.lines.size()) << "and one each for the key";
    }
  }
}

TEST(Render, WhatMakesNoSenseIsRefused) {
  const Subject subject("432");
  RenderOptions options;
  EXPECT_THROW(parse_choice<Panel>("shpere", "panel"), ArgumentError);
  EXPECT_THROW(parse_choice<Panel>("", "panel"), ArgumentError);
  for (const std::string size : {"", "x", "12", "0", "0x0", "100x", "100x20", "-100x100", "100x100x100",
                                 "20000x300", "1e3", "99999999999x300"})
    EXPECT_THROW(parse_picture_size(size, options), ArgumentError) << size;
  for (const std::string view :
       {"", "behind", "1,2", "1,2,3,4", "0,0,0", "nan,0,1", "inf,0,0", "1,,2", "1, 2,3"})
    EXPECT_THROW(parse_view_direction(view, Vector3::UnitY()), ArgumentError) << view;
  for (const std::string up : {"", "w", "+y", "0,0,0", "--y"})
    EXPECT_THROW(parse_up_direction(up), ArgumentError) << up;
  EXPECT_THROW(render_svg(subject.get(), options_of(Panel::sphere, 100, 100)), ArgumentError);
  EXPECT_THROW(write_picture("picture.jpg", subject.get()), ArgumentError);
  EXPECT_THROW(write_picture("picture", subject.get()), ArgumentError);
}

TEST(Render, AnotherMeshIsRefused) {
  const Subject subject("432");
  const Mesh other = icosphere(1);
  EXPECT_THROW(render_png({test::unjudged(other), subject.sample.embedding(), subject.report, ""},
                          options_of(Panel::area, 100, 100)),
               MeshError);
}

TEST(Render, VerticesThatNoFaceUsesDoNotMakeTheFigureSmall) {
  const Subject subject("432");
  Mesh mesh = subject.sample.mesh;
  const Eigen::Index n = mesh.V.rows();
  mesh.V.conservativeResize(n + 1, 3);
  mesh.V.row(n) << 100, 200, 300;
  const RenderOptions options = options_of(Panel::source, 90, 90);
  EXPECT_TRUE(render_png({test::unjudged(mesh), subject.sample.embedding(), subject.report, ""}, options) ==
              render_png(subject.get(), options));
  mesh.V.row(n)[0] = std::nan("");
  EXPECT_THROW(render_png({test::unjudged(mesh), subject.sample.embedding(), subject.report, ""}, options),
               MeshError);
}

TEST(Render, PictureIsWrittenWhole) {
  const Subject subject("432");
  const std::string path = testing::TempDir() + "orbitutte_render_test.PNG";
  const RenderOptions options = options_of(Panel::convergence, 200, 100);
  write_picture(path, subject.get(), options);
  EXPECT_TRUE(read_file(path) == render_png(subject.get(), options));
  std::filesystem::remove(path);
  EXPECT_THROW(write_picture(testing::TempDir() + "no/such/folder/a.png", subject.get(), options), FileError);
}

TEST(Render, OptionsAreRead) {
  RenderOptions options;
  parse_picture_size("640x480", options);
  EXPECT_EQ(options.width, 640);
  EXPECT_EQ(options.height, 480);
  parse_picture_size("500", options);
  EXPECT_EQ(options.width, 500);
  EXPECT_EQ(options.height, 500);
  for (const Panel panel : {Panel::source, Panel::sphere, Panel::area, Panel::angle, Panel::checkerboard,
                            Panel::histogram, Panel::convergence, Panel::sheet})
    EXPECT_EQ(parse_choice<Panel>(name_of(panel), "panel"), panel);
  EXPECT_EQ(parse_up_direction("-z"), -Vector3::UnitZ());
  EXPECT_EQ(parse_view_direction("front", Vector3::UnitY()), Vector3::UnitZ());
  EXPECT_EQ(parse_view_direction("right", Vector3::UnitY()), Vector3::UnitX());
  EXPECT_EQ(parse_view_direction("top", Vector3::UnitZ()), Vector3::UnitZ());
  EXPECT_EQ(parse_view_direction("front", Vector3::UnitZ()), -Vector3::UnitY());
  EXPECT_LT((parse_view_direction("3,0,-4", Vector3::UnitY()) - Vector3(0.6, 0, -0.8)).norm(), 1e-15);
}

/// A pyramid whose base is the unit square across z, as a closed mesh.
Mesh pyramid() {
  Mesh mesh;
  mesh.V.resize(5, 3);
  mesh.V << 0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0, 0.5, 0.5, 1;
  mesh.F.resize(6, 3);
  mesh.F << 0, 2, 1, 0, 3, 2, 0, 1, 4, 1, 2, 4, 2, 3, 4, 3, 0, 4;
  return mesh;
}

TEST(DefaultView, WhatStandsOnABroadBaseAcrossZHasZUp) {
  Mesh mesh = pyramid();
  EXPECT_EQ(default_up_direction(test::unjudged(mesh)), Vector3::UnitZ());
  EXPECT_EQ(default_up_direction(test::unjudged(Mesh{mesh.V(Eigen::all, {1, 2, 0}), mesh.F})),
            Vector3::UnitY());
  mesh.F = mesh.F.bottomRows(4).eval();  // without its base it faces whoever looks at it
  EXPECT_EQ(default_up_direction(test::unjudged(mesh)), Vector3::UnitY());
  EXPECT_EQ(default_up_direction(test::unjudged(Mesh())), Vector3::UnitY());
}

// Legs in a square below a head, along -y: a cone upside down.
TEST(DefaultView, WhatStandsOnABroadBaseAtTheFarEndOfYHasThatDown) {
  const Mesh mesh = pyramid();
  const Mesh standing{mesh.V(Eigen::all, {1, 2, 0}), mesh.F};
  Mesh hanging = standing;
  hanging.V.col(1) *= -1;
  hanging.F.col(1).swap(hanging.F.col(2));
  EXPECT_EQ(default_up_direction(test::unjudged(standing)), Vector3::UnitY());
  EXPECT_EQ(default_up_direction(test::unjudged(hanging)), -Vector3::UnitY());
}

TEST(DefaultView, OpenSurfacesAreSeenFromWhereTheyFace) {
  const Mesh mesh = sample_embedding("*432").mesh;  // a bent disk that faces +z
  const SourceFigure figure(mesh.V, mesh.F);
  const View view = default_view(figure, figure.positions().topRows(1), Vector3::UnitY());
  EXPECT_GT(view.viewer[2], 0.8);
}

TEST(Camera, ProjectsPointsOfARayToTheRay) {
  const Points points = icosphere(1).V;
  const Camera camera = fit_camera({Vector3(1, 2, 3), Vector3::UnitZ()}, points, {200, 100}, 0.8);
  EXPECT_LT((camera.axes * camera.axes.transpose() - Matrix3::Identity()).norm(), 1e-12);
  EXPECT_NEAR(camera.axes.determinant(), 1, 1e-12);
  const Ray ray = camera.ray(37, 81, 5);
  const Vector3 projected = camera.project((ray.origin + 3 * ray.direction).cast<double>());
  EXPECT_NEAR(projected[0], 37, 1e-3);
  EXPECT_NEAR(projected[1], 81, 1e-3);
  EXPECT_NEAR(projected[2], 2, 1e-5);
  EXPECT_NEAR(view_axes({Vector3::UnitY(), Vector3::UnitY()}).determinant(), 1, 1e-12)
      << "up points at the viewer";
}

TEST(Camera, NoTwoRaysOfAPixelShareAColumnOrARow) {
  const Camera camera = fit_camera({Vector3(1, 2, 3), Vector3::UnitZ()}, icosphere(1).V, {200, 100}, 0.8);
  std::set<int> columns, rows;  // in eighths of a pixel
  for (const Ray& ray : camera.rays(37, 81, 5)) {
    const Vector3 place = camera.project(ray.origin.cast<double>());
    EXPECT_NEAR(place[2], 5, 1e-5);
    columns.insert(static_cast<int>(std::floor(8 * (place[0] - 37) + 0.01)));
    rows.insert(static_cast<int>(std::floor(8 * (place[1] - 81) + 0.01)));
  }
  const std::set<int> all = {0, 1, 2, 3, 4, 5, 6, 7};
  EXPECT_EQ(columns, all);
  EXPECT_EQ(rows, all);
}

TEST(RayScene, HitsTheNearestShapeOfMirroredCopiesToo) {
  RayScene original;
  original.add_ball({2, 0.5, 0}, 0.25);
  Points line(2, 3);
  line << 0, -1, 0, 0, 1, 0;
  const int tube = original.add_tube(line, 0.1);
  original.commit();
  RayScene scene;
  const Matrix3 mirror = Vector3(1, -1, 1).asDiagonal();
  const int copy = scene.add_copy(original, mirror);
  scene.commit();
  const auto ball = scene.first_hit({{2, -0.5, 4}, {0, 0, -1}});
  ASSERT_TRUE(ball);
  EXPECT_NEAR(ball->distance, 3.75, 1e-5);
  EXPECT_EQ(ball->copy, copy);
  EXPECT_NEAR(ball->normal[2], 1, 1e-5);
  EXPECT_FALSE(scene.first_hit({{2, 0.5, 4}, {0, 0, -1}}));
  const auto side = scene.first_hit({{3, -0.9F, 0}, {-1, 0, 0}});
  ASSERT_TRUE(side);
  EXPECT_EQ(side->shape, tube);
  EXPECT_NEAR(side->distance, 2.9, 1e-4);
  EXPECT_TRUE(scene.is_blocked({{3, -0.9F, 0}, {-1, 0, 0}}));
  EXPECT_FALSE(scene.is_blocked({{3, -0.9F, 0}, {-1, 0, 0}, 1}));
}

TEST(RayScene, PacketsMeetWhatTheirRaysMeetAlone) {
  RayScene original;
  original.add_triangles(icosphere(2).V, icosphere(2).F);
  original.add_ball({0, 0, 1.2}, 0.3);
  original.commit();
  RayScene scene;
  scene.add_copy(original, Matrix3::Identity());
  scene.add_ball({0.5, 0.5, 0.5}, 0.6);
  scene.commit();
  int hits = 0, blocked = 0;
  for (int first = 0; first < 400; first += packet_size) {
    Packet rays;
    for (int k = 0; k < packet_size; ++k) {
      const int i = first + k;
      const auto aside = [](int steps) { return -1.4F + 0.15F * static_cast<float>(steps); };
      rays[k] = {{aside(i % 20), aside(i / 20), 3}, {0.1F * static_cast<float>(k), 0, -1}};
      if (i % 3 == 0) rays[k].length = 2;
    }
    rays[5].length = -1;
    const Hits found = scene.first_hits(rays);
    const std::bitset<packet_size> are_blocked = scene.are_blocked(rays);
    for (int k = 0; k < packet_size; ++k) {
      const auto alone = k == 5 ? std::nullopt : scene.first_hit(rays[k]);
      ASSERT_EQ(found[k].has_value(), alone.has_value());
      EXPECT_EQ(are_blocked[k], alone.has_value());
      blocked += are_blocked[k] ? 1 : 0;
      if (!alone) continue;
      EXPECT_NEAR(found[k]->distance, alone->distance, 1e-4);
      EXPECT_EQ(found[k]->copy, alone->copy);
      EXPECT_LT((found[k]->normal - alone->normal).norm(), 1e-3);
      ++hits;
    }
  }
  EXPECT_GT(hits, 50);
  EXPECT_EQ(hits, blocked);
}

// What is seen of a plane z = slope |x|, whose exposure is known.
LitSurface lit_fold(float slope, const std::function<Exposure(const Vector3f&)>& exposure) {
  const auto seen = [slope](const Packet& rays) {
    Normals normals;
    for (int k = 0; k < packet_size; ++k) {
      const float x = rays[k].origin[0];
      normals[k] = {{x, rays[k].origin[1], slope * std::abs(x)},
                    Vector3f(x < 0 ? slope : -slope, 0, 1).normalized()};
    }
    return normals;
  };
  return {seen, [exposure](const Ray& normal, float) { return exposure(normal.origin); }};
}

// The exposure of its grid in the middle of a pixel.
Exposure exposure_at(const ExposureGrid& grid, const Camera& camera, const LitSurface& surface, int column,
                     int row) {
  Packet rays;
  rays.fill(camera.ray(static_cast<float>(column) + 0.5F, static_cast<float>(row) + 0.5F, 5));
  return grid.at(column, row, surface.seen(rays)[0].value());
}

TEST(ExposureGrid, FollowsLightThatChangesSlowly) {
  const Camera camera = {.pixel = 0.02, .size = {101, 80}};
  const LitSurface plane = lit_fold(0, [](const Vector3f& at) -> Exposure {
    return {0.5F + 0.3F * at[0] - 0.2F * at[1], 0.5F + 0.4F * at[1]};
  });
  const ExposureGrid grid(camera, 5, plane);
  for (int row = 6; row < 74; ++row)
    for (int column = 6; column < 95; ++column) {
      const Exposure found = exposure_at(grid, camera, plane, column, row);
      const float x = 0.02F * (static_cast<float>(column) - 50),
                  y = 0.02F * (39.5F - static_cast<float>(row));
      EXPECT_NEAR(found.openness, 0.5F + 0.3F * x - 0.2F * y, 1e-4);
      EXPECT_NEAR(found.lit, 0.5F + 0.4F * y, 1e-4);
    }
}

TEST(ExposureGrid, LightStaysOnItsSideOfACrease) {
  const Camera camera = {.pixel = 0.02, .size = {100, 20}};
  const LitSurface fold = lit_fold(1, [](const Vector3f& at) -> Exposure {
    return {at[0] < 0 ? 0.2F : 0.9F, 1};
  });
  const ExposureGrid grid(camera, 5, fold);
  for (int column = 0; column < 100; ++column)
    EXPECT_NEAR(exposure_at(grid, camera, fold, column, 9).openness, column < 50 ? 0.2F : 0.9F, 1e-5)
        << column;
}

TEST(ExposureGrid, APointUnlikeAllAroundItIsLitByItself) {
  const Camera camera = {.pixel = 0.02, .size = {20, 20}};
  const LitSurface plane = lit_fold(0, [](const Vector3f& at) -> Exposure {
    return {at[2] > 0.5F ? 0.F : 1.F, 1};
  });
  const ExposureGrid grid(camera, 5, plane);
  EXPECT_EQ(grid.at(7, 8, {{-0.05F, 0.03F, 0}, Vector3f::UnitZ()}).openness, 1);
  EXPECT_EQ(grid.at(7, 8, {{-0.05F, 0.03F, 1}, Vector3f::UnitZ()}).openness, 0) << "high above the plane";
}

TEST(ColourTable, HasTheColoursOfItsScale) {
  for (const Measure measure : {Measure::area, Measure::angle}) {
    const ColourScale scale = {measure, {.title = "", .low = -2, .high = 3, .ticks = {}}};
    const ColourTable table(scale);
    for (int k = -20; k < 120; ++k)
      EXPECT_LT((table.at(-2 + 0.05 * k) - scale_colour(measure, 0.01 * k)).abs().maxCoeff(), 2e-3F);
    EXPECT_TRUE((table.at(std::nan("")) == linear(ink::unmeasured)).all());
  }
}

TEST(ColourTable, FacesThatAreNotMeasuredAreGrey) {
  const ColourTable table(colour_scale(Measure::area, {1}));
  EXPECT_EQ(srgb(table.of_face({0, 0, 0})), ink::unmeasured);
  EXPECT_EQ(srgb(table.of_face({1, 1})), srgb(diverging_colour(0)));
  EXPECT_EQ(srgb(table.of_face({1, 1e9, 1})), srgb(diverging_colour(1)));
}

TEST(Lighting, NormalsAreSmoothOnSpheresAndFlatOnCubes) {
  const Mesh sphere = icosphere(3);
  const CornerNormals smooth = corner_normals(sphere.V, sphere.F, 0.7);
  for (Eigen::Index c = 0; c < sphere.F.size(); ++c)
    EXPECT_LT((smooth.row(c).cast<double>() - sphere.V.row(sphere.F.data()[c])).norm(), 0.03);
  Points V(8, 3);
  for (int v = 0; v < 8; ++v) V.row(v) << v % 2, v / 2 % 2, v / 4;
  Triangles F(12, 3);
  F << 0, 2, 3, 0, 3, 1, 4, 5, 7, 4, 7, 6, 0, 1, 5, 0, 5, 4, 2, 6, 7, 2, 7, 3, 0, 4, 6, 0, 6, 2, 1, 3, 7, 1,
      7, 5;
  const CornerNormals flat = corner_normals(V, F, 0.7);
  for (Eigen::Index c = 0; c < F.size(); ++c) EXPECT_NEAR(flat.row(c).cwiseAbs().maxCoeff(), 1, 1e-6);
}

/// The mean of estimate(turn) over turns of their rays.
double mean_over_turns(const std::function<float(float)>& estimate) {
  double sum = 0;
  for (int k = 0; k < 9; ++k) sum += estimate(static_cast<float>(k) / 9);
  return sum / 9;
}

double mean_openness(const RayScene& scene, const Ray& from) {
  const Blocker are_blocked = [&](const Packet& rays) { return scene.are_blocked(rays); };
  return mean_over_turns([&](float turn) { return openness(are_blocked, from, turn); });
}

/// Two squares that meet along the y axis, each rising by the slope (negative: falling) away from it.
RayScene folded_squares(double slope) {
  Points V(6, 3);
  V << -1, -1, slope, 0, -1, 0, 1, -1, slope, -1, 1, slope, 0, 1, 0, 1, 1, slope;
  Triangles F(4, 3);
  F << 0, 1, 4, 0, 4, 3, 1, 2, 5, 1, 5, 4;
  RayScene scene;
  scene.add_triangles(V, F);
  scene.commit();
  return scene;
}

TEST(Lighting, ConcaveCreasesAreDarkerAndConvexTopsAreNot) {
  const Ray above = {Vector3f(0, 0, 0.01F), Vector3f::UnitZ(), 0.6F};
  const double steep = mean_openness(folded_squares(2), above),
               flatter = mean_openness(folded_squares(1), above);
  EXPECT_NEAR(steep, 0.447, 0.04) << "the cosine of the slope's angle, for squares without end";
  EXPECT_NEAR(flatter, 0.707, 0.04);
  EXPECT_EQ(mean_openness(folded_squares(-1), above), 1);
  EXPECT_EQ(mean_openness(folded_squares(0), above), 1);
}

TEST(Lighting, BallsThrowShadowsAwayFromTheMainLight) {
  RayScene scene;
  scene.add_ball({0, 0, 0.5}, 0.2);
  scene.commit();
  const Blocker are_blocked = [&](const Packet& rays) { return scene.are_blocked(rays); };
  const auto share = [&](const Vector3f& origin) {
    return mean_over_turns([&](float turn) { return lit(are_blocked, origin, Matrix3::Identity(), turn); });
  };
  EXPECT_LT(share({0.3F, -0.43F, 0}), 0.5F) << "the light is above the viewer's left shoulder";
  EXPECT_EQ(share({-0.3F, 0.43F, 0}), 1);
  EXPECT_EQ(share({0.3F, -0.43F, 0.8F}), 1) << "beside and above the ball";
  EXPECT_LT(brightness(Vector3f::UnitZ(), {1, 0}), 0.7F * brightness(Vector3f::UnitZ(), {}));
}

TEST(Checkerboard, SquaresAreRightAngledWhereTheMapIsConformal) {
  // The identity of the sphere's upper half as the embedding: stereographic coordinates are conformal.
  const Mesh sphere = icosphere(4);
  Embedding embedding;
  embedding.positions = sphere.V;
  std::vector<int> upper;
  for (int f = 0; f < sphere.F.rows(); ++f)
    if (sphere.V.row(sphere.F(f, 0))[2] > 0) upper.push_back(f);
  embedding.triangles = sphere.F(upper, Eigen::all);
  for (int v = 0; v < sphere.V.rows(); ++v) embedding.source_vertex.push_back(v);
  const Checkerboard board(embedding, sphere.V, Vector3::UnitZ(), 0.1);
  for (Eigen::Index f = 0; f < embedding.triangles.rows(); ++f) {
    const auto corner = embedding.triangles.row(f);
    const auto X = [&](int k) -> Vector3 { return sphere.V.row(corner[k]); };
    const auto x = [&](int k) -> Eigen::Vector2d { return board.coordinates().row(corner[k]); };
    const double a = (x(1) - x(0)).norm() / (X(1) - X(0)).norm(),
                 b = (x(2) - x(0)).norm() / (X(2) - X(0)).norm();
    EXPECT_NEAR(a / b, 1, 0.06);
    const double scale = 1 / std::sqrt(a * b);  // a square's side on the source
    EXPECT_GT(scale, 0.05);
    EXPECT_LT(scale, 0.2);
  }
}

TEST(Checkerboard, NeighbouringSquaresDiffer) {
  // Two triangles around the pole, as large as several squares; corners far apart along one direction.
  Embedding embedding;
  embedding.positions.resize(3, 3);
  embedding.positions << Vector3(0.1, -0.06, 1).normalized().transpose(),
      Vector3(0, 0.1, 1).normalized().transpose(), Vector3(-0.1, -0.06, 1).normalized().transpose();
  embedding.triangles.resize(1, 3);
  embedding.triangles << 0, 1, 2;
  embedding.source_vertex = {0, 1, 2};
  const Checkerboard board(embedding, embedding.positions, Vector3::UnitZ(), 0.02);
  const auto& coordinates = board.coordinates();
  int changes = 0;
  for (int k = 0; k + 1 < 200; ++k) {
    Hit here, there;
    here.primitive = there.primitive = 0;
    here.u = static_cast<float>(k) / 200, there.u = static_cast<float>(k + 1) / 200;
    const auto square = [&](const Hit& hit) {
      const Eigen::Vector2d place = (1 - hit.u) * coordinates.row(0) + hit.u * coordinates.row(1);
      return std::lround(std::floor(place[0]) + std::floor(place[1]));
    };
    const bool same_colour = (board.colour(here, 1e-4) - board.colour(there, 1e-4)).abs().maxCoeff() < 1e-3F;
    EXPECT_EQ(same_colour, (square(here) - square(there)) % 2 == 0);
    changes += same_colour ? 0 : 1;
  }
  EXPECT_GT(changes, 4);
  Hit any;
  any.primitive = 0, any.u = 0.21F;
  const Colour far = board.colour(any, 1);
  any.u = 0.35F;
  EXPECT_LT((board.colour(any, 1) - far).abs().maxCoeff(), 1e-6F) << "squares smaller than pixels are grey";
}

}  // namespace
}  // namespace orbitutte::render_test
