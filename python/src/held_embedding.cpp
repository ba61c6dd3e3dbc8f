// SPDX-License-Identifier: MIT
#include "held_embedding.h"

#include <fmt/format.h>
#include <sys/resource.h>

#include "orbitutte/report/choices.h"
#include "orbitutte/report/verification.h"

namespace orbitutte::python {
namespace {

long long peak_memory_bytes() {
  rusage usage = {};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<long long>(usage.ru_maxrss) * 1024;
}

}  // namespace

const SourceMesh& HeldEmbedding::source(const char* purpose) const {
  if (mesh) return *mesh;
  throw ArgumentError(fmt::format(
      "{} needs the mesh that was embedded; load the embedding with it, or give V and F", purpose));
}

const std::string& HeldEmbedding::report() const {
  return held_report->complete(
      [&] { return strain_statistics(measure_strain(*mesh->surface(), embedding).at_vertices); });
}

EdgeWeights HeldEmbedding::edge_weights() const {
  if (weights) return *weights;
  const SourceMesh& known = source("the computation of weights");
  const Report claims = parse_report(brief_report());
  if (claims.weights.kind == WeightKind::file)
    throw ArgumentError("the weights were given by the caller, and files of embeddings do not hold them");
  return weights_of(*known.surface(), embedding, claims);
}

HeldEmbedding hold(EmbedResult result, std::shared_ptr<const SourceMesh> mesh, double total_seconds) {
  return hold(BestEmbedding{Objective::sigma, {}, 0, std::move(result)}, std::move(mesh), total_seconds);
}

HeldEmbedding hold(BestEmbedding best, std::shared_ptr<const SourceMesh> mesh, double total_seconds) {
  RunRecord run;
  run.total_seconds = total_seconds;
  run.peak_memory_bytes = peak_memory_bytes();
  if (mesh) run.repair = mesh->repair();
  auto report = std::make_shared<HeldReport>(
      report_json(best, run), mesh ? HeldReport::Strain::missing : HeldReport::Strain::included);
  EmbedResult& result = best.result;
  return {std::move(result.embedding), std::move(report), std::move(mesh), std::move(result.weights)};
}

}  // namespace orbitutte::python
