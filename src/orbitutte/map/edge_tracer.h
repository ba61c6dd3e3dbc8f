// SPDX-License-Identifier: MIT
// Walks along geodesics through the triangles of a surface, by exact signs. Private to map/.
#pragma once

#include <vector>

#include "orbitutte/map/developed_surface.h"

namespace orbitutte {

/// A point of the walked surface: inside a triangle (that of the half-edge), on the half-edge between its
/// ends, or at the vertex where it begins; and the element that takes the walker's frame to the triangle's.
struct Place {
  enum class Kind { inside, on_edge, at_vertex };
  Kind kind = Kind::inside;
  int halfedge = -1;
  int element = ElementTable::identity;

  int triangle() const { return halfedge / 3; }
};

/// What lies between two stops of a walk: a piece inside a triangle, or along an edge.
struct WalkedPiece {
  /// A half-edge of the triangle that the piece is in, and the element that takes the walker's frame there.
  int halfedge = -1;
  int element = ElementTable::identity;

  /// Does it run along the half-edge? Then in its direction or in the other.
  enum class Along { none, forward, backward };
  Along along = Along::none;
};

/// A walk from one place to another. The stops between are crossings (on the half-edge of the triangle that
/// is left) and vertices; there is one more of them than pieces.
struct Walk {
  std::vector<Place> stops;
  std::vector<WalkedPiece> pieces;

  void clear() { stops.clear(), pieces.clear(); }
  void reverse();
};

/// Two sites of the walker's, in one frame.
struct Course {
  int from = 0, to = 0;
};

class EdgeTracer {
 public:
  /// Refers to all of them. walkers: the sites that courses name.
  EdgeTracer(const DevelopedSurface& surface, const Sites& walkers, const ExactSigns& signs,
             ElementTable& elements)
      : surface_(surface), walkers_(walkers), signs_(signs), elements_(elements) {}

  /// The walk along the geodesic of a course, which begins at `start`. If that is at a vertex, it is moved to
  /// the corner of the triangle that the walk enters. Throws ArgumentError if the walk leaves the surface, or
  /// does not end.
  void trace(const Course& course, Place& start, Walk& walk) const;

  /// Turns a place at a vertex counterclockwise to the corner of the triangle that the course would enter, as
  /// `trace` does; places elsewhere stay.
  void turn(const Course& course, Place& start) const;

  /// The same to the nearest such corner, in either sense.
  void turn_least(const Course& course, Place& start) const;

  /// The same place in the triangle beyond the half-edge that it is on or begins at.
  Place beyond(const Place& place) const;

  /// Where a site lies if the triangle holds it, the walker's frame being the triangle's but for an element.
  bool holds(int triangle, int element, int site, Place& place) const;

 private:
  struct Line {
    PlacedPoint from, to;
  };

  struct Step {
    WalkedPiece piece;
    Place stop;
    bool has_arrived = false;
  };

  Line line_of(const Course& course, int element) const;
  PlacedPoint corner(int h) const { return signs_.placed(surface_.sites, surface_.site_of(h)); }
  int side(int h, const PlacedPoint& point) const;

  Step next(const Course& course, Place& here) const;
  Step from_inside(const Line& line, const Place& here) const;
  Step from_edge(const Course& course, const Place& here) const;
  Step from_vertex(const Course& course, Place& here) const;
  bool turn_back(Place& here) const;
  bool turn_on(Place& here) const;
  Step into_sector(const Line& line, const Place& here) const;
  Step across(const Line& line, const Place& entry) const;
  Step along(const Line& line, const Place& here, WalkedPiece::Along direction) const;
  Step out_through_edge(const Line& line, const Place& exit) const;
  Step out_through_corner(const Line& line, const Place& corner) const;

  const DevelopedSurface& surface_;
  const Sites& walkers_;
  const ExactSigns& signs_;
  ElementTable& elements_;
};

}  // namespace orbitutte
