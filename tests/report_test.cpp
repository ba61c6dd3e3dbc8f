// SPDX-License-Identifier: MIT
#include "orbitutte/report/report.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <limits>
#include <nlohmann/json.hpp>
#include <numbers>

#include "orbitutte/io/file.h"
#include "orbitutte/io/ply.h"
#include "orbitutte/report/embedding_file.h"
#include "orbitutte/report/verification.h"
#include "sample_embeddings.h"

namespace orbitutte::report_test {
namespace {

using ::testing::AllOf;
using ::testing::AnyOf;
using ::testing::ContainsRegex;
using ::testing::HasSubstr;
using ::testing::Not;
using Json = nlohmann::json;

// A file that lives as long as the test.
class TemporaryFile {
 public:
  explicit TemporaryFile(const std::string& bytes, const std::string& ending = ".json") {
    const auto* test = ::testing::UnitTest::GetInstance()->current_test_info();
    path_ = (std::filesystem::temp_directory_path() /
             (std::string("orbitutte_") + test->test_suite_name() + "_" + test->name() + ending))
                .string();
    write_file(path_, bytes);
  }
  ~TemporaryFile() { std::filesystem::remove(path_); }
  TemporaryFile(const TemporaryFile&) = delete;
  TemporaryFile& operator=(const TemporaryFile&) = delete;

  const std::string& path() const { return path_; }

 private:
  std::string path_;
};

const RunRecord run = {"mesh.ply", std::string(64, 'a'), 0.25, 0.5, 2, 123456};

Json sample_report(const std::string& signature = "532") {
  return Json::parse(report_json(test::sample_embedding(signature).result, run));
}

Report read(const std::string& text) { return read_report(TemporaryFile(text).path()); }

// The sentence with which a report is refused.
std::string refusal_of_report(const std::string& text) {
  try {
    read(text);
  } catch (const MeshError& error) {
    return error.what();
  }
  return "accepted";
}

std::string refusal_of_report(const std::function<void(Json&)>& plant) {
  Json json = sample_report();
  plant(json);
  return refusal_of_report(json.dump());
}

void expect_same(const std::vector<Seam>& a, const std::vector<Seam>& b) {
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t s = 0; s < a.size(); ++s) {
    EXPECT_EQ(a[s].left, b[s].left);
    EXPECT_EQ(a[s].right, b[s].right);
    EXPECT_EQ(a[s].transform.matrix(), b[s].transform.matrix());
  }
}

void expect_same(const std::vector<ConeCopies>& a, const std::vector<ConeCopies>& b) {
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t k = 0; k < a.size(); ++k) {
    EXPECT_EQ(a[k].vertex, b[k].vertex);
    EXPECT_EQ(a[k].mark.angle, b[k].mark.angle);
    EXPECT_EQ(a[k].mark.kind, b[k].mark.kind);
    EXPECT_EQ(a[k].copies, b[k].copies);
  }
}

// The report

TEST(Report, HoldsEveryKeyWithItsType) {
  const auto all = [](const Json& list, const std::function<bool(const Json&)>& is) {
    return list.is_array() && std::all_of(list.begin(), list.end(), is);
  };
  const auto is_integer = [](const Json& value) { return value.is_number_integer(); };
  const auto is_number = [](const Json& value) { return value.is_number(); };
  for (const std::string& signature : test::all_sample_signatures()) {
    const Json json = sample_report(signature);
    const Target target = parse_orbifold(signature);
    EXPECT_EQ(json.at("schema"), "orbitutte.report/1");
    EXPECT_EQ(json.at("mesh").at("path"), "mesh.ply");
    EXPECT_EQ(json.at("mesh").at("vertices"), test::vertex_count(test::sample_embedding(signature).mesh));
    EXPECT_EQ(json.at("mesh").at("faces"), test::face_count(test::sample_embedding(signature).mesh));
    EXPECT_EQ(json.at("mesh").at("topology"), name_of(parse_orbifold(signature).topology));
    EXPECT_EQ(json.at("orbifold").at("signature"), signature);
    EXPECT_EQ(json.at("orbifold").at("group_order"),
              target.group_order > 0 ? Json(target.group_order) : Json());
    EXPECT_EQ(json.at("orbifold").at("space"), target.group_order > 0 ? "spherical" : "euclidean");
    EXPECT_EQ(json.at("placement").size(), 3u);
    EXPECT_TRUE(
        all(json.at("placement"), [&](const Json& row) { return row.size() == 3 && all(row, is_number); }));

    ASSERT_TRUE(json.at("cones").is_array());
    for (const Json& cone : json.at("cones")) {
      EXPECT_TRUE(cone.at("vertex").is_number_integer());
      EXPECT_TRUE(cone.at("order").is_number_integer());
      const double whole = (cone.at("kind") == "rotation" ? 2 : 1) * std::numbers::pi;
      EXPECT_NEAR(cone.at("angle").get<double>(), whole / cone.at("order").get<int>(), 1e-15);
      EXPECT_THAT(cone.at("kind"), AnyOf("corner", "rotation"));
      EXPECT_TRUE(all(cone.at("copies"), is_integer));
    }
    ASSERT_TRUE(json.at("seams").is_array());
    EXPECT_EQ(json.at("seams").empty(), signature == "1") << signature;
    for (const Json& seam : json.at("seams")) {
      EXPECT_THAT(seam.at("kind"), AnyOf("reflection", "rotation", "rotoreflection"));
      EXPECT_TRUE(all(seam.at("left"), is_integer));
      EXPECT_TRUE(all(seam.at("right"), is_integer));
      EXPECT_EQ(seam.at("left") == seam.at("right"), seam.at("kind") == "reflection");
      EXPECT_EQ(seam.at("transform").size(), 3u);
      EXPECT_TRUE(
          all(seam.at("transform"), [&](const Json& row) { return row.size() == 3 && all(row, is_number); }));
    }
    EXPECT_EQ(json.at("weights").at("kind"), "cotan");
    EXPECT_TRUE(json.at("weights").at("clamp").is_number());
    EXPECT_TRUE(json.at("weights").at("clamped_edges").is_number_integer());
    for (const char* key : {"energy", "gradient_norm"}) EXPECT_TRUE(json.at(key).is_number_float()) << key;
    for (const char* key : {"iterations", "evaluations", "peak_memory_bytes"})
      EXPECT_TRUE(json.at(key).is_number_integer()) << key;
    EXPECT_EQ(json.at("termination"), "converged");
    EXPECT_EQ(json.at("history").size(), json.at("iterations").get<std::size_t>() + 1);
    for (const Json& row : json.at("history"))
      for (const char* key : {"energy", "gradient_norm", "step"}) EXPECT_TRUE(row.at(key).is_number()) << key;

    const Json& certificate = json.at("certificate");
    EXPECT_EQ(certificate.at("bijective"), true);
    EXPECT_TRUE(all(certificate.at("nonpositive_faces"), is_integer));
    for (const char* key : {"signed_area", "expected_area", "max_edge_length", "max_seam_residual"})
      EXPECT_TRUE(certificate.at(key).is_number()) << key;
    EXPECT_FALSE(certificate.at("checks").empty());
    for (const Json& check : certificate.at("checks")) {
      EXPECT_TRUE(check.at("name").is_string());
      EXPECT_TRUE(check.at("passed").is_boolean());
      EXPECT_TRUE(check.at("value").is_number());
      EXPECT_TRUE(check.at("bound").is_number());
    }
    for (const char* key : {"mean", "std", "median", "max"})
      EXPECT_TRUE(json.at("distortion").at("area").at(key).is_number()) << key;
    for (const char* key : {"mean", "max"})
      EXPECT_TRUE(json.at("distortion").at("angle").at(key).is_number()) << key;
    EXPECT_TRUE(json.at("distortion").at("histogram").is_object());
    for (const char* key : {"read", "validate", "weights", "cut", "factorize", "initialize", "optimize",
                            "certify", "write", "total"})
      EXPECT_TRUE(json.at("timings").at(key).is_number()) << key;
    for (const char* key : {"version", "commit", "backend", "blas"})
      EXPECT_TRUE(json.at("environment").at(key).is_string()) << key;
    EXPECT_TRUE(json.at("environment").at("threads").is_number_integer());
    EXPECT_EQ(json.at("environment").at("input_sha256"), run.input_sha256);
  }
}

TEST(Report, EndsWithALineBreak) {
  EXPECT_EQ(report_json(test::sample_embedding("33").result, run).back(), '\n');
}

TEST(Report, ReadBackSaysTheSame) {
  for (const std::string& signature : test::all_sample_signatures()) {
    const EmbedResult& result = test::sample_embedding(signature).result;
    const Report report = read(report_json(result, run));
    EXPECT_EQ(report.signature, signature);
    EXPECT_EQ(report.group_order, result.embedding.target.group_order);
    EXPECT_EQ(report.space, result.embedding.space());
    ASSERT_TRUE(report.placement);
    EXPECT_EQ(report.placement->matrix(), result.embedding.placement.matrix());
    expect_same(report.seams, result.embedding.seams);
    expect_same(report.cones, result.embedding.cones);
    EXPECT_EQ(report.energy, result.minimum.energy);
    ASSERT_EQ(report.history.size(), result.minimum.history.size());
    EXPECT_EQ(report.history.back().gradient_norm, result.minimum.history.back().gradient_norm);
    EXPECT_EQ(report.weights.kind, WeightKind::cotan);
    EXPECT_EQ(report.weights.clamp, 0.01);
    EXPECT_TRUE(report.converged);
    EXPECT_TRUE(report.bijective);
    EXPECT_TRUE(report.nonpositive_faces.empty());
  }
}

// Reports of the first version.
TEST(Report, WithoutSpacePlacementAndAnglesItSpeaksOfTheSphereAndOfOrders) {
  Json json = sample_report("532");
  const Report expected = read(json.dump());
  json.erase("placement");
  json["orbifold"].erase("space");
  for (Json& cone : json["cones"]) cone.erase("angle");
  const Report report = read(json.dump());
  EXPECT_EQ(report.space, Space::sphere());
  EXPECT_FALSE(report.placement);
  EXPECT_TRUE(with_report(test::sample_embedding("532").embedding(), report).placement.is_identity());
  expect_same(report.cones, expected.cones);
}

TEST(Report, PlacementIsReadBack) {
  EmbedResult result = test::sample_embedding("532").result;
  result.embedding.placement = Space::sphere().rotation(Vector3(1, 2, 2) / 3, 0.7);
  const Report report = read(report_json(result, run));
  ASSERT_TRUE(report.placement);
  EXPECT_EQ(report.placement->matrix(), result.embedding.placement.matrix());
  EXPECT_LT((*report.placement * report.placement->inverse()).difference({}), 1e-15);
}

TEST(Report, MovedVerticesAndOtherWeightsAreTold) {
  EmbedResult result = test::sample_embedding("532").result;
  Json json = Json::parse(report_json(result, run));
  EXPECT_FALSE(json.contains("moved_vertices"));
  EXPECT_FALSE(json.at("weights").contains("requested"));
  result.moved_vertices = {3, 17};
  result.requested_weights = WeightKind::delaunay;
  json = Json::parse(report_json(result, run));
  EXPECT_EQ(json.at("moved_vertices"), Json({3, 17}));
  EXPECT_EQ(json.at("weights").at("requested"), "delaunay");
  EXPECT_EQ(json.at("weights").at("kind"), "cotan");
  EXPECT_EQ(read(json.dump()).moved_vertices, (std::vector<int>{3, 17}));
}

// Judging a report again

Verdict judged(const std::string& signature, const std::function<void(Json&)>& plant) {
  const test::SampleEmbedding& sample = test::sample_embedding(signature);
  Json json = sample_report(signature);
  plant(json);
  const Report report = parse_report(json.dump());
  return verify(test::unjudged(sample.mesh), with_report(sample.embedding(), report), report);
}

std::string failures(const Verdict& verdict) {
  std::string names;
  for (const Check& check : verdict.checks)
    if (!check.passed) names += check.name + " ";
  return names;
}

TEST(Verify, SeamsAreElementsOfTheGroupWhereTheReportSaysThatTheMapLies) {
  const Isometry turn = Space::sphere().rotation(Vector3(1, 2, 2) / 3, 0.7);
  const auto with_placement = [](const Isometry& placement) {
    return [&placement](Json& json) {
      for (int i = 0; i < 3; ++i)
        for (int k = 0; k < 3; ++k) json["placement"][i][k] = placement.matrix()(i, k);
    };
  };
  for (const std::string& signature : test::all_sample_signatures()) {
    EXPECT_EQ(failures(judged(signature, [](Json&) {})), "") << signature;
    EXPECT_EQ(failures(judged(signature, [](Json& json) { json.erase("placement"); })), "") << signature;
    if (parse_orbifold(signature).space == Space::sphere()) {
      // The antipodal map commutes with all rotations, and the whole sphere has no seam.
      const std::string off_axis = signature == "*" ? "report_centre " : "";
      const std::string fault = signature == "1x" || signature == "1" ? "" : "report_placement " + off_axis;
      EXPECT_EQ(failures(judged(signature, with_placement(turn))), fault) << signature;
    }
  }
}

TEST(Verify, MovedVerticesAreVerticesOfTheSurface) {
  EXPECT_EQ(failures(judged("532", [](Json& json) { json["moved_vertices"] = {0, 5}; })), "");
  EXPECT_EQ(failures(judged("532",
                            [](Json& json) {
                              json["moved_vertices"] = {0, 500000};
                            })),
            "report_moved_vertices ");
  EXPECT_EQ(failures(judged("532", [](Json& json) { json["moved_vertices"] = {-1}; })),
            "report_moved_vertices ");
}

TEST(Verify, TheOffsetsOfAFileAreJudged) {
  // Every row is off by 1e-11, and the offsets put it right.
  const test::SampleEmbedding& sample = test::sample_embedding("532");
  const Report report = parse_report(sample_report().dump());
  Embedding embedding = sample.embedding();
  for (int v = 0; v < embedding.positions.rows(); ++v) {
    const Vector3 p = embedding.positions.row(v), row = (p + Vector3(1e-11, 0, 0)).normalized();
    embedding.positions.row(v) = row;
    embedding.offsets.push_back({v, p - row});
  }
  Embedding read = with_report(parse_embedding(serialize_embedding(embedding)), report);
  EXPECT_EQ(failures(verify(test::unjudged(sample.mesh), read, report)), "");
  Embedding rows = read;
  rows.offsets.clear();
  EXPECT_EQ(failures(verify(test::unjudged(sample.mesh), rows, report)), "seam_residual report_bijective ");
  read.offsets[sample.embedding().seams[0].left[1]].d += Vector3(1e-4, 0, 0);
  EXPECT_NE(failures(verify(test::unjudged(sample.mesh), read, report)), "");
}

TEST(Report, AngleThatContradictsTheOrderIsRefused) {
  EXPECT_THAT(refusal_of_report([](Json& json) { json["cones"][0]["angle"] = 1.0; }),
              AllOf(HasSubstr("'order'"), HasSubstr("'angle'")));
}

TEST(Report, SaysWhatFailed) {
  EmbedResult result = test::sample_embedding("33").result;
  result.embedding.positions.row(40) = -result.embedding.positions.row(40);
  result.certificate = certify(test::unjudged(test::sample_embedding("33").mesh), result.embedding);
  result.minimum.termination = Termination::max_iterations;
  const Report report = read(report_json(result, run));
  EXPECT_FALSE(report.bijective);
  EXPECT_FALSE(report.converged);
  EXPECT_FALSE(report.nonpositive_faces.empty());
  EXPECT_EQ(report.nonpositive_faces, result.certificate.nonpositive_faces);
}

TEST(Report, AnyPathIsWrittenAsJson) {
  RunRecord odd = run;
  odd.mesh_path = "a \"quoted\"\n\\ \xff\xc3\x28 name";
  EXPECT_NO_THROW(read(report_json(test::sample_embedding("33").result, odd)));
}

TEST(Report, CutShortItIsRefused) {
  const std::string text = report_json(test::sample_embedding("33").result, run);
  for (std::size_t length = 0; length + 2 < text.size(); length += 1 + text.size() / 200)
    EXPECT_THAT(refusal_of_report(text.substr(0, length)), HasSubstr("not JSON")) << length;
}

TEST(Report, WhatIsNoReportIsRefused) {
  for (const char* text :
       {"", " ", "nonsense", "ply\n", "{", "[1, 2", "{\"schema\": }", "\x00\xff", "{\"energy\": 1e999}"})
    EXPECT_NE(refusal_of_report(text), "accepted") << text;
  for (const char* text : {"{}", "[]", "null", "7", "\"text\"", "true"})
    EXPECT_THAT(refusal_of_report(text), HasSubstr("'schema'")) << text;
  EXPECT_NE(refusal_of_report(std::string(100000, '[')), "accepted");
}

TEST(Report, MissingKeysAreNamed) {
  for (const char* pointer : {"/schema",
                              "/orbifold",
                              "/orbifold/signature",
                              "/orbifold/group_order",
                              "/seams",
                              "/seams/0/left",
                              "/seams/1/right",
                              "/seams/0/transform",
                              "/cones",
                              "/cones/2/vertex",
                              "/cones/0/order",
                              "/cones/1/kind",
                              "/cones/0/copies",
                              "/weights",
                              "/weights/kind",
                              "/weights/clamp",
                              "/energy",
                              "/history",
                              "/history/0/gradient_norm",
                              "/termination",
                              "/certificate",
                              "/certificate/bijective",
                              "/certificate/nonpositive_faces"}) {
    const Json::json_pointer path(pointer);
    const std::string sentence =
        refusal_of_report([&](Json& json) { json.at(path.parent_pointer()).erase(path.back()); });
    EXPECT_THAT(sentence, HasSubstr("'" + path.back() + "'")) << pointer;
    EXPECT_THAT(sentence, Not(HasSubstr("json.exception"))) << pointer;
    EXPECT_THAT(sentence, Not(HasSubstr("\n"))) << pointer;
  }
}

TEST(Report, ValuesOfTheWrongTypeAreNamed) {
  const std::vector<std::pair<const char*, std::vector<Json>>> faults = {
      {"/schema", {1, nullptr, Json::array(), "orbitutte.report/2", ""}},
      {"/orbifold", {1, "532", Json::array()}},
      {"/orbifold/signature", {532, nullptr, Json::array()}},
      {"/orbifold/group_order", {"60", 60.5, true, 0, -60, 4294967356LL, 1e300, Json::array({60})}},
      {"/orbifold/space", {1, nullptr, "flat", Json::array()}},
      {"/placement", {1, nullptr, Json::array(), Json({{1, 0, 0}, {0, 1, 0}, {0, 0}})}},
      {"/seams", {1, nullptr, "left", Json::object(), true}},
      {"/seams/0/left",
       {1, "1", nullptr, Json::object(), Json::array({"1"}), Json::array({1.5}), Json::array({true})}},
      {"/seams/0/right",
       {nullptr, Json::array({4294967296LL}), Json::array({-99999999999LL}), Json::array({Json::array({1})}),
        Json::array({18446744073709551615ULL})}},
      {"/seams/0/transform",
       {1, nullptr, Json::array(), Json::array({1, 2, 3}), Json({{1, 0, 0}, {0, 1, 0}}),
        Json({{1, 0, 0}, {0, 1, 0}, {0, 0}}), Json({{1, 0, 0}, {0, 1, 0}, {0, 0, "1"}}),
        Json({{1, 0, 0}, {0, 1, 0}, {0, 0, nullptr}}), Json({{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0, 0, 0}}),
        Json({{1, 0, 0, 0}, {0, 1, 0}, {0, 0, 1}})}},
      {"/cones", {1, nullptr, Json::object()}},
      {"/cones/0/vertex", {"1", 1.5, nullptr, true, 99999999999LL}},
      {"/cones/0/order", {"5", 5.5, nullptr, 99999999999LL}},
      {"/cones/0/angle", {"1", true, Json::array()}},
      {"/cones/0/kind", {1, nullptr, "", "cone"}},
      {"/cones/0/copies", {1, nullptr, Json::array({nullptr}), Json::array({"1"})}},
      {"/weights", {1, nullptr, "cotan"}},
      {"/weights/kind", {1, nullptr, "other"}},
      {"/weights/clamp", {"0.01", nullptr, true}},
      {"/energy", {"1", nullptr, true, Json::array()}},
      {"/termination", {1, nullptr, false}},
      {"/certificate", {1, nullptr, Json::array()}},
      {"/certificate/bijective", {1, 0, nullptr, "true"}},
      {"/certificate/nonpositive_faces", {1, nullptr, Json::array({"1"}), Json::array({1e10})}}};
  for (const auto& [pointer, values] : faults) {
    const Json::json_pointer path(pointer);
    for (const Json& value : values) {
      const std::string sentence = refusal_of_report([&](Json& json) { json.at(path) = value; });
      EXPECT_THAT(sentence, HasSubstr("'" + path.back() + "'")) << pointer << " = " << value;
      EXPECT_THAT(sentence, Not(HasSubstr("json.exception"))) << pointer << " = " << value;
    }
  }
  // Elements of lists that are no objects: the first key that they ought to have is named.
  EXPECT_THAT(refusal_of_report([](Json& json) { json["seams"][0] = 1; }), HasSubstr("'left'"));
  EXPECT_THAT(refusal_of_report([](Json& json) { json["cones"][0] = nullptr; }),
              ContainsRegex("'kind'|'vertex'"));
}

TEST(Report, BanksOfDifferentLengthsAreRefused) {
  EXPECT_THAT(refusal_of_report([](Json& json) { json["seams"][0]["left"].push_back(0); }),
              HasSubstr("'left'"));
}

TEST(Report, MissingFileIsAFileError) { EXPECT_THROW(read_report("/nowhere/report.json"), FileError); }

// The embedding

TEST(EmbeddingFile, RoundTripIsExact) {
  for (const std::string& signature : test::all_sample_signatures()) {
    const Embedding& written = test::sample_embedding(signature).embedding();
    const TemporaryFile file(serialize_embedding(written), ".ply");
    const Embedding read_back = read_embedding(file.path());
    EXPECT_EQ(read_back.positions, written.positions) << signature;
    EXPECT_EQ(read_back.triangles, written.triangles) << signature;
    EXPECT_EQ(read_back.source_vertex, written.source_vertex) << signature;
  }
}

TEST(EmbeddingFile, WithItsReportIsCertifiedAgain) {
  for (const char* signature : {"532", "33", "*432", "*22", "442", "2222", "*333"}) {
    const test::SampleEmbedding& sample = test::sample_embedding(signature);
    const TemporaryFile file(serialize_embedding(sample.embedding()), ".ply");
    const Embedding embedding = read_embedding(file.path(), read(report_json(sample.result, run)));
    EXPECT_EQ(embedding.target.signature, signature);
    EXPECT_EQ(embedding.space(), sample.embedding().space());
    EXPECT_TRUE(certify(test::unjudged(sample.mesh), embedding).bijective);
  }
}

TEST(EmbeddingFile, ExtremeNumbersSurvive) {
  Embedding embedding;
  embedding.positions.resize(3, 3);
  embedding.positions << 1.0 / 3, -0.0, std::numeric_limits<double>::denorm_min(), std::nextafter(1.0, 2.0),
      1e-300, -1, std::numeric_limits<double>::max(), 0, 1;
  embedding.triangles.resize(1, 3);
  embedding.triangles << 2, 0, 1;
  embedding.source_vertex = {0, 1, 1};
  const TemporaryFile file(serialize_embedding(embedding), ".ply");
  const Embedding read_back = read_embedding(file.path());
  EXPECT_EQ(read_back.positions, embedding.positions);
  EXPECT_TRUE(std::signbit(read_back.positions(0, 1)));
  EXPECT_EQ(read_back.source_vertex, embedding.source_vertex);
}

bool same_bits(double a, double b) {
  return std::bit_cast<std::uint64_t>(a) == std::bit_cast<std::uint64_t>(b);
}

TEST(EmbeddingFile, HoldsTheSameBitsForAnyReaderOfPly) {
  for (const std::string& signature : test::all_sample_signatures()) {
    const Embedding& written = test::sample_embedding(signature).embedding();
    const PlyFile file = parse_ply(serialize_embedding(written));
    EXPECT_EQ(file.comments, std::vector<std::string>{"orbitutte embedding " + signature});
    const PlyElement &vertex = *file.find("vertex"), &face = *file.find("face");
    ASSERT_EQ(vertex.count, written.source_vertex.size());
    for (int k = 0; k < 3; ++k) {
      const Eigen::VectorXd column = written.positions.col(k);
      EXPECT_TRUE(std::equal(column.begin(), column.end(), vertex.properties[k].values.begin(), same_bits));
    }
    EXPECT_THAT(vertex.find("source_vertex")->values, ::testing::ElementsAreArray(written.source_vertex));
    ASSERT_EQ(face.count, static_cast<std::size_t>(written.triangles.rows()));
    const auto corners = written.triangles.reshaped<Eigen::RowMajor>();
    EXPECT_TRUE(std::equal(corners.begin(), corners.end(), face.find("vertex_indices")->values.begin()));
    EXPECT_EQ(serialize_ply(file), serialize_embedding(written)) << signature;
  }
}

TEST(EmbeddingFile, FurtherPropertiesMakeNoDifference) {
  const Embedding& written = test::sample_embedding("33").embedding();
  PlyFile file = parse_ply(serialize_embedding(written));
  for (PlyElement& element : file.elements) {
    PlyProperty zeros;
    zeros.name = "zeros";
    zeros.values.resize(element.count);
    element.properties.insert(element.properties.begin(), zeros);
    const TemporaryFile disk(serialize_ply(file), ".ply");
    const Embedding read_back = read_embedding(disk.path());
    EXPECT_EQ(read_back.positions, written.positions);
    EXPECT_EQ(read_back.triangles, written.triangles);
    EXPECT_EQ(read_back.source_vertex, written.source_vertex);
  }
}

std::string ply(const std::string& vertex_properties, const std::string& vertices,
                const std::string& face_property, const std::string& faces) {
  return "ply\nformat ascii 1.0\nelement vertex 3\n" + vertex_properties + "element face 1\n" +
         face_property + "end_header\n" + vertices + faces;
}

const std::string xyzs =
    "property double x\nproperty double y\nproperty double z\nproperty int source_vertex\n";
const std::string triple = "1 0 0 0\n0 1 0 1\n0 0 1 2\n";
const std::string list = "property list uchar int vertex_indices\n";

std::string ply_refusal(const std::string& bytes) {
  const TemporaryFile file(bytes, ".ply");
  try {
    read_embedding(file.path());
  } catch (const MeshError& error) {
    return error.what();
  }
  return "accepted";
}

TEST(EmbeddingFile, DefectsAreNamed) {
  EXPECT_EQ(ply_refusal(ply(xyzs, triple, list, "3 0 1 2\n")), "accepted");
  EXPECT_THAT(ply_refusal(ply("property double x\nproperty double y\nproperty int source_vertex\n",
                              "1 0 0\n0 1 1\n0 0 2\n", list, "3 0 1 2\n")),
              HasSubstr("'z'"));
  EXPECT_THAT(ply_refusal(ply("property double x\nproperty double y\nproperty double z\n",
                              "1 0 0\n0 1 0\n0 0 1\n", list, "3 0 1 2\n")),
              HasSubstr("'source_vertex'"));
  EXPECT_THAT(ply_refusal(ply(xyzs, triple, "property list uchar int corners\n", "3 0 1 2\n")),
              HasSubstr("'vertex_indices'"));
  EXPECT_THAT(ply_refusal(ply(xyzs, triple, "property int vertex_indices\n", "0\n")),
              HasSubstr("'vertex_indices'"));
  EXPECT_THAT(ply_refusal(ply(xyzs, triple, list, "2 0 1\n")),
              HasSubstr("face 0 has fewer than three corners"));
  EXPECT_THAT(ply_refusal(ply(xyzs, triple, list, "3 0 1 3\n")),
              AllOf(HasSubstr("face 0"), HasSubstr("vertex 3")));
  EXPECT_THAT(ply_refusal(ply(xyzs, triple, list, "3 0 1 -1\n")),
              AllOf(HasSubstr("face 0"), HasSubstr("vertex -1")));
  EXPECT_THAT(ply_refusal(ply(xyzs, "1 0 0 0\n0 1 0 7\n0 0 1 2\n", list, "3 0 1 2\n")),
              AllOf(HasSubstr("cut vertex 1"), HasSubstr("vertex 7")));
  EXPECT_NE(ply_refusal(ply(xyzs, triple, list, "3 0 1\n")), "accepted");
  EXPECT_NE(ply_refusal("ply\nformat ascii 1.0\nelement vertex 0\nend_header\n"), "accepted");
  EXPECT_NE(ply_refusal(""), "accepted");
  EXPECT_NE(ply_refusal("{}"), "accepted");
}

TEST(EmbeddingFile, DefectsOfBinaryFilesAreNamed) {
  const Embedding& good = test::sample_embedding("33").embedding();
  const int count = static_cast<int>(good.source_vertex.size());
  for (const int wrong : {-1, count}) {
    const std::string named =
        "names the vertex " + std::to_string(wrong) + ", but there are " + std::to_string(count);
    Embedding embedding = good;
    embedding.source_vertex[5] = wrong;
    EXPECT_THAT(ply_refusal(serialize_embedding(embedding)),
                HasSubstr("the source of cut vertex 5 " + named));
    embedding = good;
    embedding.triangles(7, 2) = wrong;
    EXPECT_THAT(ply_refusal(serialize_embedding(embedding)), HasSubstr("face 7 " + named));
  }
}

TEST(EmbeddingFile, CutShortItIsRefused) {
  const std::string bytes = serialize_embedding(test::sample_embedding("33").embedding());
  for (std::size_t length = 0; length < bytes.size(); length += 1 + bytes.size() / 100)
    EXPECT_NE(ply_refusal(bytes.substr(0, length)), "accepted") << length;
  EXPECT_NE(ply_refusal(bytes.substr(0, bytes.size() - 1)), "accepted");
}

TEST(EmbeddingFile, MissingFileIsAFileError) {
  EXPECT_THROW(read_embedding("/nowhere/embedding.ply"), FileError);
}

TEST(EmbeddingFile, ReportOfAnotherEmbeddingIsRefused) {
  const Embedding& embedding = test::sample_embedding("33").embedding();
  const TemporaryFile file(serialize_embedding(embedding), ".ply");
  const Report good = read(report_json(test::sample_embedding("33").result, run));
  const int count = static_cast<int>(embedding.source_vertex.size());
  for (const int wrong : {-1, count, std::numeric_limits<int>::max(), std::numeric_limits<int>::min()}) {
    for (const std::function<int&(Report&)>& place :
         {std::function<int&(Report&)>([](Report& r) -> int& { return r.seams[0].left[1]; }),
          std::function<int&(Report&)>([](Report& r) -> int& { return r.seams[0].right.back(); }),
          std::function<int&(Report&)>([](Report& r) -> int& { return r.cones[1].copies[0]; })}) {
      Report report = good;
      place(report) = wrong;
      try {
        read_embedding(file.path(), report);
        ADD_FAILURE() << wrong << " is accepted";
      } catch (const MeshError& error) {
        EXPECT_THAT(error.what(), HasSubstr("the cut vertex " + std::to_string(wrong)));
      }
    }
  }
}

TEST(Sha256, DigestsOfTheStandard) {
  EXPECT_EQ(sha256("abc"), "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
  EXPECT_EQ(sha256(""), "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
  EXPECT_EQ(sha256("abcdbcdecdefdefgefghfghighijhijkijkljklmklmnlmnomnopnopq"),
            "248d6a61d20638b8e5c026930c3e6039a33ce45964ff2167f6ecedd419db06c1");
  EXPECT_EQ(sha256(std::string(1000000, 'a')),
            "cdc76e5c9914fb9281a1c7e284d73e67f1809a48a497200e046d39ccc7112cd0");
}

}  // namespace
}  // namespace orbitutte::report_test
