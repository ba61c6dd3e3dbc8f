// SPDX-License-Identifier: MIT
// An embedding with everything that is known of it: what Python's Embedding holds.
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "orbitutte/embed_types.h"
#include "orbitutte/report/report.h"
#include "source_mesh.h"

namespace orbitutte::python {

struct HeldEmbedding {
  Embedding embedding;
  /// JSON, as in the file.
  std::string report;
  /// Null where an embedding was loaded without it.
  std::shared_ptr<const SourceMesh> mesh;
  /// Null where it was loaded: they can be computed again.
  std::optional<EdgeWeights> weights;

  /// Throws ArgumentError, saying what `purpose` it is missing for.
  const SourceMesh& source(const char* purpose) const;

  /// The weights that the embedding has, and the edges that they belong to. Throws ArgumentError.
  EdgeWeights edge_weights() const;
};

/// Everything that is to be kept of a result.
HeldEmbedding hold(EmbedResult result, std::shared_ptr<const SourceMesh> mesh, double total_seconds);

}  // namespace orbitutte::python
