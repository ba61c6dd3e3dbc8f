// SPDX-License-Identifier: MIT
// The faces of an embedding, each on positions of its own, and the frames in which its neighbours go on.
// Private to verify/.
#pragma once

#include <functional>
#include <map>
#include <optional>
#include <unordered_map>
#include <vector>

#include "orbitutte/mesh/surface.h"
#include "orbitutte/orbifold/embedding.h"
#include "orbitutte/verify/exact_group.h"

namespace orbitutte {

/// Faces whose corners have positions of their own; across some half-edges the map goes on in another frame.
class CornerLayout {
 public:
  /// A position with offsets, and how many.
  struct ExactPosition {
    Vector3Of<MostPrecise> position;
    int offsets = 0;
  };

  /// The vertex of the surface and its image.
  struct Corner {
    int vertex = -1;
    Vector3 position = Vector3::Zero();
    std::optional<ExactPosition> exact;
  };

  /// `embedding` is of the surface, and its seams fit (see certify). Throws ArgumentError if it has offsets
  /// and a transform is no element of the target's group (exact_group).
  CornerLayout(const Surface& surface, const Embedding& embedding);

  /// The corner at which half-edge h begins, in the frame of its face.
  Corner corner(int h) const;

  /// The half-edge on the other side, or -1 on the boundary.
  int opposite(int h) const { return opposite_[h]; }

  /// Takes the face beyond half-edge h to where the face of h goes on.
  Isometry beyond(int h) const;
  Corner moved(const Isometry& into, Corner corner) const;

  /// Replaces the edge of h, between (a, b, k) and (a, b, l), by the one from l to k.
  void flip(int h);

  /// Which vertices the faces have now.
  const Triangles& triangles() const { return F_; }

 private:
  struct Side {
    int opposite;
    Isometry beyond;
  };

  void take_offsets(const Embedding& embedding, const std::vector<int>& copy);
  void set_corner(int h, const Corner& corner);
  void set_beyond(int h, const Isometry& transform);

  Triangles F_;
  std::vector<int> opposite_;

  /// Of the corner where each half-edge begins.
  Points positions_;

  /// Only if there are offsets.
  std::optional<PreciseGroup<MostPrecise>> group_;

  /// Of corners that have offsets.
  std::map<int, ExactPosition> exact_;
  std::unordered_map<int, Isometry> beyond_;
};

/// An embedding of so many triangles into the target of another one. Triangle f has the corners 3 f, 3 f + 1,
/// 3 f + 2, which nothing else shares; corner_at is asked for them in this order.
Embedding embedding_of_corners(const Embedding& like, int triangles,
                               const std::function<CornerLayout::Corner(int)>& corner_at);

}  // namespace orbitutte
