// SPDX-License-Identifier: MIT
// What Python's Embedding holds: an embedding, and everything that is known of it.
#pragma once

#include <memory>
#include <mutex>
#include <optional>
#include <string>

#include "bindings.h"
#include "orbitutte/choose.h"
#include "orbitutte/report/report.h"
#include "source_mesh.h"

namespace orbitutte::python {

/// A report, to which what it says of strain is added when it is first asked for: on small meshes it takes a
/// tenth as long as the embedding.
class HeldReport {
 public:
  enum class Strain { included, missing };

  HeldReport(std::string text, Strain strain) : brief_(std::move(text)), strain_(strain) {}

  /// JSON, as in the file. measure() returns the strain if it is missing.
  template <typename Measure>
  const std::string& complete(const Measure& measure) {
    if (strain_ == Strain::included) return brief_;
    std::call_once(is_complete_, [&] { complete_ = with_strain(brief_, measure()); });
    return complete_;
  }

  /// JSON; its strain may be missing.
  const std::string& brief() const { return brief_; }

 private:
  const std::string brief_;
  const Strain strain_;
  std::once_flag is_complete_;
  std::string complete_;
};

struct HeldEmbedding {
  Embedding embedding;
  /// Shared by copies that know another mesh.
  std::shared_ptr<HeldReport> held_report;
  /// Null if the embedding was loaded without its mesh.
  std::shared_ptr<const SourceMesh> mesh;
  /// Nothing if the embedding was loaded; the weights can be computed again.
  std::optional<EdgeWeights> weights;

  /// JSON, as in the file.
  const std::string& report() const;

  /// JSON; its strain may be missing.
  const std::string& brief_report() const { return held_report->brief(); }

  /// The mesh. Throws ArgumentError saying that `purpose` needs it.
  const SourceMesh& source(const char* purpose) const;

  /// The weights that the embedding has, and the edges that they belong to. Throws ArgumentError.
  EdgeWeights edge_weights() const;
};

/// Keeps everything of a result that Python may ask for.
HeldEmbedding hold(EmbedResult result, std::shared_ptr<const SourceMesh> mesh, double total_seconds);

/// With what was chosen.
HeldEmbedding hold(BestEmbedding best, std::shared_ptr<const SourceMesh> mesh, double total_seconds);

/// As in the report.
py::dict to_dict(const Distortion& measured);

}  // namespace orbitutte::python
