// SPDX-License-Identifier: MIT
// Two surfaces on one target, and where the vertices of one lie on the other. Private to map/.
#pragma once

#include <functional>
#include <vector>

#include "orbitutte/map/edge_tracer.h"

namespace orbitutte {

/// A vertex of the walker's surface: a half-edge that begins at it, and its place on the other surface, with
/// the element for the frame of that half-edge's triangle.
struct Fix {
  int halfedge = -1;
  Place place;
};

/// A surface that is walked on, and one whose edges are the walks.
class SurfacePair {
 public:
  /// Throws as `overlay` does.
  SurfacePair(const Embedding& walked, const Embedding& walker);
  SurfacePair(const SurfacePair&) = delete;
  SurfacePair& operator=(const SurfacePair&) = delete;

  /// Called with a half-edge of the walker and the walk from its origin to its target.
  using Visit = std::function<void(int halfedge, const Walk&)>;

  /// Walks along every edge once, beginning at a mark, and returns where the vertices lie (n; half-edge -1 if
  /// no triangle uses the vertex). Throws ArgumentError if a mark comes to lie elsewhere than on its
  /// partner.
  std::vector<Fix> trace_edges(const Visit& visit);

  /// The same along the edges of a tree alone.
  std::vector<Fix> locate_vertices();

  /// The coordinates of a site of the walker in the triangle of its place.
  Vector3 coordinates(const Place& place, int site) const;

  const DevelopedSurface& walked() const { return walked_; }
  const DevelopedSurface& walker() const { return walker_; }
  Sites& walker_sites() { return walker_.sites; }
  const ExactSigns& signs() const { return signs_; }
  ElementTable& elements() { return elements_; }
  const EdgeTracer& tracer() const { return tracer_; }

  /// Of every vertex of the walker: the vertex of the other surface that it is to lie on, or -1.
  const std::vector<int>& partners() const { return partner_; }

 private:
  Fix start(const Embedding& walked, const Embedding& walker);
  void require_same_point(int walked_site, int walker_site, int element) const;
  void find_partners(const Embedding& walked, const Embedding& walker);

  ElementTable elements_;
  SharedGroup group_;
  DevelopedSurface walked_, walker_;
  ExactSigns signs_;
  EdgeTracer tracer_;
  std::vector<int> partner_;
  Fix start_;
};

}  // namespace orbitutte
