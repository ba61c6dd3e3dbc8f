// SPDX-License-Identifier: MIT
// What embed computes before it knows the tile, and what a solver keeps from one embedding to the next.
#pragma once

#include <array>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "orbitutte/cut/cut.h"
#include "orbitutte/embed_types.h"
#include "orbitutte/mesh/intrinsic_triangulation.h"
#include "orbitutte/orbifold/signature.h"
#include "orbitutte/solve/laplacian_solver.h"

namespace orbitutte {

/// A surface, and what is known of it before its cones are chosen.
struct PreparedSurface {
  const Surface& surface;
  /// About its polygons, one sentence each.
  std::vector<std::string> warnings;
};

/// The arguments of embed.
struct EmbedRequest {
  const PreparedSurface& prepared;
  const Target& target;
  const std::vector<int>& cones;
  const EmbedOptions& options;
};

/// The weights before they were sharpened at cones: either of the two, or none yet.
struct KnownWeights {
  std::optional<EdgeWeights> weights;
  /// What they are made from, if they are of kind `delaunay`, and its edges, which stay when it is taken.
  std::optional<IntrinsicTriangulation> triangulation;
  std::vector<std::array<int, 2>> edges;
  /// What was asked for then.
  WeightKind kind = WeightKind::standard;
};

/// The last cut.
struct KnownCut {
  /// What `cut` was made for.
  struct Request {
    std::vector<int> marks;
    int inner_marks = 0;
    bool is_tree = false;

    bool operator==(const Request& other) const = default;
  };

  /// Empty if no cut was completed.
  std::optional<Request> request;
  CutMesh cut;
};

/// What one embedding of a surface leaves behind for the next one. Each stage knows only its own part, and
/// results do not depend on it.
struct EmbeddingCache {
  explicit EmbeddingCache(Kept kept)
      : serves_again(kept == Kept::factors), laplacians(reusable_laplacians(kept)) {}

  /// Are the weights asked for once more? If not, they become those that are sharpened.
  bool serves_again;
  KnownWeights weights;
  KnownCut cut;
  std::shared_ptr<LaplacianReuse> laplacians;
};

/// Looks for what users of the surface should be warned about. Throws ArgumentError if the options ask for
/// weights that its polygons do not have. The surface must outlive the result.
PreparedSurface prepare(const Surface& surface, const EmbedOptions& options);

/// Throws MeshError if the surface does not have the topology that the target needs, if the number of marked
/// vertices is not the number of the target's marks, or if an edge joins two vertices that must lie at
/// opposite points. Throws ArgumentError if no surface has the angles of a free tile.
void require_fit(const EmbedRequest& request);

/// Throws MeshError unless the surface has the topology that the target needs. The message about a hole
/// names it and both remedies.
void require_topology(const Surface& surface, const Target& target);

/// Throws ArgumentError if the options ask for what means nothing unless a quotient is wanted. `onto` is what
/// the map is onto, for the message.
void require_no_quotient_options(const QuotientOptions& options, const std::string& onto);

/// The weights (section 4), those of a metric that is flat at the cones.
EdgeWeights find_weights(const EmbedRequest& request, EmbeddingCache& cache);

/// Cuts the surface through its marked vertices (section 4.1). At the same time finds an elimination order
/// for the Laplacian from the edges of the weights that are not sharpened at cones: so it is the same for all
/// cones.
void find_cut(const EmbedRequest& request, EmbeddingCache& cache);

}  // namespace orbitutte
