// SPDX-License-Identifier: MIT
// A face of the overlay is where a triangle of A meets one of B: both are convex, and so is the face. Its
// boundary goes on, wherever it meets the boundaries of both, along the one that turns further to the left.
// So the edges of B, walked through A, and their order along the edges of A are all there is to find out.
#include "orbitutte/map/overlay.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "orbitutte/map/divided_ears.h"
#include "orbitutte/map/joined_overlay.h"
#include "orbitutte/map/surface_pair.h"
#include "orbitutte/mesh/connectivity.h"

namespace orbitutte {
namespace {

using Kind = Place::Kind;
using Along = WalkedPiece::Along;

constexpr int none = -1;

// Half-edge 2 e or 2 e + 1 of edge e of the overlay, in the other direction.
int twin_of(int g) { return g ^ 1; }

[[noreturn]] void refuse_overlay() {
  throw ArgumentError(
      "the edges of both surfaces do not divide the target into one and the same mesh; certify both "
      "embeddings first");
}

// Edges of B as they were walked: all stops and pieces, one edge after the other.
struct WalkedEdges {
  std::vector<int> halfedge;
  std::vector<int> first_stop = {0};
  std::vector<Place> stops;
  std::vector<WalkedPiece> pieces;  // those of edge i begin at first_stop[i] - i

  int count() const { return static_cast<int>(halfedge.size()); }
  int stop_count(int i) const { return first_stop[i + 1] - first_stop[i]; }
  const WalkedPiece& piece(int i, int k) const { return pieces[first_stop[i] - i + k]; }

  void add(int h, const Walk& walk) {
    halfedge.push_back(h);
    stops.insert(stops.end(), walk.stops.begin(), walk.stops.end());
    pieces.insert(pieces.end(), walk.pieces.begin(), walk.pieces.end());
    first_stop.push_back(static_cast<int>(stops.size()));
  }
};

// A vertex of the overlay between the ends of an edge of A. `element` takes B to where the triangle of the
// edge's reference half-edge is.
struct EdgeStop {
  int edge = none;
  int vertex = none;           // of the overlay
  int from = none, to = none;  // sites of B's edge; only the first if it is a vertex of B
  int element = ElementTable::identity;
  ExactSigns::Share share;
};

// What lies on the left of a half-edge of the overlay, and what it lies on.
struct OverlayHalfedge {
  int target = none;                     // vertex of the overlay
  int on_a = none, on_b = none;          // half-edges of A and B in its direction
  int left_a = none, left_b = none;      // triangles
  int element = ElementTable::identity;  // takes the triangle of B there
  bool is_traced = false;
};

class OverlayBuilder {
 public:
  OverlayBuilder(const Embedding& a, const Embedding& b)
      : pair_(a, b), a_(pair_.walked()), b_(pair_.walker()) {}

  Overlay run() {
    fixes_ = pair_.trace_edges([&](int h, const Walk& walk) { walked_.add(h, walk); });
    number_vertices();
    lay_edges_of_b();
    order_stops_of_a();
    lay_edges_of_a();
    trace_faces();
    locate_vertices();
    return std::move(result_);
  }

 private:
  // -- Vertices --

  int add_vertex(const OverlayVertex& vertex) {
    result_.vertices.push_back(vertex);
    share_on_b_.push_back(0);
    meeting_.emplace_back();
    return result_.vertex_count() - 1;
  }

  // Those of A, then those of B that lie on none of A.
  void number_vertices() {
    id_of_a_.assign(a_.vertex_count(), none);
    id_of_b_.assign(b_.vertex_count(), none);
    for (int v = 0; v < a_.vertex_count(); ++v)
      if (a_.first_halfedge[v] >= 0) id_of_a_[v] = add_vertex({v, none, none, none});
    for (int v = 0; v < b_.vertex_count(); ++v) {
      const Fix& fix = fixes_[v];
      if (fix.halfedge < 0) continue;
      const Place& place = fix.place;
      if (place.kind == Kind::at_vertex) {
        id_of_b_[v] = id_of_a_[a_.vertex_of(place.halfedge)];
        int& of_b = result_.vertices[id_of_b_[v]].b_vertex;
        if (of_b != none) refuse_overlay();
        of_b = v;
        continue;
      }
      id_of_b_[v] = add_vertex({none, v, none, none});
      if (place.kind != Kind::on_edge) continue;
      result_.vertices[id_of_b_[v]].a_halfedge = place.halfedge;
      add_stop({a_.edge[place.halfedge], id_of_b_[v], b_.site_of(fix.halfedge), none, place.element, {}},
               place.halfedge);
    }
  }

  // `halfedge`: where the element of the stop takes B.
  void add_stop(EdgeStop stop, int halfedge) {
    if (a_.reference[stop.edge] != halfedge)
      stop.element = pair_.tracer().beyond({Kind::on_edge, halfedge, stop.element}).element;
    stops_.push_back(stop);
  }

  // -- Edges --

  int add_edge(int origin, int target) {
    const int g = static_cast<int>(halfedges_.size());
    halfedges_.emplace_back();
    halfedges_.emplace_back();
    halfedges_[g].target = target;
    halfedges_[twin_of(g)].target = origin;
    return g;
  }

  void set_left(int g, int a, int b, int element) {
    halfedges_[g].left_a = a;
    halfedges_[g].left_b = b;
    halfedges_[g].element = element;
  }

  void lay_edges_of_b() {
    first_of_b_.resize(b_.edge_count());
    pieces_of_b_.resize(b_.edge_count());
    walked_halfedge_.resize(b_.edge_count());
    halfedges_.reserve(2 * walked_.pieces.size());
    for (int i = 0; i < walked_.count(); ++i) {
      const int h = walked_.halfedge[i], stops = walked_.stop_count(i);
      const int e = b_.edge[h];
      walked_halfedge_[e] = h;
      first_of_b_[e] = static_cast<int>(halfedges_.size());
      pieces_of_b_[e] = stops - 1;
      int origin = id_of_b_[b_.vertex_of(h)];
      for (int k = 1; k < stops; ++k) {
        const bool is_end = k == stops - 1;
        const int target = is_end ? id_of_b_[b_.vertex_of(next_halfedge(h))] : vertex_at_stop(i, k);
        const int g = add_edge(origin, target);
        lay_piece(h, walked_.piece(i, k - 1), g);
        origin = target;
      }
    }
  }

  // A crossing, or a vertex of A that lies on an edge of B.
  int vertex_at_stop(int i, int k) {
    const Place& stop = walked_.stops[walked_.first_stop[i] + k];
    const int h = walked_.halfedge[i];
    if (stop.kind == Kind::at_vertex) {
      const int id = id_of_a_[a_.vertex_of(stop.halfedge)];
      OverlayVertex& vertex = result_.vertices[id];
      if (vertex.b_vertex != none || vertex.b_halfedge != none) refuse_overlay();
      vertex.b_halfedge = h;
      meeting_[id] = {stop.halfedge, h, stop.element};
      return id;
    }
    const int id = add_vertex({none, none, stop.halfedge, h});
    share_on_b_[id] =
        pair_.signs()
            .share({of_b(b_.site_of(h), stop.element), of_b(b_.site_of(next_halfedge(h)), stop.element)},
                   {of_a(stop.halfedge), of_a(next_halfedge(stop.halfedge))})
            .value;
    add_stop({a_.edge[stop.halfedge], id, b_.site_of(h), b_.site_of(next_halfedge(h)), stop.element, {}},
             stop.halfedge);
    return id;
  }

  // The piece's half-edge g of the overlay runs in the direction of half-edge h of B.
  void lay_piece(int h, const WalkedPiece& piece, int g) {
    const int back = twin_of(g), o = b_.opposite[h], t = piece.halfedge / 3;
    halfedges_[g].on_b = h;
    halfedges_[back].on_b = o;
    const int triangle = h / 3, behind = o < 0 ? none : o / 3,
              element_behind = pair_.elements().product(piece.element, b_.beyond[h]);
    if (piece.along == Along::none) {
      if (o < 0) refuse_overlay();
      set_left(g, t, triangle, piece.element);
      set_left(back, t, behind, element_behind);
      return;
    }
    const bool is_forward = piece.along == Along::forward;
    const int on = is_forward ? g : back;  // runs in the direction of A's half-edge, has its triangle left
    const int across = a_.opposite[piece.halfedge];
    set_left(on, t, is_forward ? triangle : behind, is_forward ? piece.element : element_behind);
    halfedges_[on].on_a = piece.halfedge;
    halfedges_[twin_of(on)].on_a = across;
    if (halfedges_[on].left_b < 0) refuse_overlay();
    const int other_b = is_forward ? behind : triangle;
    if ((across < 0) != (other_b < 0)) refuse_overlay();
    if (across < 0) return;
    const int out = pair_.elements().inverse(a_.beyond[piece.halfedge]);
    set_left(twin_of(on), across / 3, other_b,
             pair_.elements().product(out, is_forward ? element_behind : piece.element));
  }

  // -- The order of the stops along the edges of A --

  PlacedPoint of_a(int h) const { return pair_.signs().placed(a_.sites, a_.site_of(h)); }
  PlacedPoint of_b(int site, int element) const { return pair_.signs().placed(b_.sites, site, element); }

  LineThrough reference_line(int edge) const {
    const int h = a_.reference[edge];
    return {of_a(h), of_a(next_halfedge(h))};
  }

  // A line through the stop that is not that of the edge.
  LineThrough line_through(const EdgeStop& stop) const {
    const PlacedPoint from = of_b(stop.from, stop.element);
    if (stop.to < 0) return {from, of_a(previous_halfedge(a_.reference[stop.edge]))};
    return {from, of_b(stop.to, stop.element)};
  }

  bool comes_before(const EdgeStop& x, const EdgeStop& y) const {
    if (x.edge != y.edge) return x.edge < y.edge;
    if (x.vertex == y.vertex) return false;
    if (std::abs(x.share.value - y.share.value) > x.share.error + y.share.error)
      return x.share.value < y.share.value;
    const int order = pair_.signs().compare_shares(reference_line(x.edge), line_through(x), line_through(y));
    return order != 0 ? order < 0 : x.vertex < y.vertex;
  }

  void order_stops_of_a() {
    for (EdgeStop& stop : stops_)
      stop.share = pair_.signs().share(reference_line(stop.edge), line_through(stop));
    std::sort(stops_.begin(), stops_.end(),
              [&](const EdgeStop& x, const EdgeStop& y) { return comes_before(x, y); });
    index_on_a_.assign(result_.vertices.size(), none);
    share_on_a_.assign(result_.vertices.size(), 0);
    for (const EdgeStop& stop : stops_) share_on_a_[stop.vertex] = stop.share.value;
  }

  // The pieces of an edge of A are pieces of B where both run along each other, and new ones elsewhere.
  void lay_edges_of_a() {
    find_common_pieces();
    first_of_a_.reserve(a_.edge_count() + 1);
    pieces_of_a_.reserve(stops_.size() + a_.edge_count());
    halfedges_.reserve(halfedges_.size() + 2 * (stops_.size() + a_.edge_count()));
    std::size_t next = 0;
    for (int e = 0; e < a_.edge_count(); ++e) {
      const int h = a_.reference[e];
      int origin = id_of_a_[a_.vertex_of(h)], index = 0;
      for (; next < stops_.size() && stops_[next].edge == e; ++next) {
        const int vertex = stops_[next].vertex;
        lay_piece_of_a(e, origin, vertex);
        index_on_a_[vertex] = ++index;
        origin = vertex;
      }
      lay_piece_of_a(e, origin, id_of_a_[a_.vertex_of(next_halfedge(h))]);
      first_of_a_.push_back(static_cast<int>(pieces_of_a_.size()));
    }
  }

  // Those that run along edges of A, by the edge and where they begin, in the reference's direction.
  void find_common_pieces() {
    for (int g = 0; g < static_cast<int>(halfedges_.size()); ++g) {
      const int on = halfedges_[g].on_a;
      if (on >= 0 && a_.reference[a_.edge[on]] == on)
        common_.push_back({a_.edge[on], halfedges_[twin_of(g)].target, g});
    }
    std::sort(common_.begin(), common_.end());
  }

  // Along edge e of A from a vertex of the overlay on, or none; e does not fall from call to call.
  int common_piece(int e, int origin) {
    while (next_common_ < common_.size() && common_[next_common_][0] < e) ++next_common_;
    for (std::size_t k = next_common_; k < common_.size() && common_[k][0] == e; ++k)
      if (common_[k][1] == origin) return common_[k][2];
    return none;
  }

  void lay_piece_of_a(int e, int origin, int target) {
    const int h = a_.reference[e];
    if (const int common = common_piece(e, origin); common >= 0) {
      if (halfedges_[common].target != target) refuse_overlay();
      pieces_of_a_.push_back(common);
      return;
    }
    if (a_.opposite[h] < 0) refuse_overlay();
    const int g = add_edge(origin, target);
    halfedges_[g].on_a = h;
    halfedges_[twin_of(g)].on_a = a_.opposite[h];
    pieces_of_a_.push_back(g);
  }

  // -- Faces --

  // Of the boundary of a triangle: the piece that begins at a vertex of the overlay, or none.
  int piece_of_a_from(int vertex, int triangle) const {
    const OverlayVertex& v = result_.vertices[vertex];
    if (v.a_vertex >= 0) return first_piece_of_a(a_.corner_at(triangle, v.a_vertex));
    if (v.a_halfedge < 0) return none;
    const int e = a_.edge[v.a_halfedge], h = a_.halfedge_on(triangle, e), index = index_on_a_[vertex];
    if (h < 0) return none;
    const int piece = first_of_a_[e] + index;
    return a_.reference[e] == h ? pieces_of_a_[piece] : twin_of(pieces_of_a_[piece - 1]);
  }

  int first_piece_of_a(int h) const {
    if (h < 0) return none;
    const int e = a_.edge[h];
    return a_.reference[e] == h ? pieces_of_a_[first_of_a_[e]]
                                : twin_of(pieces_of_a_[first_of_a_[e + 1] - 1]);
  }

  int piece_of_b_from(int vertex, int triangle) const {
    const OverlayVertex& v = result_.vertices[vertex];
    if (v.b_vertex >= 0) return first_piece_of_b(b_.corner_at(triangle, v.b_vertex));
    if (v.b_halfedge < 0) return none;
    const int e = b_.edge[v.b_halfedge], h = b_.halfedge_on(triangle, e), index = index_on_b_[vertex];
    if (h < 0) return none;
    return walked_halfedge_[e] == h ? piece_of_b(e, index) : twin_of(piece_of_b(e, index - 1));
  }

  int first_piece_of_b(int h) const {
    if (h < 0) return none;
    const int e = b_.edge[h];
    return walked_halfedge_[e] == h ? piece_of_b(e, 0) : twin_of(piece_of_b(e, pieces_of_b_[e] - 1));
  }

  // They were made one after the other.
  int piece_of_b(int e, int k) const { return first_of_b_[e] + 2 * k; }

  void trace_faces() {
    index_on_b_.assign(result_.vertices.size(), none);
    for (int e = 0; e < b_.edge_count(); ++e)
      for (int k = 1; k < pieces_of_b_[e]; ++k) index_on_b_[halfedges_[twin_of(piece_of_b(e, k))].target] = k;
    reserve_faces();
    std::vector<int> waiting;
    waiting.reserve(halfedges_.size());
    for (int g = 0; g < static_cast<int>(halfedges_.size()); ++g)
      if (halfedges_[g].left_a >= 0) waiting.push_back(g);
    for (std::size_t k = 0; k < waiting.size(); ++k)
      if (!halfedges_[waiting[k]].is_traced) trace_face(waiting[k], waiting);
    for (const OverlayHalfedge& halfedge : halfedges_)
      if (!halfedge.is_traced && (halfedge.on_a >= 0 || halfedge.on_b >= 0)) refuse_overlay();
  }

  // E - V + 2 on a sphere, one less on a disk; every half-edge is one of a face's, or of the boundary.
  void reserve_faces() {
    const std::size_t edges = halfedges_.size() / 2, vertices = result_.vertices.size();
    const std::size_t faces = edges + 2 > vertices ? edges + 2 - vertices : 0;
    result_.faces.corners.reserve(halfedges_.size());
    result_.faces.start.reserve(faces + 1);
    result_.parents.reserve(faces);
  }

  void trace_face(int first, std::vector<int>& waiting) {
    const OverlayHalfedge face = halfedges_[first];
    constexpr int most_corners = 6;
    int g = first, corners = 0;
    do {
      if (++corners > most_corners) refuse_overlay();
      halfedges_[g].is_traced = true;
      result_.faces.corners.push_back(halfedges_[twin_of(g)].target);
      g = next_around(g, face);
      take_left(g, face, waiting);
    } while (g != first);
    result_.faces.start.push_back(static_cast<int>(result_.faces.corners.size()));
    result_.parents.push_back({face.left_a, face.left_b, placement_of(face.element)});
    remember_vertices(face);
  }

  // The half-edge is on the boundary of the face.
  void take_left(int g, const OverlayHalfedge& face, std::vector<int>& waiting) {
    OverlayHalfedge& halfedge = halfedges_[g];
    if (halfedge.left_a >= 0) {
      if (halfedge.left_a != face.left_a || halfedge.left_b != face.left_b) refuse_overlay();
      return;
    }
    set_left(g, face.left_a, face.left_b, face.element);
    const int on = halfedge.on_a, across = a_.opposite[on], back = twin_of(g);
    const int out = pair_.elements().inverse(a_.beyond[on]);
    set_left(back, across / 3, face.left_b, pair_.elements().product(out, face.element));
    waiting.push_back(back);
  }

  int next_around(int g, const OverlayHalfedge& face) const {
    const int vertex = halfedges_[g].target, along_a = piece_of_a_from(vertex, face.left_a),
              along_b = piece_of_b_from(vertex, face.left_b);
    if (along_a < 0 && along_b < 0) refuse_overlay();
    if (along_a < 0 || along_a == along_b) return along_b;
    if (along_b < 0) return along_a;
    const OverlayVertex& v = result_.vertices[vertex];
    if (v.a_vertex < 0 && v.b_vertex < 0) return halfedges_[g].on_a >= 0 ? along_b : along_a;
    return turns_left(vertex, along_a, along_b, face) ? along_b : along_a;
  }

  // Does the second one, on a half-edge of B, begin on the left of the first, on one of A?
  bool turns_left(int vertex, int along_a, int along_b, const OverlayHalfedge& face) const {
    const OverlayVertex& v = result_.vertices[vertex];
    const PlacedPoint end_of_a = of_a(next_halfedge(halfedges_[along_a].on_a)),
                      end_of_b = of_b(b_.site_of(next_halfedge(halfedges_[along_b].on_b)), face.element);
    const PlacedPoint here = v.a_vertex >= 0
                                 ? of_a(a_.corner_at(face.left_a, v.a_vertex))
                                 : of_b(b_.site_of(b_.corner_at(face.left_b, v.b_vertex)), face.element);
    const int sign = pair_.signs().orientation(here, end_of_a, end_of_b);
    if (sign == 0) refuse_overlay();
    return sign > 0;
  }

  int placement_of(int element) {
    if (element >= static_cast<int>(placement_.size())) placement_.resize(pair_.elements().count(), none);
    int& placement = placement_[element];
    if (placement == none) {
      placement = static_cast<int>(result_.placements.size());
      result_.placements.push_back(pair_.elements().rough(element));
    }
    return placement;
  }

  // -- Where vertices lie --

  // The corners of the last face that are vertices of A: they lie on its triangle of B.
  void remember_vertices(const OverlayHalfedge& face) {
    const std::vector<int>& start = result_.faces.start;
    for (int k = start[start.size() - 2]; k < start.back(); ++k) {
      const int id = result_.faces.corners[k];
      const OverlayVertex& v = result_.vertices[id];
      if (v.a_vertex >= 0 && v.b_halfedge < 0)
        meeting_[id] = {a_.corner_at(face.left_a, v.a_vertex), 3 * face.left_b, face.element};
    }
  }

  void locate_vertices() {
    const int count = result_.vertex_count();
    result_.on_a = {std::vector<int>(count, none), Points::Zero(count, 3), {}};
    result_.on_b = result_.on_a;
    for (int v = 0; v < count; ++v) {
      locate_on_a(v);
      locate_on_b(v);
    }
  }

  static void put(SurfacePoints& points, int k, int triangle, const Vector3& coordinates) {
    points.triangle[k] = triangle;
    points.barycentric.row(k) = coordinates.transpose();
  }

  // At the corner of a half-edge, or on it with the share of its end.
  static void put_on_edge(SurfacePoints& points, int k, int halfedge, double share) {
    Vector3 coordinates = Vector3::Zero();
    coordinates[next_halfedge(halfedge) % 3] = share;
    coordinates[halfedge % 3] = 1 - share;
    put(points, k, halfedge / 3, coordinates);
  }

  void locate_on_a(int id) {
    const OverlayVertex& v = result_.vertices[id];
    if (v.a_vertex >= 0) {
      put_on_edge(result_.on_a, id, a_.first_halfedge[v.a_vertex], 0);
    } else if (v.a_halfedge >= 0) {
      put_on_edge(result_.on_a, id, a_.reference[a_.edge[v.a_halfedge]], share_on_a_[id]);
    } else {
      const Fix& fix = fixes_[v.b_vertex];
      put(result_.on_a, id, fix.place.triangle(), pair_.coordinates(fix.place, b_.site_of(fix.halfedge)));
    }
  }

  void locate_on_b(int id) {
    const OverlayVertex& v = result_.vertices[id];
    if (v.b_vertex >= 0) {
      put_on_edge(result_.on_b, id, b_.first_halfedge[v.b_vertex], 0);
    } else if (v.a_vertex < 0) {
      put_on_edge(result_.on_b, id, v.b_halfedge, share_on_b_[id]);
    } else {
      locate_vertex_of_a(id);
    }
  }

  void locate_vertex_of_a(int id) {
    const Meeting& meeting = meeting_[id];
    if (meeting.on_b < 0) refuse_overlay();
    const int first = 3 * (meeting.on_b / 3);
    const auto corner = [&](int k) { return of_b(b_.site_of(first + k), meeting.element); };
    Vector3 coordinates =
        pair_.signs().coordinates({corner(0), corner(1), corner(2)}, of_a(meeting.corner_of_a));
    if (result_.vertices[id].b_halfedge >= 0) coordinates[(meeting.on_b + 2) % 3] = 0;
    put(result_.on_b, id, first / 3, coordinates / coordinates.sum());
  }

  // A corner of a triangle of A, and the half-edge of B that it is on or beside.
  struct Meeting {
    int corner_of_a = none, on_b = none;
    int element = ElementTable::identity;
  };

  SurfacePair pair_;
  const DevelopedSurface& a_;
  const DevelopedSurface& b_;
  WalkedEdges walked_;
  std::vector<Fix> fixes_;              // of B's vertices
  std::vector<int> id_of_a_, id_of_b_;  // vertices of the overlay
  std::vector<EdgeStop> stops_;         // on edges of A
  std::vector<OverlayHalfedge> halfedges_;
  // Of edges of A, in the direction of the reference: edge e has those from first_of_a_[e] on.
  std::vector<int> first_of_a_ = {0}, pieces_of_a_;

  // Of edges of B, in the direction of the half-edge that was walked: the first one, and how many there are.
  std::vector<int> walked_halfedge_, first_of_b_, pieces_of_b_;
  std::vector<std::array<int, 3>> common_;  // edges of A, vertices of the overlay, half-edges of the overlay
  std::size_t next_common_ = 0;
  std::vector<int> index_on_a_, index_on_b_;     // of the overlay's vertices: their places among the pieces
  std::vector<double> share_on_a_, share_on_b_;  // of these directions
  std::vector<Meeting> meeting_;                 // of the vertices of A
  std::vector<int> placement_;                   // of elements
  Overlay result_;
};

}  // namespace

Overlay overlay(const Embedding& a, const Embedding& b) {
  const DividedEars of_a(a), of_b(b);
  Overlay result = OverlayBuilder(of_a.parts(), of_b.parts()).run();
  return of_a.any() || of_b.any() ? joined_overlay(std::move(result), of_a, of_b) : result;
}

Points positions_on(const Points& V, const Embedding& embedding, const SurfacePoints& points) {
  Points result = Points::Constant(points.count(), 3, std::numeric_limits<double>::quiet_NaN());
  for (int k = 0; k < points.count(); ++k) {
    const int t = points.triangle[k];
    if (t < 0) continue;
    result.row(k).setZero();
    for (int i = 0; i < 3; ++i)
      if (const double weight = points.barycentric(k, i); weight != 0)
        result.row(k) += weight * V.row(embedding.source_vertex[embedding.triangles(t, i)]);
  }
  return result;
}

OverlayTriangles overlay_triangles(const Overlay& overlay) {
  const std::vector<int>& start = overlay.faces.start;
  OverlayTriangles result;
  result.triangles.resize(start.back() - 2 * overlay.face_count(), 3);
  int t = 0;
  for (int f = 0; f < overlay.face_count(); ++f) {
    const int* const corners = overlay.faces.corners.data() + start[f];
    for (int k = 2; k < start[f + 1] - start[f]; ++k) {
      result.triangles.row(t++) << corners[0], corners[k - 1], corners[k];
      result.face.push_back(f);
    }
  }
  return result;
}

}  // namespace orbitutte
