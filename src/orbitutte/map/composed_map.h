// SPDX-License-Identifier: MIT
// All that follows from two certified embeddings into one target.
#pragma once

#include "orbitutte/map/map_distortion.h"
#include "orbitutte/map/overlay.h"
#include "orbitutte/map/overlay_certificate.h"
#include "orbitutte/map/surface_map.h"
#include "orbitutte/map/vertex_map.h"

namespace orbitutte {

/// The map between two surfaces, composed of the embedding of one and the inverse of the other's.
struct ComposedMap {
  VertexMap a_to_b, b_to_a;
  Overlay overlay;
  OverlayCertificate certificate;

  /// Where the vertices of the overlay lie on A and on B: k x 3.
  Points overlay_on_a, overlay_on_b;

  /// Of the overlay's triangles.
  MapDistortion distortion;

  /// The largest distance between a landmark's image and its partner, in square roots of B's area.
  double landmark_error = 0;
};

/// `map` is of the surfaces a and b, and takes as many threads as were allowed for its first embedding
/// (EmbedResult::threads; 0: all). Throws MeshError naming a face if an embedding is not certified, and as
/// overlay does.
ComposedMap compose(const Surface& a, const Surface& b, const SurfaceMap& map);

}  // namespace orbitutte
