// SPDX-License-Identifier: MIT
// What embed computes before it knows the tile, and what a solver keeps from one embedding to the next.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "orbitutte/cut/cut.h"
#include "orbitutte/embed_types.h"
#include "orbitutte/orbifold/signature.h"
#include "orbitutte/solve/laplacian_solver.h"

namespace orbitutte {

/// A surface, and what is known of it before its cones are.
struct PreparedSurface {
  const Surface& surface;
  /// About its polygons, one sentence each.
  std::vector<std::string> warnings;
};

/// What embed is asked for.
struct EmbedRequest {
  const PreparedSurface& prepared;
  const Target& target;
  const std::vector<int>& cones;
  const EmbedOptions& options;
};

/// The weights before they were sharpened at cones.
struct KnownWeights {
  std::optional<EdgeWeights> weights;
  /// What was asked for then.
  WeightKind kind = WeightKind::standard;
};

/// The last cut.
struct KnownCut {
  /// The marked vertices of `cut`, and how many lie inside; none if no cut was completed.
  std::optional<std::pair<std::vector<int>, int>> through;
  CutMesh cut;
};

/// What one embedding of a surface leaves behind for the next; each stage knows its own part alone. Results
/// do not depend on it.
struct EmbeddingCache {
  explicit EmbeddingCache(Kept kept) : laplacians(reusable_laplacians(kept)) {}

  KnownWeights weights;
  KnownCut cut;
  std::shared_ptr<LaplacianReuse> laplacians;
};

/// Looks for what the user of the surface should be warned of. Throws ArgumentError if the options ask
/// for weights that its polygons do not have. The surface must outlive the result.
PreparedSurface prepare(const Surface& surface, const EmbedOptions& options);

/// Throws MeshError if the surface has not the topology that the orbifold needs, if there are not as many
/// marked vertices as it has marks, or if an edge joins two that have to lie at opposite points.
void require_fit(const EmbedRequest& request);

/// Throws MeshError unless the surface has the topology that the orbifold needs. The message about a hole
/// names it and both remedies.
void require_topology(const Surface& surface, const Target& target);

/// The weights (section 4), those of a metric that is flat at the cones.
EdgeWeights find_weights(const EmbedRequest& request, KnownWeights& known);

/// Cuts the surface through its marked vertices (section 4.1), and finds the elimination order of its
/// Laplacian, whose edges have the weights, at the same time.
void find_cut(const EmbedRequest& request, const EdgeWeights& weights, EmbeddingCache& cache);

}  // namespace orbitutte
