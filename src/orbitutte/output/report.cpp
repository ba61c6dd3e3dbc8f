// SPDX-License-Identifier: MIT
#include "orbitutte/output/report.h"

#include <fmt/format.h>
#include <openssl/evp.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "orbitutte/mesh/file.h"
#include "orbitutte/output/embedding_file.h"
#include "orbitutte/version.h"

namespace orbitutte {
namespace {

using Json = nlohmann::ordered_json;

Json to_json(const Matrix3& M) {
  Json rows = Json::array();
  for (int i = 0; i < 3; ++i) rows.push_back({M(i, 0), M(i, 1), M(i, 2)});
  return rows;
}

Json to_json(const ConeCopies& cone) {
  return {{"vertex", cone.vertex}, {"order", cone.order}, {"kind", name(cone.kind)}, {"copies", cone.copies}};
}

Json to_json(const Seam& seam) {
  return {{"kind", name(seam.kind())},
          {"left", seam.left},
          {"right", seam.right},
          {"transform", to_json(seam.transform)}};
}

Json to_json(const EdgeWeights& weights) {
  return {{"kind", name(weights.kind)}, {"clamp", weights.clamp}, {"clamped_edges", weights.clamped_edges}};
}

Json to_json(const Certificate& certificate) {
  Json checks = Json::array();
  for (const Check& check : certificate.checks) {
    Json row = {
        {"name", check.name}, {"passed", check.passed}, {"value", check.value}, {"bound", check.bound}};
    if (!check.detail.empty()) row["detail"] = check.detail;
    checks.push_back(std::move(row));
  }
  return {{"bijective", certificate.bijective},
          {"nonpositive_faces", certificate.nonpositive_faces},
          {"signed_area", certificate.signed_area},
          {"expected_area", certificate.expected_area},
          {"max_edge_length", certificate.max_edge_length},
          {"max_seam_residual", certificate.max_seam_residual},
          {"checks", std::move(checks)}};
}

Json to_json(const Distortion& distortion) {
  const auto& [mean, std, median, max] = distortion.area;
  return {{"area", {{"mean", mean}, {"std", std}, {"median", median}, {"max", max}}},
          {"angle", {{"mean", distortion.angle.mean}, {"max", distortion.angle.max}}},
          {"histogram",
           {{"quantity", "log2 of the area ratio"},
            {"edges", distortion.histogram.edges},
            {"counts", distortion.histogram.counts}}},
          {"measured_faces", distortion.measured_faces}};
}

Json history_json(const std::vector<Iteration>& history) {
  Json rows = Json::array();
  for (const Iteration& row : history)
    rows.push_back({{"energy", row.energy}, {"gradient_norm", row.gradient_norm}, {"step", row.step}});
  return rows;
}

Json timings_json(const Timings& stages, const RunRecord& run) {
  Json timings = {{"read", run.read_seconds}};
  for (const auto& [stage, seconds] : stages) timings[stage] = seconds;
  timings["write"] = run.write_seconds;
  timings["total"] = run.total_seconds;
  return timings;
}

Json environment_json(const EmbedResult& result, const RunRecord& run) {
  return {{"version", version},
          {"commit", commit},
          {"backend", name(result.backend)},
          {"blas", blas_description(result.backend)},
          {"threads", result.threads},
          {"input_sha256", run.input_sha256}};
}

template <typename Values, typename Convert>
Json list(const Values& values, const Convert& convert) {
  Json rows = Json::array();
  for (const auto& value : values) rows.push_back(convert(value));
  return rows;
}

ConeKind cone_kind(const std::string& text) {
  for (const ConeKind kind : {ConeKind::rotation, ConeKind::corner, ConeKind::fixed})
    if (name(kind) == text) return kind;
  throw MeshError(fmt::format("'{}' is no kind of cone", text));
}

WeightKind weight_kind(const std::string& text) {
  for (const WeightKind kind : {WeightKind::cotan, WeightKind::uniform, WeightKind::file})
    if (name(kind) == text) return kind;
  throw MeshError(fmt::format("'{}' is no kind of weights", text));
}

Seam to_seam(const Json& json) {
  Seam seam;
  seam.left = json.at("left").get<std::vector<int>>();
  seam.right = json.at("right").get<std::vector<int>>();
  for (int i = 0; i < 3; ++i)
    for (int k = 0; k < 3; ++k) seam.transform(i, k) = json.at("transform").at(i).at(k).get<double>();
  if (seam.left.size() != seam.right.size()) throw MeshError("a seam has banks of different lengths");
  return seam;
}

ConeCopies to_cone(const Json& json) {
  return {json.at("vertex").get<int>(), json.at("order").get<int>(),
          cone_kind(json.at("kind").get<std::string>()), json.at("copies").get<std::vector<int>>()};
}

Report to_report(const Json& json) {
  if (json.at("schema").get<std::string>() != "orbitutte.report/1")
    throw MeshError(
        fmt::format("the schema is '{}', not 'orbitutte.report/1'", json.at("schema").get<std::string>()));
  Report report;
  report.signature = json.at("orbifold").at("signature").get<std::string>();
  report.group_order = json.at("orbifold").at("group_order").get<int>();
  if (report.group_order < 1) throw MeshError("the group order is not positive");
  for (const Json& seam : json.at("seams")) report.seams.push_back(to_seam(seam));
  for (const Json& cone : json.at("cones")) report.cones.push_back(to_cone(cone));
  report.weights.kind = weight_kind(json.at("weights").at("kind").get<std::string>());
  report.weights.clamp = json.at("weights").at("clamp").get<double>();
  report.energy = json.at("energy").get<double>();
  report.converged = json.at("termination").get<std::string>() == name(Termination::converged);
  report.bijective = json.at("certificate").at("bijective").get<bool>();
  report.nonpositive_faces = json.at("certificate").at("nonpositive_faces").get<std::vector<int>>();
  return report;
}

}  // namespace

std::string report_json(const EmbedResult& result, const RunRecord& run) {
  const Embedding& embedding = result.embedding;
  const Minimum& minimum = result.minimum;
  const int vertices = static_cast<int>(minimum.positions.rows());
  const Json json = {
      {"schema", "orbitutte.report/1"},
      {"mesh",
       {{"path", run.mesh_path},
        {"vertices", vertices},
        {"faces", embedding.faces.rows()},
        {"topology", name(result.topology)},
        {"unreferenced_vertices", result.unreferenced_vertices},
        {"zero_area_faces", result.zero_area_faces}}},
      {"orbifold", {{"signature", embedding.signature}, {"group_order", embedding.group_order}}},
      {"cones", list(embedding.cones, [](const ConeCopies& cone) { return to_json(cone); })},
      {"seams", list(embedding.seams, [](const Seam& seam) { return to_json(seam); })},
      {"weights", to_json(result.weights)},
      {"energy", minimum.energy},
      {"iterations", minimum.iterations},
      {"evaluations", minimum.evaluations},
      {"termination", name(minimum.termination)},
      {"gradient_norm", minimum.gradient_norm},
      {"history", history_json(minimum.history)},
      {"certificate", to_json(result.certificate)},
      {"distortion", to_json(result.distortion)},
      {"warnings", result.warnings},
      {"timings", timings_json(result.timings, run)},
      {"peak_memory_bytes", run.peak_memory_bytes},
      {"environment", environment_json(result, run)}};
  return json.dump(1, ' ', false, Json::error_handler_t::replace) + "\n";
}

Report read_report(const std::string& path) {
  const std::string text = read_file(path);
  try {
    return to_report(Json::parse(text));
  } catch (const nlohmann::json::exception& error) {
    throw MeshError(fmt::format("{}: this is no report of orbitutte: {}", path, error.what()));
  } catch (const MeshError& error) {
    throw MeshError(fmt::format("{}: {}", path, error.what()));
  }
}

Embedding read_embedding(const std::string& ply_path, const Report& report) {
  Embedding embedding = read_embedding(ply_path);
  embedding.signature = report.signature;
  embedding.group_order = report.group_order;
  embedding.seams = report.seams;
  embedding.cones = report.cones;
  const int count = static_cast<int>(embedding.source_vertex.size());
  const auto require = [&](const std::vector<int>& vertices) {
    for (const int v : vertices)
      if (v < 0 || v >= count)
        throw MeshError(
            fmt::format("the report names the cut vertex {}, but {} holds {}", v, ply_path, count));
  };
  for (const Seam& seam : embedding.seams) {
    require(seam.left);
    require(seam.right);
  }
  for (const ConeCopies& cone : embedding.cones) require(cone.copies);
  return embedding;
}

std::string sha256(std::string_view bytes) {
  unsigned char digest[EVP_MAX_MD_SIZE];
  unsigned int length = 0;
  if (!EVP_Digest(bytes.data(), bytes.size(), digest, &length, EVP_sha256(), nullptr))
    throw Error("OpenSSL could not compute a SHA-256 digest");
  std::string text;
  for (unsigned int k = 0; k < length; ++k) text += fmt::format("{:02x}", digest[k]);
  return text;
}

}  // namespace orbitutte
