// SPDX-License-Identifier: MIT
#include "orbitutte/page/page.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <nlohmann/json.hpp>
#include <set>

#include "base64_text.h"
#include "orbitutte/export/html_text.h"
#include "orbitutte/export/palette.h"
#include "orbitutte/export/value_colours.h"
#include "orbitutte/io/base64.h"
#include "orbitutte/io/bytes.h"
#include "orbitutte/mesh/triangulation.h"
#include "orbitutte/page/html_template.h"
#include "orbitutte/page/page_scene.h"
#include "orbitutte/report/report.h"
#include "orbitutte/samples/sample.h"
#include "orbitutte/verify/distortion.h"
#include "polygon_meshes.h"
#include "sample_embeddings.h"

namespace orbitutte::page_test {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;
using Json = nlohmann::json;

std::string scene_of(const test::SampleEmbedding& sample, const Points& colours = Points(0, 3),
                     const PageOptions& options = {}) {
  Surface surface = test::unjudged(sample.mesh);
  surface.colours = colours;
  return page_scene({surface, sample.embedding(), ""}, measure_triangles(surface, sample.embedding()),
                    options);
}

constexpr const char* hostile =
    R"(a"'><img src=x onerror=alert(1)></script><script>alert(2)</script>{{style}})";

const RunRecord run = {"folder/mesh.ply", std::string(64, 'a'), 0.25, 0.5, 2, 123456};

std::string sample_report(const std::string& signature) {
  return report_json(test::sample_embedding(signature).result, run);
}

std::string page_of(const std::string& signature, const std::string& report,
                    const PageOptions& options = {}) {
  const test::SampleEmbedding& sample = test::sample_embedding(signature);
  return report_page({test::unjudged(sample.mesh), sample.embedding(), report}, options);
}

template <typename Number>
std::vector<Number> numbers(const Json& text) {
  const std::string bytes = test::from_base64(text.get<std::string>());
  std::vector<Number> values;
  for (std::size_t at = 0; at + sizeof(Number) <= bytes.size(); at += sizeof(Number))
    values.push_back(load<Number>(bytes.data() + at, std::endian::little));
  return values;
}

// Reads tags and checks that they nest; what stands in script and style is no markup.
std::string nesting_fault(const std::string& html) {
  static const std::set<std::string> empty = {"meta", "br", "input", "img", "path", "circle", "rect"};
  std::vector<std::string> open;
  for (std::size_t at = html.find('<'); at != std::string::npos; at = html.find('<', at + 1)) {
    if (html.compare(at, 4, "<!--") == 0 || html.compare(at, 2, "<!") == 0) continue;
    const bool closes = html[at + 1] == '/';
    const std::size_t start = at + (closes ? 2 : 1);
    const std::string tag = html.substr(start, html.find_first_of(" >/\n", start) - start);
    if (empty.count(tag)) continue;
    if (!closes) open.push_back(tag);
    if (closes && (open.empty() || open.back() != tag)) return tag;
    if (closes) open.pop_back();
    if (!closes && (tag == "script" || tag == "style")) at = html.find("</" + tag, at) - 1;
  }
  return open.empty() ? "" : open.back();
}

TEST(HtmlText, EscapesWhatHtmlGivesAMeaning) {
  EXPECT_EQ(escape_html(R"(a<b>&"c'd)"), "a&lt;b&gt;&amp;&quot;c&#39;d");
}

TEST(HtmlText, Base64DecodesToTheSameBytes) {
  std::string bytes;
  for (int length = 0; length < 300; ++length) {
    EXPECT_EQ(test::from_base64(base64(bytes)), bytes);
    EXPECT_EQ(base64(bytes).size() % 4, 0u);
    bytes += static_cast<char>(37 * length);
  }
  EXPECT_EQ(base64("light w"), "bGlnaHQgdw==");
  const std::string large((3 << 20) + 1000, 'x');  // more than the encoder takes at once
  EXPECT_EQ(test::from_base64(base64(large)), large);
}

TEST(HtmlTemplate, FillsOnceAndEscapesUnlessThreeBracesSayOtherwise) {
  const Content content = {{"a", "{{b}}"}, {"b", "<'\"&>"}};
  EXPECT_EQ(fill_template({"{{a}} {{b}} {{{b}}}", {}}, content), "{{b}} &lt;&#39;&quot;&amp;&gt; <'\"&>");
}

TEST(HtmlTemplate, RepeatsSectionsInsideWhichOuterNamesAreKnown) {
  const Content content = {{"rows", {{{"k", "1"}}, {{"k", "2"}}}},
                           {"words", {"<", "y"}},
                           {"shown", true},
                           {"hidden", false},
                           {"unit", "s"}};
  EXPECT_EQ(fill_template({"{{#rows}}{{k}}{{unit}} {{/rows}}", {}}, content), "1s 2s ");
  EXPECT_EQ(fill_template({"{{#words}}{{.}},{{/words}}", {}}, content), "&lt;,y,");
  EXPECT_EQ(
      fill_template({"{{#shown}}a{{/shown}}{{#hidden}}b{{/hidden}}{{^hidden}}c{{/hidden}}", {}}, content),
      "ac");
  EXPECT_EQ(fill_template({"{{#rows}}{{>cell}}{{/rows}}", {{"cell", "<td>{{k}}</td>"}}}, content),
            "<td>1</td><td>2</td>");
}

TEST(HtmlTemplate, RefusesNamesAndPartsWithoutContentAndSectionsThatDoNotEnd) {
  EXPECT_THROW(fill_template({"{{c}}", {}}, Content::object()), ArgumentError);
  EXPECT_THROW(fill_template({"{{#c}}{{/c}}", {}}, Content::object()), ArgumentError);
  EXPECT_THROW(fill_template({"{{>c}}", {}}, Content::object()), ArgumentError);
  EXPECT_THROW(fill_template({"{{#c}}", {}}, {{"c", true}}), ArgumentError);
  EXPECT_THROW(fill_template({"{{>c}}", {{"c", "{{#d}}"}}}, {{"d", true}}), ArgumentError);
  EXPECT_THROW(fill_template({"{{c}}", {}}, {{"c", 7}}), ArgumentError);
}

TEST(HtmlTemplate, AsksElsewhereForNamesThatTheContentDoesNotHave) {
  const auto otherwise = [](const std::string& name) {
    return name == "report.x" ? std::optional<std::string>("<") : std::nullopt;
  };
  EXPECT_EQ(fill_template({"{{report.x}}", {}, otherwise}, Content::object()), "&lt;");
  EXPECT_THROW(fill_template({"{{report.y}}", {}, otherwise}, Content::object()), ArgumentError);
}

TEST(HtmlText, DigitsAreGroupedByThree) {
  EXPECT_EQ(grouped_digits(0), "0");
  EXPECT_EQ(grouped_digits(999), "999");
  EXPECT_EQ(grouped_digits(1234567), "1,234,567");
  EXPECT_EQ(grouped_digits(-123456), "-123,456");
}

TEST(DisplayMesh, AMeshWithinTheLimitIsWhole) {
  const test::SampleEmbedding& sample = test::sample_embedding("432");
  const DisplayMesh display = display_mesh(test::unjudged(sample.mesh), sample.embedding());
  EXPECT_EQ(display.fine.faces, sample.embedding().triangles);
  EXPECT_EQ(display.coarse.faces, sample.embedding().triangles);
  std::size_t banks = 0;
  for (const Seam& seam : sample.embedding().seams) banks += 2 * (seam.left.size() - 1);
  EXPECT_EQ(display.fine.outline.size(), banks);
}

TEST(DisplayMesh, ALargeMeshIsCoarsenedToItsLimitAndKeepsItsOutline) {
  const Mesh mesh = sample_mesh({SampleShape::figure, 6000});
  const EmbedResult result = embed(mesh, parse_orbifold("332"), sample_cones(SampleShape::figure, mesh));
  const DisplayMesh display = display_mesh(test::unjudged(mesh), result.embedding, {3000, 12 * 800});
  EXPECT_LE(display.fine.faces.rows(), 3000);
  EXPECT_LE(display.coarse.faces.rows(), 800);
  EXPECT_GT(display.fine.faces.rows(), 2000);
  const DisplayMesh whole = display_mesh(test::unjudged(mesh), result.embedding);
  EXPECT_EQ(display.fine.outline.size(), whole.fine.outline.size());
  EXPECT_EQ(display.coarse.outline.size(), whole.fine.outline.size());
}

TEST(DisplayMesh, ACoarseTileStillCoversItsShareOfTheSphere) {
  const Mesh mesh = sample_mesh({SampleShape::figure, 6000});
  const EmbedResult result = embed(mesh, parse_orbifold("332"), sample_cones(SampleShape::figure, mesh));
  const DisplayMesh display = display_mesh(test::unjudged(mesh), result.embedding, {3000, 12 * 800});
  for (const DisplayLevel& level : {display.fine, display.coarse}) {
    double area = 0;
    for (Eigen::Index f = 0; f < level.faces.rows(); ++f) {
      const auto corner = [&](int k) -> Vector3 {
        return result.embedding.positions.row(display.cut_vertex[level.faces(f, k)]);
      };
      area += Space::sphere().area(corner(0), corner(1), corner(2));
    }
    EXPECT_NEAR(area, result.certificate.expected_area, 1e-9);
  }
}

TEST(PageScene, HoldsTheDrawnVerticesInSourceAndImage) {
  for (const char* signature : {"532", "*223", "3*2", "2x"}) {
    const test::SampleEmbedding& sample = test::sample_embedding(signature);
    const Embedding& embedding = sample.embedding();
    const Json scene = Json::parse(scene_of(sample));
    const auto source = numbers<std::uint16_t>(scene["source"]);
    const auto image = numbers<float>(scene["image"]);
    const auto vertex = numbers<std::uint32_t>(scene["source_vertex"]);
    const std::size_t count = scene["vertices"];
    ASSERT_EQ(source.size(), 3 * count);
    ASSERT_EQ(image.size(), 3 * count);
    ASSERT_EQ(vertex.size(), count);
    const double size = scene["source_box"][3];
    for (std::size_t i = 0; i < 3 * count; ++i) {
      const double low = scene["source_box"][i % 3];
      const auto v = static_cast<Eigen::Index>(vertex[i / 3]), k = static_cast<Eigen::Index>(i % 3);
      EXPECT_NEAR(low + size * source[i] / 65535, sample.mesh.V(v, k), size / 65535);
      EXPECT_NEAR(image[i], embedding.positions(static_cast<Eigen::Index>(i / 3), k), 1e-6);
    }
    EXPECT_EQ(static_cast<int>(scene["copies"].size()), embedding.target.group_order);
    EXPECT_EQ(scene["cones"].size(), embedding.cones.size());
    EXPECT_EQ(numbers<std::uint32_t>(scene["fine"]["indices"]).size(),
              static_cast<std::size_t>(embedding.triangles.size()));
  }
}

TEST(PageScene, HoldsTheColoursOfTheVerticesWhereTheMeshHasThem) {
  for (const char* signature : {"432", "*223", "2x"}) {
    const test::SampleEmbedding& sample = test::sample_embedding(signature);
    const Points colours = (sample.mesh.V.array() * 0.4 + 0.5).cwiseMax(0).cwiseMin(1);
    const Json scene = Json::parse(scene_of(sample, colours));
    const auto colour = numbers<std::uint8_t>(scene["colour"]);
    const auto vertex = numbers<std::uint32_t>(scene["source_vertex"]);
    ASSERT_EQ(colour.size(), 3 * vertex.size());
    for (std::size_t i = 0; i < colour.size(); ++i)
      EXPECT_NEAR(colour[i] / 255.0, colours(vertex[i / 3], static_cast<Eigen::Index>(i % 3)), 0.5 / 255);
    EXPECT_FALSE(Json::parse(scene_of(sample)).contains("colour"));
  }
}

// Each drawn vertex has its value, and the scale the value's colour at each end.
TEST(Page, ShowsValuesWithTheirScale) {
  const test::SampleEmbedding& sample = test::sample_embedding("432");
  VertexData data;
  data.values = sample.mesh.V.col(1);
  data.values(0, 0) = std::numeric_limits<double>::quiet_NaN();
  const ValueColours colours = value_colours(data, 0);
  PageOptions options;
  options.values = {hostile, data.values.col(0), {}, colours.low, colours.high};
  const std::string text = scene_of(sample, colours.colours, options);
  EXPECT_EQ(text.find('<'), std::string::npos);
  const Json scene = Json::parse(text);
  EXPECT_EQ(scene["values"]["name"], hostile);
  EXPECT_FALSE(scene["values"].contains("labels"));
  const auto value = numbers<float>(scene["values"]["numbers"]);
  const auto vertex = numbers<std::uint32_t>(scene["source_vertex"]);
  ASSERT_EQ(value.size(), vertex.size());
  for (std::size_t i = 0; i < value.size(); ++i)
    EXPECT_TRUE(std::isnan(value[i]) ? vertex[i] == 0
                                     : value[i] == static_cast<float>(data.values(vertex[i], 0)));
  const Json& scale = scene["scales"]["vertex"];
  EXPECT_EQ(scale["low"], colours.low);
  EXPECT_EQ(scale["high"], colours.high);
  Eigen::Index lowest = 0;
  data.values.col(0).tail(data.values.rows() - 1).minCoeff(&lowest);
  const Eigen::RowVector3d shown = 255 * colours.colours.row(lowest + 1);
  EXPECT_EQ(scale["colours"].front(), hexadecimal(Rgb{static_cast<std::uint8_t>(std::lround(shown[0])),
                                                      static_cast<std::uint8_t>(std::lround(shown[1])),
                                                      static_cast<std::uint8_t>(std::lround(shown[2]))}));
  EXPECT_EQ(scale["ticks"].size(), 5U);

  options.values->values.conservativeResize(3);
  const std::string report = sample_report("432");
  EXPECT_THROW(report_page({test::unjudged(sample.mesh), sample.embedding(), report}, options), MeshError);
}

TEST(Page, ShowsLabelsByTheirNames) {
  const test::SampleEmbedding& sample = test::sample_embedding("432");
  PageOptions options;
  options.values = {"regions", Eigen::VectorXd::Ones(sample.mesh.V.rows()), {{1, "front", {}}}, 0, 0};
  const Json scene = Json::parse(scene_of(sample, Points::Zero(sample.mesh.V.rows(), 3), options));
  EXPECT_EQ(scene["values"]["labels"], Json({{1, "front"}}));
  EXPECT_FALSE(scene["scales"].contains("vertex"));
  EXPECT_FALSE(Json::parse(scene_of(sample)).contains("values"));
}

TEST(PageScene, BringsTheColoursOfPicturesAlong) {
  const test::SampleEmbedding& sample = test::sample_embedding("432");
  const Json scene = Json::parse(scene_of(sample));
  for (std::size_t c = 0; c < scene["cones"].size(); ++c)
    EXPECT_EQ(scene["cones"][c]["colour"], hexadecimal(cone_colour(static_cast<int>(c))));
  EXPECT_EQ(scene["tile"], hexadecimal(bold_colour));
  const std::vector<FaceDistortion> faces =
      measure_triangles(test::unjudged(sample.mesh), sample.embedding());
  for (const auto& [name, measure] : {std::pair("area", Measure::area), std::pair("angle", Measure::angle)}) {
    const Json& scale = scene["scales"][name];
    const ColourScale expected = colour_scale(measure, values_of(measure, faces));
    EXPECT_EQ(scale["title"], expected.axis.title);
    EXPECT_EQ(scale["high"], expected.axis.high);
    EXPECT_EQ(scale["ticks"].size(), expected.axis.ticks.size());
    EXPECT_EQ(scale["colours"].front(), hexadecimal(srgb(scale_colour(measure, 0))));
    EXPECT_EQ(scale["colours"].back(), hexadecimal(srgb(scale_colour(measure, 1))));
  }
}

TEST(PageScene, NormalsAreUnitVectorsAndAgreeAcrossSeamsUpToSign) {
  for (const char* signature : {"432", "3x"}) {
    const test::SampleEmbedding& sample = test::sample_embedding(signature);
    const auto normal = numbers<std::int8_t>(Json::parse(scene_of(sample))["normal"]);
    const auto at = [&](int v) -> Vector3 {
      return Vector3(normal[3 * v], normal[3 * v + 1], normal[3 * v + 2]) / 127;
    };
    for (const Seam& seam : sample.embedding().seams) {
      for (std::size_t i = 0; i < seam.left.size(); ++i) {
        const Vector3 left = at(seam.left[i]), right = at(seam.right[i]);
        EXPECT_NEAR(left.norm(), 1, 0.02);
        EXPECT_NEAR(std::abs(left.dot(right)), 1, 0.03);
      }
    }
  }
}

TEST(Page, IsWellNestedHtmlThatHoldsEveryCheck) {
  for (const char* signature : {"532", "*432", "2*", "5x"}) {
    const std::string page = page_of(signature, sample_report(signature));
    EXPECT_EQ(nesting_fault(page), "") << signature;
    EXPECT_THAT(page, HasSubstr("Certified bijective"));
    EXPECT_THAT(page, HasSubstr("mesh.ply onto " + std::string(signature)));
    for (const Check& check : test::sample_embedding(signature).result.certificate.checks)
      EXPECT_THAT(page, HasSubstr(check.name));
  }
}

TEST(Page, SpeaksOfTheSpaceThatTheMapLiesIn) {
  const std::string flat = page_of("442", sample_report("442"));
  for (const char* of_the_sphere :
       {"Spherical orbifold", "on the sphere", "unit vector", "4π", "the sphere exactly once"})
    EXPECT_THAT(flat, Not(HasSubstr(of_the_sphere))) << of_the_sphere;
  EXPECT_THAT(flat, HasSubstr("Orbifold Tutte embedding in the plane"));
  EXPECT_THAT(flat, HasSubstr("infinite group"));
  EXPECT_THAT(flat, HasSubstr("symmetric copies cover the Euclidean plane exactly once"));
  const std::string round = page_of("432", sample_report("432"));
  EXPECT_THAT(round, HasSubstr("Orbifold Tutte embedding on the sphere"));
  EXPECT_THAT(round, HasSubstr("group of order 24"));
  EXPECT_THAT(round, HasSubstr("its 24 symmetric copies cover the sphere exactly once"));
  EXPECT_THAT(page_of("1x", sample_report("1x")), HasSubstr("A projective plane of "));
}

TEST(Page, CountsTheFacesOfTheInput) {
  const PolygonMesh mesh = test::dual(test::icosphere(1));
  const Target orbifold = parse_orbifold("432");
  const EmbedResult result = embed(mesh, orbifold, choose_cones(mesh, orbifold));
  const std::string report = report_json(result, run);
  const std::string page = report_page({make_surface(mesh), result.embedding, report});
  EXPECT_THAT(page, HasSubstr("80 vertices and 42 faces"));
  EXPECT_THAT(page, HasSubstr("Every face is positively oriented"));
  EXPECT_THAT(page_of("432", sample_report("432")), HasSubstr("162 vertices and 320 faces"));
}

TEST(Page, LoadsNothing) {
  const std::string page = page_of("432", sample_report("432"));
  EXPECT_THAT(page, HasSubstr("default-src 'none'"));
  for (const char* outside : {"<link", "<script src", "<img", "<iframe", "@import", "url("})
    EXPECT_THAT(page, Not(HasSubstr(outside)));
}

TEST(Page, TextFromTheReportStaysText) {
  Json report = Json::parse(sample_report("432"));
  report["mesh"]["path"] = hostile;
  report["mesh"]["topology"] = hostile;
  report["warnings"] = {hostile};
  report["environment"]["blas"] = hostile;
  report["timings"][hostile] = 1;
  const std::string page = page_of("432", report.dump());
  EXPECT_THAT(page, Not(HasSubstr("<img")));
  EXPECT_THAT(page, Not(HasSubstr("<script>alert")));
  EXPECT_THAT(page, HasSubstr("{{style}}"));
  EXPECT_EQ(nesting_fault(page), "");
}

TEST(Page, FollowsTheFilesWhereTheReportClaimsOtherwise) {
  Json report = Json::parse(sample_report("432"));
  report["certificate"]["bijective"] = false;
  EXPECT_THAT(page_of("432", report.dump()), HasSubstr("says otherwise"));

  const test::SampleEmbedding& sample = test::sample_embedding("432");
  Embedding folded = sample.embedding();
  folded.positions.row(folded.triangles(0, 0)) *= -1;
  const std::string page = report_page({test::unjudged(sample.mesh), folded, sample_report("432")});
  EXPECT_THAT(page, HasSubstr("Not certified"));
  EXPECT_THAT(page, HasSubstr("says otherwise"));
}

TEST(Page, SaysThatTheOptimiserDidNotConverge) {
  Json report = Json::parse(sample_report("432"));
  report["termination"] = "max_iterations";
  report["certificate"]["bijective"] = false;
  const std::string page = page_of("432", report.dump());
  EXPECT_THAT(page, HasSubstr("Not converged"));
  EXPECT_THAT(page, Not(HasSubstr("Certified bijective")));
}

TEST(Page, WithoutTheViewShowsCertificateAndPicturesAndSaysSo) {
  PageOptions options;
  options.interactive = false;
  options.pictures = {{"The \"source\"", "\x89PNG"}};
  const std::string page = page_of("432", sample_report("432"), options);
  EXPECT_THAT(page, HasSubstr("interactive 3D view was left out"));
  EXPECT_THAT(page, HasSubstr("Certified bijective"));
  EXPECT_THAT(page, HasSubstr("src=\"data:image/png;base64,iVBORw==\""));
  EXPECT_THAT(page, HasSubstr("The &quot;source&quot;"));
  EXPECT_THAT(page, HasSubstr("script-src 'none'"));
  EXPECT_THAT(page, Not(HasSubstr("<script")));
  EXPECT_EQ(nesting_fault(page), "");
}

TEST(Page, FiguresThatAreMissingOrOfAnotherTypeAreADash) {
  Json report = Json::parse(sample_report("432"));
  for (const char* key : {"distortion", "history", "timings", "environment", "energy"}) report.erase(key);
  report["mesh"] = 7;
  report["iterations"] = "many";
  EXPECT_EQ(nesting_fault(page_of("432", report.dump())), "");
  EXPECT_EQ(nesting_fault(page_of("432", "[]")), "");
}

TEST(Page, RefusesAMeshThatWasNotEmbeddedAndAReportThatIsNone) {
  const test::SampleEmbedding& sample = test::sample_embedding("432");
  const std::string report = sample_report("432");
  EXPECT_THROW(report_page({test::unjudged(test::icosahedron()), sample.embedding(), report}), MeshError);
  EXPECT_THROW(page_of("432", "{"), MeshError);
  Surface coloured = test::unjudged(sample.mesh);
  coloured.colours = Points::Zero(3, 3);
  EXPECT_THROW(report_page({coloured, sample.embedding(), report}), MeshError);
}

}  // namespace
}  // namespace orbitutte::page_test
