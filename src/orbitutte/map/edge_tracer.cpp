// SPDX-License-Identifier: MIT
#include "orbitutte/map/edge_tracer.h"

#include <algorithm>
#include <array>

#include "orbitutte/mesh/connectivity.h"

namespace orbitutte {
namespace {

using Kind = Place::Kind;
using Along = WalkedPiece::Along;

// The stop at the far end of a piece, from the side of it on which the goal lies: past it, at it, or before.
// `before` is where the goal is then.
Place reached(int side, const Place& end, const Place& before) { return side > 0 ? before : end; }

}  // namespace

void Walk::reverse() {
  std::reverse(stops.begin(), stops.end());
  std::reverse(pieces.begin(), pieces.end());
  for (WalkedPiece& piece : pieces) {
    if (piece.along == Along::none) continue;
    piece.along = piece.along == Along::forward ? Along::backward : Along::forward;
  }
}

EdgeTracer::Line EdgeTracer::line_of(const Course& course, int element) const {
  return {signs_.placed(walkers_, course.from, element), signs_.placed(walkers_, course.to, element)};
}

// Is the point on the left of a half-edge (1), on its line (0) or on the right (-1)?
int EdgeTracer::side(int h, const PlacedPoint& point) const {
  return signs_.orientation(corner(h), corner(next_halfedge(h)), point);
}

Place EdgeTracer::beyond(const Place& place) const {
  const int h = place.halfedge, o = surface_.opposite[h];
  if (o < 0) throw ArgumentError("the surfaces do not cover the same part of the target");
  const int element = elements_.product(elements_.inverse(surface_.beyond[h]), place.element);
  return {place.kind, place.kind == Kind::at_vertex ? next_halfedge(o) : o, element};
}

bool EdgeTracer::holds(int triangle, int element, int site, Place& place) const {
  const PlacedPoint point = signs_.placed(walkers_, site, element);
  std::array<int, 3> on;
  for (int k = 0; k < 3; ++k)
    if ((on[k] = side(3 * triangle + k, point)) < 0) return false;
  const int h = 3 * triangle;
  place = {Kind::inside, h, element};
  for (int k = 0; k < 3; ++k)
    if (on[k] == 0 && on[(k + 1) % 3] != 0 && on[(k + 2) % 3] != 0) place = {Kind::on_edge, h + k, element};
  for (int k = 0; k < 3; ++k)
    if (on[k] == 0 && on[(k + 2) % 3] == 0) place = {Kind::at_vertex, h + k, element};
  return true;
}

void EdgeTracer::trace(const Course& course, Place& start, Walk& walk) const {
  walk.clear();
  const std::size_t most_pieces = 1000 + 20 * static_cast<std::size_t>(surface_.edge_count());
  Place here = start;
  while (true) {
    const bool is_first = walk.pieces.empty();
    Step step;
    if (!is_first && here.kind == Kind::on_edge) {
      const Place entry = beyond(here);
      step = across(line_of(course, entry.element), entry);
    } else {
      step = next(course, here);
    }
    if (is_first) {
      start = here;
      walk.stops.push_back(here);
    }
    walk.pieces.push_back(step.piece);
    walk.stops.push_back(step.stop);
    if (step.has_arrived) return;
    if (walk.pieces.size() > most_pieces)
      throw ArgumentError("an edge of one surface does not end on the other; certify both embeddings first");
    here = step.stop;
  }
}

EdgeTracer::Step EdgeTracer::next(const Course& course, Place& here) const {
  if (here.kind == Kind::at_vertex) return from_vertex(course, here);
  if (here.kind == Kind::on_edge) return from_edge(course, here);
  return from_inside(line_of(course, here.element), here);
}

// The walk leaves through the edge that it has its origin on the right of and its target on the left, or
// through the corner between two such edges.
EdgeTracer::Step EdgeTracer::from_inside(const Line& line, const Place& here) const {
  const int first = 3 * here.triangle();
  std::array<int, 3> side_of;
  for (int k = 0; k < 3; ++k) side_of[k] = signs_.orientation(line.from, line.to, corner(first + k));
  for (int k = 0; k < 3; ++k) {
    const int after = side_of[(k + 1) % 3], before = side_of[(k + 2) % 3];
    if (side_of[k] < 0 && after > 0) return out_through_edge(line, {Kind::on_edge, first + k, here.element});
    if (side_of[k] == 0 && before < 0 && after > 0)
      return out_through_corner(line, {Kind::at_vertex, first + k, here.element});
  }
  throw ArgumentError("a walk begins outside of its triangle; certify both embeddings first");
}

EdgeTracer::Step EdgeTracer::out_through_edge(const Line& line, const Place& exit) const {
  const int beyond_it = side(exit.halfedge, line.to);
  const Place inside = {Kind::inside, 3 * exit.triangle(), exit.element};
  return {{exit.halfedge, exit.element, Along::none}, reached(beyond_it, exit, inside), beyond_it >= 0};
}

EdgeTracer::Step EdgeTracer::out_through_corner(const Line& line, const Place& at) const {
  return out_through_edge(line, at);  // beyond the corner is beyond the line of the edge that begins there
}

// Entered through the half-edge of the place, between its ends.
EdgeTracer::Step EdgeTracer::across(const Line& line, const Place& entry) const {
  const int apex = previous_halfedge(entry.halfedge);
  const int side_of_apex = signs_.orientation(line.from, line.to, corner(apex));
  if (side_of_apex == 0) return out_through_corner(line, {Kind::at_vertex, apex, entry.element});
  const int exit = side_of_apex > 0 ? next_halfedge(entry.halfedge) : apex;
  return out_through_edge(line, {Kind::on_edge, exit, entry.element});
}

EdgeTracer::Step EdgeTracer::from_edge(const Course& course, const Place& here) const {
  const Line line = line_of(course, here.element);
  const int side_of_goal = side(here.halfedge, line.to);
  if (side_of_goal > 0) return across(line, here);
  if (side_of_goal < 0) {
    const Place entry = beyond(here);
    return across(line_of(course, entry.element), entry);
  }
  const int apex = previous_halfedge(here.halfedge);
  const bool is_forward = signs_.orientation(corner(apex), line.from, line.to) > 0;
  return along(line, here, is_forward ? Along::forward : Along::backward);
}

// Along the half-edge of the place, whose ends are cut off by the other two sides of the triangle.
EdgeTracer::Step EdgeTracer::along(const Line& line, const Place& here, Along direction) const {
  const int h = here.halfedge, end = direction == Along::forward ? next_halfedge(h) : h,
            across_end = direction == Along::forward ? end : previous_halfedge(h);
  const int side_of_goal = side(across_end, line.to);
  const Place on_it = {Kind::on_edge, h, here.element}, at_end = {Kind::at_vertex, end, here.element};
  return {{h, here.element, direction}, reached(side_of_goal, at_end, on_it), side_of_goal >= 0};
}

// Counterclockwise to the next corner at the vertex; false if there is a boundary.
bool EdgeTracer::turn_on(Place& here) const {
  const int back = previous_halfedge(here.halfedge);
  if (surface_.opposite[back] < 0) return false;
  const Place next_one = beyond({Kind::on_edge, back, here.element});
  here = {Kind::at_vertex, next_one.halfedge, next_one.element};
  return true;
}

// The other way.
bool EdgeTracer::turn_back(Place& here) const {
  if (surface_.opposite[here.halfedge] < 0) return false;
  here = beyond(here);
  return true;
}

// Turns around the vertex until the goal is in the angle of the triangle: counterclockwise, and, on a
// boundary, the other way then. The angles of a cone of an orbifold may have to be passed several times.
EdgeTracer::Step EdgeTracer::from_vertex(const Course& course, Place& here) const {
  const int most_corners = 3 * static_cast<int>(surface_.triangles.size());
  Place at = here;
  bool is_clockwise = false;
  for (int turned = 0; turned < most_corners; ++turned) {
    const Step step = into_sector(line_of(course, at.element), at);
    if (step.stop.halfedge >= 0) {
      here = at;
      return step;
    }
    if (!is_clockwise && !turn_on(at)) {
      is_clockwise = true;
      at = here;
    }
    if (is_clockwise && !turn_back(at)) break;
  }
  throw ArgumentError("no triangle around a vertex goes on to another one; certify both embeddings first");
}

void EdgeTracer::turn(const Course& course, Place& start) const {
  if (start.kind == Kind::at_vertex) from_vertex(course, start);
}

void EdgeTracer::turn_least(const Course& course, Place& start) const {
  if (start.kind != Kind::at_vertex) return;
  Place on = start, back = start;
  const int most_corners = 3 * static_cast<int>(surface_.triangles.size());
  bool goes_on = true, goes_back = true;
  for (int turned = 0; turned < most_corners && (goes_on || goes_back); ++turned) {
    if (goes_on && into_sector(line_of(course, on.element), on).stop.halfedge >= 0) {
      start = on;
      return;
    }
    if (goes_back && into_sector(line_of(course, back.element), back).stop.halfedge >= 0) {
      start = back;
      return;
    }
    goes_on = goes_on && turn_on(on);
    goes_back = goes_back && turn_back(back);
  }
}

// No stop (-1) if the goal is not in the angle at the corner.
EdgeTracer::Step EdgeTracer::into_sector(const Line& line, const Place& here) const {
  const int h = here.halfedge, last = previous_halfedge(h);
  const PlacedPoint vertex = corner(h);
  const int from_first = signs_.orientation(vertex, corner(next_halfedge(h)), line.to);
  if (from_first < 0) return {};
  const int from_last = signs_.orientation(vertex, line.to, corner(last));
  if (from_last < 0 || (from_first == 0 && from_last == 0)) return {};
  if (from_first == 0) return along(line, here, Along::forward);
  if (from_last == 0) return along(line, {Kind::on_edge, last, here.element}, Along::backward);
  return out_through_edge(line, {Kind::on_edge, next_halfedge(h), here.element});
}

}  // namespace orbitutte
