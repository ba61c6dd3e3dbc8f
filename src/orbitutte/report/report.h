// SPDX-License-Identifier: MIT
// The report: everything about an embedding except its positions, as JSON (docs/file-formats.md).
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "orbitutte/embed_types.h"
#include "orbitutte/inspect/mesh_repair.h"
#include "orbitutte/verify/strain.h"

namespace orbitutte {

/// What the result of a run does not hold.
struct RunRecord {
  std::string mesh_path;
  /// Hexadecimal.
  std::string input_sha256;
  double read_seconds = 0;
  /// How long make_surface took, if it ran before embed.
  double validate_seconds = 0;
  double write_seconds = 0;
  double total_seconds = 0;
  long long peak_memory_bytes = 0;

  /// How the map deforms the surface around its vertices, as strain_statistics has it; or none.
  std::vector<StrainStatistics> strain = {};

  /// If the mesh was repaired before it was embedded.
  std::optional<RepairSummary> repair = {};
};

/// The report of an embedding, schema orbitutte.report/1; ends with a line break.
std::string report_json(const EmbedResult& result, const RunRecord& run);

/// The key `distortion` of a report, as JSON.
std::string distortion_json(const Distortion& distortion);

/// The key `strain` in it: for each StrainMeasure `mean`, `mean_absolute` and `percentiles`.
std::string strain_json(const std::vector<StrainStatistics>& strain);

/// The same report with the key `strain` in its `distortion`, as if RunRecord::strain had been known at
/// first.
std::string with_strain(std::string_view report, const std::vector<StrainStatistics>& strain);

/// What a report says that can be checked against the files that it speaks of.
struct Report {
  std::string signature;

  /// 0 if the group is infinite.
  int group_order = 0;
  Space space;

  /// None in reports that do not say.
  std::optional<Isometry> placement;
  std::vector<Seam> seams;
  std::vector<ConeCopies> cones;
  WeightOptions weights;
  /// Triangles none of whose edges was flipped.
  std::vector<int> kept_faces;

  /// Input vertices.
  std::vector<int> moved_vertices;

  /// Was the mesh repaired in place before it was embedded?
  bool is_repaired = false;

  /// If the map is a quotient.
  std::optional<QuotientRecord> quotient;
  double energy = 0;
  std::vector<Iteration> history;
  bool converged = false;
  bool bijective = false;
  double expected_area = 0;
  /// What the report says of the triangulation that has the weights, if it says anything.
  std::optional<bool> intrinsic_bijective;
  std::vector<int> nonpositive_faces;
};

/// What the text of a report says. Throws MeshError naming the key that is missing or of the wrong type.
Report parse_report(std::string_view text);

/// Reads a file as parse_report does. Error messages begin with the path. Throws FileError, and MeshError
/// naming the key that is missing or of the wrong type.
Report read_report(const std::string& path);

/// The embedding with signature, group order, seams and cones from the report. Throws MeshError if a vertex
/// of the report is not in the embedding.
Embedding with_report(Embedding embedding, const Report& report);

/// An embedding from its two files. Throws as read_embedding and read_report do, and MeshError if a vertex
/// of the report is not in the embedding.
Embedding read_embedding(const std::string& ply_path, const Report& report);

/// The SHA-256 digest of bytes, hexadecimal.
std::string sha256(std::string_view bytes);

}  // namespace orbitutte
