// SPDX-License-Identifier: MIT
// What Python's Embedding holds: an embedding, and everything that is known of it.
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "bindings.h"
#include "orbitutte/choose.h"
#include "orbitutte/report/report.h"
#include "source_mesh.h"

namespace orbitutte::python {

struct HeldEmbedding {
  Embedding embedding;
  /// JSON, as in the file.
  std::string report;
  /// Null if the embedding was loaded without its mesh.
  std::shared_ptr<const SourceMesh> mesh;
  /// Nothing if the embedding was loaded; the weights can be computed again.
  std::optional<EdgeWeights> weights;

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
