// SPDX-License-Identifier: MIT
#include "orbitutte/report/report.h"

#include <fmt/format.h>
#include <openssl/evp.h>

#include <cstdint>
#include <limits>
#include <nlohmann/json.hpp>

#include "orbitutte/io/file.h"
#include "orbitutte/mesh/intrinsic_triangulation.h"
#include "orbitutte/orbifold/polygon.h"
#include "orbitutte/report/embedding_file.h"
#include "orbitutte/report/program.h"

namespace orbitutte {
namespace {

using Json = nlohmann::ordered_json;

Json to_json(const Matrix3& M) {
  Json rows = Json::array();
  for (int i = 0; i < 3; ++i) rows.push_back({M(i, 0), M(i, 1), M(i, 2)});
  return rows;
}

Json to_json(const Target& target) {
  return {{"signature", target.signature},
          {"group_order", target.group_order > 0 ? Json(target.group_order) : Json()},
          {"space", target.space.name()}};
}

Json to_json(const ConeCopies& cone) {
  const int order = cone.mark.order();
  return {{"vertex", cone.vertex},
          {"order", order > 0 ? Json(order) : Json()},
          {"angle", cone.mark.angle},
          {"kind", name_of(cone.mark.kind)},
          {"copies", cone.copies}};
}

Json to_json(const Seam& seam) {
  return {{"kind", name_of(seam.kind())},
          {"left", seam.left},
          {"right", seam.right},
          {"transform", to_json(seam.transform.matrix())}};
}

// The tile whose shape was found: its area, and where its marks lie.
Json tile_json(const Embedding& embedding) {
  Json positions = Json::array();
  for (const ConeCopies& cone : embedding.cones) {
    const Vector3 p = embedding.positions.row(cone.vertex);
    positions.push_back({p.x(), p.y(), p.z()});
  }
  return {{"area", target_area(embedding.target)}, {"marks", std::move(positions)}};
}

Json to_json(const PolygonCorner& at) {
  return {{"vertex", at.vertex}, {"position", {at.position.x(), at.position.y(), at.position.z()}}};
}

// Of the map that the quotient was made from.
Json base_json(const QuotientRecord& quotient) {
  return {{"signature", quotient.signature}, {"cones", quotient.cones}};
}

Json weights_json(const EmbedResult& result) {
  const EdgeWeights& weights = result.weights;
  Json json = {
      {"kind", name_of(weights.kind)}, {"clamp", weights.clamp}, {"clamped_edges", weights.clamped_edges}};
  if (result.requested_weights) json["requested"] = name_of(*result.requested_weights);
  if (weights.triangulation) {
    json["flips"] = weights.triangulation->flips.size();
    json["kept_faces"] = weights.triangulation->kept_faces;
  }
  return json;
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
          {"angle",
           {{"mean", distortion.angle.mean},
            {"area_mean", distortion.angle.area_mean},
            {"median", distortion.angle.median},
            {"max", distortion.angle.max}}},
          {"sigma", distortion.sigma},
          {"within_4", distortion.within_4},
          {"below_64", distortion.below_64},
          {"histogram",
           {{"quantity", "log2 of the area ratio"},
            {"edges", distortion.histogram.edges},
            {"counts", distortion.histogram.counts}}},
          {"measured_faces", distortion.measured_faces}};
}

Json to_json(const StrainStatistics& statistics) {
  Json percentiles = Json::object();
  for (std::size_t k = 0; k < std::size(StrainStatistics::percents); ++k)
    percentiles[std::to_string(StrainStatistics::percents[k])] = statistics.percentiles[k];
  return {{"mean", statistics.mean},
          {"mean_absolute", statistics.mean_absolute},
          {"percentiles", std::move(percentiles)}};
}

Json to_json(const std::vector<StrainStatistics>& strain) {
  Json json = Json::object();
  for (std::size_t k = 0; k < strain.size(); ++k)
    json[name_of(static_cast<StrainMeasure>(k))] = to_json(strain[k]);
  return json;
}

Json history_json(const std::vector<Iteration>& history) {
  Json rows = Json::array();
  for (const Iteration& row : history)
    rows.push_back({{"energy", row.energy}, {"gradient_norm", row.gradient_norm}, {"step", row.step}});
  return rows;
}

Json timings_json(const Timings& stages, const RunRecord& run) {
  Json timings = {{"read", run.read_seconds}, {"validate", run.validate_seconds}};
  for (const auto& [stage, seconds] : stages) timings[stage] = timings.value(stage, 0.0) + seconds;
  timings["write"] = run.write_seconds;
  timings["total"] = run.total_seconds;
  return timings;
}

Json repair_json(const RepairSummary& repair) {
  Json steps = Json::array();
  for (const RepairRecord& record : repair.records)
    steps.push_back({{"step", name_of(record.step)}, {"count", record.count}, {"message", record.message}});
  return {{"steps", std::move(steps)}, {"added_vertices", repair.added}};
}

Json environment_json(const EmbedResult& result, const RunRecord& run) {
  return {{"version", this_program().version},  {"commit", this_program().commit},
          {"backend", name_of(result.backend)}, {"blas", blas_description()},
          {"threads", result.threads},          {"input_sha256", run.input_sha256}};
}

template <typename Values, typename Convert>
Json list(const Values& values, const Convert& convert) {
  Json rows = Json::array();
  for (const auto& value : values) rows.push_back(convert(value));
  return rows;
}

// Reading: every value is looked up by its key, which the message names if the value is missing or of the
// wrong type.
const Json& member(const Json& object, const char* key) {
  const auto at = object.find(key);
  if (at == object.end()) throw MeshError(fmt::format("the key '{}' is missing", key));
  return *at;
}

const Json& typed(const Json& value, const char* key, bool is_right, const char* type) {
  if (!is_right) throw MeshError(fmt::format("the value of '{}' is not {}", key, type));
  return value;
}

const Json& object(const Json& json, const char* key) {
  const Json& value = member(json, key);
  return typed(value, key, value.is_object(), "an object");
}

const Json& array(const Json& json, const char* key) {
  const Json& value = member(json, key);
  return typed(value, key, value.is_array(), "a list");
}

std::string text(const Json& json, const char* key) {
  const Json& value = member(json, key);
  return typed(value, key, value.is_string(), "a text").get<std::string>();
}

bool boolean(const Json& json, const char* key) {
  const Json& value = member(json, key);
  return typed(value, key, value.is_boolean(), "true or false").get<bool>();
}

double to_number(const Json& value, const char* key) {
  return typed(value, key, value.is_number(), "a number").get<double>();
}

int to_integer(const Json& value, const char* key) {
  typed(value, key, value.is_number_integer(), "a whole number");
  const auto number = value.get<std::int64_t>();
  constexpr int largest = std::numeric_limits<int>::max();
  const bool wrapped = value.is_number_unsigned() && number < 0;
  typed(value, key, !wrapped && number >= -largest && number <= largest, "a whole number of 32 bits");
  return static_cast<int>(number);
}

double number(const Json& json, const char* key) { return to_number(member(json, key), key); }

int integer(const Json& json, const char* key) { return to_integer(member(json, key), key); }

std::vector<int> integers(const Json& json, const char* key) {
  std::vector<int> values;
  for (const Json& value : array(json, key)) values.push_back(to_integer(value, key));
  return values;
}

Matrix3 matrix(const Json& json, const char* key) {
  const char* const type = "a 3 x 3 matrix";
  const Json& rows = array(json, key);
  typed(rows, key, rows.size() == 3, type);
  Matrix3 M;
  for (int i = 0; i < 3; ++i) {
    typed(rows[i], key, rows[i].is_array() && rows[i].size() == 3, type);
    for (int k = 0; k < 3; ++k) M(i, k) = to_number(rows[i][k], key);
  }
  return M;
}

template <typename Kind>
Kind to_kind(const std::string& name, const char* what) {
  if (const auto kind = find_by_name<Kind>(name)) return *kind;
  throw MeshError(fmt::format("the 'kind' of {} is '{}', which is not known", what, name));
}

Space to_space(const std::string& name) {
  for (const Space space : {Space::sphere(), Space::plane(), Space::hyperbolic_plane()})
    if (space.name() == name) return space;
  throw MeshError(fmt::format("the 'space' is '{}', not spherical, euclidean or hyperbolic", name));
}

Seam to_seam(Space space, const Json& json) {
  Seam seam = {integers(json, "left"), integers(json, "right"), space.isometry(matrix(json, "transform"))};
  if (seam.left.size() != seam.right.size())
    throw MeshError("the banks 'left' and 'right' of a seam have different lengths");
  return seam;
}

// Reports of the first version have no angles; the order is null if the angle is not 2 pi/n.
Mark to_mark(const Json& json) {
  const auto kind = to_kind<ConeKind>(text(json, "kind"), "a cone");
  const bool has_order = !json.contains("order") || !json["order"].is_null();
  const int order = has_order ? integer(json, "order") : 0;
  if (has_order && !json.contains("angle")) return Mark::of_order(order, kind);
  const Mark mark = {number(json, "angle"), kind};
  if (mark.order() != order)
    throw MeshError(
        fmt::format("a cone has the 'order' {}, which its 'angle' {} contradicts", order, mark.angle));
  return mark;
}

ConeCopies to_cone(const Json& json) {
  const Mark mark = to_mark(json);
  return {integer(json, "vertex"), mark, integers(json, "copies")};
}

WeightOptions to_weights(const Json& json) {
  const auto kind = to_kind<WeightKind>(text(json, "kind"), "the weights");
  if (kind == WeightKind::standard)
    throw MeshError("the 'kind' of the weights is 'standard', which stands for another one");
  return {kind, number(json, "clamp"), {}};
}

Vector3 vector(const Json& json, const char* key) {
  const char* const type = "a list of three numbers";
  const Json& row = array(json, key);
  typed(row, key, row.size() == 3, type);
  return {to_number(row[0], key), to_number(row[1], key), to_number(row[2], key)};
}

PolygonCorner to_point(const Json& json) { return {integer(json, "vertex"), vector(json, "position")}; }

QuotientRecord to_quotient(const Json& json) {
  const Json& base = object(json, "quotient_of");
  QuotientRecord quotient = {text(base, "signature"), integers(base, "cones"), Centre::none, {}};
  if (json.contains("centre")) quotient.centre = to_kind<Centre>(text(json, "centre"), "the centre");
  if (json.contains("points"))
    for (const Json& at : array(json, "points")) quotient.points.push_back(to_point(at));
  return quotient;
}

std::vector<Iteration> to_history(const Json& rows) {
  std::vector<Iteration> history;
  for (const Json& row : rows) {
    typed(row, "history", row.is_object(), "a list of objects");
    history.push_back({number(row, "energy"), number(row, "gradient_norm"), number(row, "step")});
  }
  return history;
}

Report to_report(const Json& json) {
  if (text(json, "schema") != "orbitutte.report/1")
    throw MeshError(fmt::format("the 'schema' is '{}', not 'orbitutte.report/1'", text(json, "schema")));
  Report report;
  const Json& orbifold = object(json, "orbifold");
  report.signature = text(orbifold, "signature");
  if (orbifold.contains("space")) report.space = to_space(text(orbifold, "space"));
  if (!orbifold.contains("group_order") || !orbifold["group_order"].is_null()) {
    report.group_order = integer(orbifold, "group_order");
    if (report.group_order < 1) throw MeshError("the value of 'group_order' is not positive");
  }
  if (json.contains("moved_vertices")) report.moved_vertices = integers(json, "moved_vertices");
  if (json.contains("quotient") && boolean(json, "quotient")) report.quotient = to_quotient(json);
  report.is_repaired = json.contains("repair");
  if (json.contains("placement")) report.placement = report.space.isometry(matrix(json, "placement"));
  for (const Json& seam : array(json, "seams")) report.seams.push_back(to_seam(report.space, seam));
  for (const Json& cone : array(json, "cones")) report.cones.push_back(to_cone(cone));
  const Json& weights = object(json, "weights");
  report.weights = to_weights(weights);
  if (report.weights.kind == WeightKind::delaunay) report.kept_faces = integers(weights, "kept_faces");
  report.energy = number(json, "energy");
  report.history = to_history(array(json, "history"));
  report.converged = text(json, "termination") == name_of(Termination::converged);
  const Json& certificate = object(json, "certificate");
  report.bijective = boolean(certificate, "bijective");
  report.expected_area = number(certificate, "expected_area");
  report.nonpositive_faces = integers(certificate, "nonpositive_faces");
  if (json.contains("intrinsic_certificate"))
    report.intrinsic_bijective = boolean(object(json, "intrinsic_certificate"), "bijective");
  return report;
}

std::string report_text(const Json& json) {
  return json.dump(1, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace

std::string report_json(const EmbedResult& result, const RunRecord& run) {
  const Embedding& embedding = result.embedding;
  const Minimum& minimum = result.minimum;
  const int vertices = static_cast<int>(minimum.positions.rows());
  Json json = {{"schema", "orbitutte.report/1"},
               {"mesh",
                {{"path", run.mesh_path},
                 {"vertices", vertices},
                 {"faces", embedding.faces().count()},
                 {"topology", name_of(result.topology)},
                 {"unreferenced_vertices", result.unreferenced_vertices},
                 {"zero_area_faces", result.zero_area_faces}}},
               {"orbifold", to_json(embedding.target)},
               {"placement", to_json(embedding.placement.matrix())},
               {"cones", list(embedding.cones, [](const ConeCopies& cone) { return to_json(cone); })},
               {"seams", list(embedding.seams, [](const Seam& seam) { return to_json(seam); })},
               {"weights", weights_json(result)},
               {"energy", minimum.energy},
               {"iterations", minimum.iterations},
               {"evaluations", minimum.evaluations},
               {"termination", name_of(minimum.termination)},
               {"gradient_norm", minimum.gradient_norm},
               {"history", history_json(minimum.history)},
               {"certificate", to_json(result.certificate)},
               {"distortion", to_json(result.distortion)},
               {"warnings", result.warnings},
               {"timings", timings_json(result.timings, run)},
               {"peak_memory_bytes", run.peak_memory_bytes},
               {"environment", environment_json(result, run)}};
  if (result.quotient) {
    json["quotient"] = true;
    json["quotient_of"] = base_json(*result.quotient);
    json["centre"] = name_of(result.quotient->centre);
    if (!result.quotient->points.empty())
      json["points"] = list(result.quotient->points, [](const PolygonCorner& at) { return to_json(at); });
  }
  if (embedding.target.has_free_tile) {
    json["tile"] = tile_json(embedding);
    json["conformality"] = minimum.energy / (2 * target_area(embedding.target));
    if (!minimum.shapes.empty()) json["shapes"] = history_json(minimum.shapes);
  }
  if (!run.strain.empty()) json["distortion"]["strain"] = to_json(run.strain);
  if (run.repair) json["repair"] = repair_json(*run.repair);
  if (result.floor) json["floor"] = to_json(*result.floor);
  if (!result.moved_vertices.empty()) json["moved_vertices"] = result.moved_vertices;
  if (result.intrinsic_certificate) json["intrinsic_certificate"] = to_json(*result.intrinsic_certificate);
  return report_text(json);
}

std::string distortion_json(const Distortion& distortion) { return to_json(distortion).dump(); }

std::string strain_json(const std::vector<StrainStatistics>& strain) {
  return to_json(strain).dump(1) + "\n";
}

std::string with_strain(std::string_view report, const std::vector<StrainStatistics>& strain) {
  Json json = Json::parse(report);
  json["distortion"]["strain"] = to_json(strain);
  return report_text(json);
}

Report parse_report(std::string_view text) {
  try {
    return to_report(Json::parse(text));
  } catch (const nlohmann::json::parse_error& error) {
    throw MeshError(fmt::format("the file is not JSON: byte {} cannot be read", error.byte));
  } catch (const nlohmann::json::out_of_range&) {
    throw MeshError("a number is too large to be read");
  }
}

Report read_report(const std::string& path) { return parse_file(path, parse_report); }

namespace {

Target target_of(const Report& report, const Points& positions) {
  try {
    Target target = read_target(report.signature, report.cones, positions);
    if (target.space != report.space)
      throw MeshError(fmt::format("the report says that {} is {}, but it is {}", report.signature,
                                  report.space.name(), target.space.name()));
    target.group_order = report.group_order;  // a claim, which `verify` judges
    return target;
  } catch (const ArgumentError& error) {
    throw MeshError(fmt::format("the signature of the report {}", error.what()));
  }
}

}  // namespace

Embedding with_report(Embedding embedding, const Report& report) {
  embedding.placement = report.placement.value_or(Isometry());
  embedding.seams = report.seams;
  embedding.cones = report.cones;
  const int count = static_cast<int>(embedding.source_vertex.size());
  const auto require = [&](const std::vector<int>& vertices) {
    for (const int v : vertices)
      if (v < 0 || v >= count)
        throw MeshError(
            fmt::format("the report names the cut vertex {}, but the embedding has {} vertices", v, count));
  };
  for (const Seam& seam : embedding.seams) {
    require(seam.left);
    require(seam.right);
  }
  for (const ConeCopies& cone : embedding.cones) require(cone.copies);
  embedding.target = target_of(report, embedding.positions);
  return embedding;
}

Embedding read_embedding(const std::string& ply_path, const Report& report) {
  Embedding embedding = read_embedding(ply_path);
  return naming_file(ply_path, [&] { return with_report(std::move(embedding), report); });
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
