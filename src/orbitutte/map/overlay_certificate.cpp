// SPDX-License-Identifier: MIT
// Why this is a proof: the faces are convex polygons, counterclockwise, each in one triangle of A and in one
// of B, and go on across their edges as these do. So the map from the overlay to A is a local homeomorphism,
// but perhaps at vertices, and since areas add up to that of every triangle it covers each once, and is one
// at the vertices, too; the same holds for B.
#include "orbitutte/map/overlay_certificate.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>
#include <optional>
#include <span>
#include <type_traits>
#include <utility>

#include "orbitutte/geometry/double_double.h"
#include "orbitutte/geometry/geodesic_triangle.h"
#include "orbitutte/geometry/precise_isometry.h"
#include "orbitutte/map/developed_surface.h"
#include "orbitutte/map/divided_ears.h"
#include "orbitutte/map/joined_overlay.h"
#include "orbitutte/mesh/connectivity.h"
#include "orbitutte/mesh/disjoint_sets.h"
#include "orbitutte/parallel.h"

namespace orbitutte {
namespace {

// Counts what is wrong, and keeps the first sentence about it.
class Findings {
 public:
  explicit Findings(std::string name) : name_(std::move(name)) {}

  template <typename... Arguments>
  void add(fmt::format_string<Arguments...> text, Arguments&&... arguments) {
    if (count_++ == 0) first_ = fmt::format(text, std::forward<Arguments>(arguments)...);
  }

  Check check() const { return {name_, count_ == 0, static_cast<double>(count_), 0, first_}; }

 private:
  std::string name_, first_;
  long long count_ = 0;
};

// A point in doubles, or in two doubles for each coordinate, and by how much each may be off.
template <typename Number>
struct PointWithin {
  Vector3Of<Number> x = Vector3Of<Number>::Zero();
  double error = 0;
};

using NearPoint = PointWithin<double>;
using NearerPoint = PointWithin<DoubleDouble>;

double largest_coordinate(const Vector3& v) { return v.cwiseAbs().maxCoeff(); }
double sum_of_coordinates(const Vector3& v) { return v.cwiseAbs().sum(); }

Vector3 in_doubles(const Vector3& v) { return v; }
Vector3 in_doubles(const Vector3Of<DoubleDouble>& v) { return {v[0].high(), v[1].high(), v[2].high()}; }

double in_doubles(double x) { return x; }
double in_doubles(const DoubleDouble& x) { return x.high(); }

// What one operation loses, in parts of its result.
template <typename Number>
constexpr double rounding_of = std::is_same_v<Number, double> ? 0x1p-53 : 5 * DoubleDouble::unit;

// p . (q - p) x (r - p) = det[p q r], and by how much it may be off.
template <typename Number>
struct DeterminantWithin {
  Number value;
  double error = 0;
};

// With |p| the sum of the coordinates and e the errors, it is off by no more than 2 |p| (|u| e_v + |v| e_u +
// e_u e_v + 8 |u| |v| 2^-53) + 2 e_p |u| |v|.
template <typename Number>
DeterminantWithin<Number> determinant_of(const PointWithin<Number>& p, const PointWithin<Number>& q,
                                         const PointWithin<Number>& r) {
  constexpr double unit = rounding_of<Number>;
  const Vector3Of<Number> u = q.x - p.x, v = r.x - p.x;
  const double of_u = largest_coordinate(in_doubles(u)), of_v = largest_coordinate(in_doubles(v)),
               off_u = p.error + q.error + unit * of_u, off_v = p.error + r.error + unit * of_v,
               sum = sum_of_coordinates(in_doubles(p.x)) + 3 * p.error;
  const double bound = 2 * sum * (of_u * off_v + of_v * off_u + off_u * off_v + 8 * unit * of_u * of_v) +
                       6 * p.error * of_u * of_v + 1e-290;
  return {p.x.dot(u.cross(v)), bound};
}

// The sign of det[p q r], or nothing if rounding may have changed it.
template <typename Number>
std::optional<int> sign_within(const PointWithin<Number>& p, const PointWithin<Number>& q,
                               const PointWithin<Number>& r) {
  const DeterminantWithin<Number> found = determinant_of<Number>(p, q, r);
  const double value = in_doubles(found.value);
  if (value > found.error) return 1;
  if (value < -found.error) return -1;
  return std::nullopt;
}

// A point with more digits, and by how much it may be off, relative to its largest coordinate.
template <typename Real>
struct DigitPoint {
  Vector3Of<Real> x;
  Real error = 0;
};

// What products of a few numbers lose: all but some of their bits are right. Numbers of 320 bits are rounded
// from those of all bits, whose elements are long products: far out in the hyperbolic plane, each factor
// loses some twenty bits.
template <typename Real>
Real digit_error() {
  constexpr int lost_bits = std::is_same_v<Real, Precise> ? 12 : 300;
  return ldexp(Real(1), lost_bits - std::numeric_limits<Real>::digits);
}

template <typename Real>
Real size_of(const Vector3Of<Real>& v) {
  return std::max({Real(abs(v[0])), Real(abs(v[1])), Real(abs(v[2]))});
}

// The sign of det[p q r], or 0 if it may be any.
template <typename Real>
int sign_with_digits(const DigitPoint<Real>& p, const DigitPoint<Real>& q, const DigitPoint<Real>& r) {
  const Real value = p.x.dot(q.x.cross(r.x)),
             error = 20 * (p.error + q.error + r.error + digit_error<Real>()),
             bound = error * size_of<Real>(p.x) * size_of<Real>(q.x) * size_of<Real>(r.x);
  if (abs(value) <= bound) return 0;
  return value > 0 ? 1 : -1;
}

// The corner of a triangle of a parent, moved by an element.
struct MovedSite {
  const DevelopedSurface* surface;
  int site;
  int element;
};

// The points of one pair of triangles with as many digits as it takes.
class PointSource {
 public:
  PointSource(const ElementTable& elements, Space space, bool has_offsets)
      : elements_(elements), space_(space), has_offsets_(has_offsets) {}

  bool has_offsets() const { return has_offsets_; }

  NearPoint near(const MovedSite& at) const {
    const Vector3 x = at.surface->sites.rough(at.site);
    const double error = at.surface->sites.error(at.site);
    if (at.element == ElementTable::identity) return {x, error};
    const Matrix3& m = elements_.rough(at.element).matrix();
    const double size = m.cwiseAbs().maxCoeff();
    return {m * x, size * (3 * error + 0x1p-50 * x.cwiseAbs().sum())};
  }

  NearerPoint nearer(const MovedSite& at) const {
    const Vector3Of<DoubleDouble> x = at.surface->sites.fine(at.site);
    const double error = at.surface->sites.fine_error(at.site);
    if (at.element == ElementTable::identity) return {x, error};
    const double size = elements_.rough(at.element).matrix().cwiseAbs().maxCoeff(),
                 sum = sum_of_coordinates(in_doubles(x));
    return {elements_.fine(at.element) * x, size * (3 * error + 64 * DoubleDouble::unit * sum)};
  }

  template <typename Real>
  DigitPoint<Real> with_digits(const MovedSite& at) const {
    Vector3Of<Real> x;
    if constexpr (std::is_same_v<Real, Precise>) {
      x = at.surface->sites.precise(at.site);
      if (at.element != ElementTable::identity) x = (elements_.precise(at.element) * x).eval();
    } else {
      x = at.surface->sites.exact(at.site);
      if (at.element != ElementTable::identity) x = (elements_.exact(at.element) * x).eval();
    }
    return {x, digit_error<Real>()};
  }

  int sign(const MovedSite& p, const MovedSite& q, const MovedSite& r) const {
    if (const std::optional<int> sign = sign_within<double>(near(p), near(q), near(r))) return *sign;
    if (have_same_digits(p, q) || have_same_digits(q, r) || have_same_digits(r, p)) return 0;
    if (const std::optional<int> sign = sign_within<DoubleDouble>(nearer(p), nearer(q), nearer(r)))
      return *sign;
    const int sign = sign_of<Precise>(p, q, r);
    return sign != 0 || !has_offsets_ ? sign : sign_of<MostPrecise>(p, q, r);
  }

  // Where the line through two points crosses the edge between two others, on the side of the edge.
  template <typename Real>
  DigitPoint<Real> crossing(const std::array<MovedSite, 2>& edge,
                            const std::array<MovedSite, 2>& line) const {
    const Vector3Of<Real> a = with_digits<Real>(edge[0]).x, b = with_digits<Real>(edge[1]).x,
                          c = with_digits<Real>(line[0]).x, d = with_digits<Real>(line[1]).x;
    const Vector3Of<Real> of_edge = a.cross(b), of_line = c.cross(d), sum = a + b;
    const Vector3Of<Real> point = of_edge.cross(of_line);
    const Real side = space_.side(point, sum),
               terms = size_of<Real>(a) * size_of<Real>(b) * size_of<Real>(c) * size_of<Real>(d);
    const Real error = 100 * digit_error<Real>() * terms / size_of<Real>(point);
    return {side < 0 ? Vector3Of<Real>(-point) : point, error};
  }

 private:
  // Then every determinant with both is zero.
  static bool have_same_digits(const MovedSite& p, const MovedSite& q) {
    const Sites &of_p = p.surface->sites, &of_q = q.surface->sites;
    if (p.element != q.element || of_p.rough(p.site) != of_q.rough(q.site)) return false;
    return (of_p.is_double(p.site) && of_q.is_double(q.site)) || of_p.exact(p.site) == of_q.exact(q.site);
  }

  template <typename Real>
  int sign_of(const MovedSite& p, const MovedSite& q, const MovedSite& r) const {
    return sign_with_digits<Real>(with_digits<Real>(p), with_digits<Real>(q), with_digits<Real>(r));
  }

  const ElementTable& elements_;
  Space space_;
  bool has_offsets_;
};

// Where a corner of a face lies in one of the parents: at a corner or on an edge of it, or -1 for neither.
struct PlaceInParent {
  signed char corner = -1, edge = -1;

  // Bit k: it lies on edge k, its ends included.
  unsigned edges() const {
    if (corner >= 0) return 1U << corner | 1U << (corner + 2) % 3;
    return edge >= 0 ? 1U << edge : 0U;
  }
};

// An edge of the overlay as a face has it, and the same as a face on the other side has it: its number, or
// -1.
struct DirectedEdge {
  int origin = -1, target = -1, face = -1, twin = -1;
};

class OverlayExaminer {
 public:
  OverlayExaminer(const Overlay& overlay, const Embedding& a, const Embedding& b)
      : overlay_(overlay),
        embeddings_{&a, &b},
        elements_(a.space()),
        group_(a, b),
        surfaces_{developed_surface(a, group_, elements_, "one surface"),
                  developed_surface(b, group_, elements_, "the other surface")},
        points_(elements_, a.space(), !a.offsets.empty() || !b.offsets.empty()) {}

  OverlayCertificate run() {
    if (examine_indices()) find_places();
    if (result_.checks.back().passed && find_elements()) {
      examine_placements();
      examine_surface();
      examine_vertices();
      examine_parents();
      examine_shapes();
      examine_neighbours();
      examine_positions();
      examine_shares(0, "shares_of_a");
      examine_shares(1, "shares_of_b");
      examine_area();
    }
    result_.holds = std::all_of(result_.checks.begin(), result_.checks.end(),
                                [](const Check& check) { return check.passed; });
    return std::move(result_);
  }

 private:
  int face_count() const { return overlay_.face_count(); }
  std::span<const int> corners(int f) const { return FaceView(overlay_.faces)[f]; }
  const DevelopedSurface& surface(int side) const { return surfaces_[side]; }
  int parent(int side, int f) const { return side == 0 ? overlay_.parents[f].a : overlay_.parents[f].b; }
  int element(int f) const { return element_of_[f]; }
  const SurfacePoints& places(int side) const { return side == 0 ? overlay_.on_a : overlay_.on_b; }

  int vertex_on(int side, int v) const {
    const OverlayVertex& vertex = overlay_.vertices[v];
    return side == 0 ? vertex.a_vertex : vertex.b_vertex;
  }
  int halfedge_on(int side, int v) const {
    const OverlayVertex& vertex = overlay_.vertices[v];
    return side == 0 ? vertex.a_halfedge : vertex.b_halfedge;
  }

  void conclude(const Findings& findings) { result_.checks.push_back(findings.check()); }

  // -- Claims that everything else relies on --

  bool examine_indices() {
    Findings findings("indices");
    const auto count = static_cast<std::size_t>(overlay_.vertex_count());
    for (int side = 0; side < 2; ++side)
      if (places(side).triangle.size() != count || places(side).barycentric.rows() != overlay_.vertex_count())
        findings.add("the vertices do not all have places on both surfaces");
    if (overlay_.parents.size() != static_cast<std::size_t>(face_count()))
      findings.add("the faces do not all have parents");
    for (int v = 0; v < overlay_.vertex_count(); ++v) examine_vertex_indices(v, findings);
    for (const int v : overlay_.faces.corners)
      if (v < 0 || v >= overlay_.vertex_count()) findings.add("a face names the vertex {}", v);
    for (std::size_t f = 0; f < overlay_.parents.size(); ++f) {
      const OverlayFace& face = overlay_.parents[f];
      if (face.a < 0 || face.a >= surface(0).triangle_count() || face.b < 0 ||
          face.b >= surface(1).triangle_count() || face.placement < 0 ||
          face.placement >= static_cast<int>(overlay_.placements.size()))
        findings.add("face {} has no parents", f);
    }
    conclude(findings);
    return findings.check().passed;
  }

  void examine_vertex_indices(int v, Findings& findings) {
    for (int side = 0; side < 2; ++side) {
      const int triangles = surface(side).triangle_count();
      if (vertex_on(side, v) >= surface(side).vertex_count() || halfedge_on(side, v) >= 3 * triangles)
        findings.add("vertex {} names a vertex or a half-edge that does not exist", v);
      if (v >= static_cast<int>(places(side).triangle.size())) continue;
      const int t = places(side).triangle[v];
      if (t < 0 || t >= triangles) findings.add("vertex {} lies in no triangle", v);
    }
  }

  const Isometry& placement(int f) const { return overlay_.placements[overlay_.parents[f].placement]; }

  // The face whose placement is nearest to none at all.
  int least_moved_face() const {
    const Isometry nothing = embeddings_[0]->placement * embeddings_[1]->placement.inverse();
    int nearest = 0;
    for (int f = 1; f < face_count(); ++f)
      if (placement(f).difference(nothing) < placement(nearest).difference(nothing)) nearest = f;
    return nearest;
  }

  // Of every corner of every face, in the order of the faces' corners.
  void find_places() {
    for (int side = 0; side < 2; ++side) places_in_parents_[side].resize(overlay_.faces.corners.size());
    parallel_ranges(face_count(), [&](int begin, int end) {
      for (int f = begin; f < end; ++f)
        for (int k = first_edge(f); k < first_edge(f + 1); ++k)
          for (int side = 0; side < 2; ++side)
            places_in_parents_[side][k] = place_in_parent(side, f, overlay_.faces.corners[k]);
    });
  }

  PlaceInParent place_in_parent(int side, int f, int v) const {
    PlaceInParent place;
    if (vertex_on(side, v) >= 0)
      if (const int h = surface(side).corner_at(parent(side, f), vertex_on(side, v)); h >= 0)
        place.corner = static_cast<signed char>(h % 3);
    if (halfedge_on(side, v) >= 0)
      if (const int h = surface(side).halfedge_on(parent(side, f), surface(side).edge[halfedge_on(side, v)]);
          h >= 0)
        place.edge = static_cast<signed char>(h % 3);
    return place;
  }

  // The elements that place B: from one face, where the group is asked for it, to all others. A group need
  // not be discrete, so that no element would be known by its doubles alone.
  bool find_elements() {
    Findings findings("group");
    if (face_count() == 0) findings.add("there are no faces");
    list_edges();
    element_of_.assign(face_count(), ElementTable::identity);
    if (face_count() > 0) {
      const int first = least_moved_face();
      try {
        spread_elements(first, element_near(placement(first)));
      } catch (const ArgumentError& error) {
        findings.add("the placement of face {}: {}", first, error.what());
      }
    }
    conclude(findings);
    return findings.check().passed;
  }

  int element_near(const Isometry& isometry) {
    const Isometry &of_a = embeddings_[0]->placement, &of_b = embeddings_[1]->placement;
    const Space space = embeddings_[0]->space();
    const Matrix3Of<MostPrecise> out = exact_isometry(space, of_a),
                                 in = precise_inverse(space, exact_isometry(space, of_b));
    return elements_.add(out * group_.element(of_a.inverse() * isometry * of_b) * in);
  }

  void spread_elements(int first, int element_of_first) {
    std::vector<char> is_reached(face_count(), 0);
    std::vector<int> reached = {first};
    element_of_[first] = element_of_first;
    is_reached[first] = 1;
    for (std::size_t n = 0; n < reached.size(); ++n) {
      for (int e = first_edge(reached[n]); e < first_edge(reached[n] + 1); ++e) {
        if (edges_[e].twin < 0) continue;
        const int beyond = edges_[edges_[e].twin].face;
        if (is_reached[beyond]) continue;
        is_reached[beyond] = 1;
        element_of_[beyond] = element_beyond(e);
        reached.push_back(beyond);
      }
    }
  }

  // Beyond the edges of the parents that an edge of the overlay lies on: G_h^-1 G G_k.
  int element_beyond(int e) {
    const int h = halfedge_under(0, e), k = halfedge_under(1, e);
    int result = element(edges_[e].face);
    if (h >= 0) result = elements_.product(elements_.inverse(surface(0).beyond[h]), result);
    return k >= 0 ? elements_.product(result, surface(1).beyond[k]) : result;
  }

  void examine_placements() {
    constexpr double bound = 1e-6;
    Findings findings("placements");
    for (int f = 0; f < face_count(); ++f) {
      const Isometry& found = elements_.rough(element(f));
      if (!(found.difference(placement(f)) <= bound * std::max(1.0, found.matrix().cwiseAbs().maxCoeff())))
        findings.add("face {} is placed by another element than its neighbours say", f);
    }
    conclude(findings);
  }

  // -- The surface --

  // Edge e of the list leads to corner e of all faces' corners.
  int first_edge(int face) const { return overlay_.faces.start[face]; }

  void list_edges() {
    edges_.reserve(overlay_.faces.corners.size());
    for (int f = 0; f < face_count(); ++f) {
      int origin = corners(f).back();
      for (const int v : corners(f)) {
        edges_.push_back({origin, v, f, -1});
        origin = v;
      }
    }
    find_twins();
  }

  // Of edges in one direction that have the same ends, which is a fault, the first one has the twin.
  void find_twins() {
    const auto low = [&](const DirectedEdge& edge) { return std::min(edge.origin, edge.target); };
    std::vector<int> start(overlay_.vertex_count() + 1, 0), by_low(edges_.size());
    for (const DirectedEdge& edge : edges_) ++start[low(edge) + 1];
    for (int v = 0; v < overlay_.vertex_count(); ++v) start[v + 1] += start[v];
    std::vector<int> next(start.begin(), start.end() - 1);
    for (int e = 0; e < static_cast<int>(edges_.size()); ++e) by_low[next[low(edges_[e])]++] = e;
    for (int v = 0; v < overlay_.vertex_count(); ++v)
      find_twins_of({by_low.data() + start[v], by_low.data() + start[v + 1]});
  }

  // Of edges with the same lower end.
  void find_twins_of(std::span<int> edges) {
    const auto high = [&](int e) { return std::max(edges_[e].origin, edges_[e].target); };
    std::sort(edges.begin(), edges.end(),
              [&](int x, int y) { return std::pair(high(x), x) < std::pair(high(y), y); });
    for (std::size_t begin = 0, end = 0; begin < edges.size(); begin = end) {
      int forward = -1, backward = -1;
      for (end = begin; end < edges.size() && high(edges[end]) == high(edges[begin]); ++end) {
        const int e = edges[end];
        int& first = edges_[e].origin < edges_[e].target ? forward : backward;
        (first < 0 ? first : repeated_edge_) = e;
      }
      if (forward < 0 || backward < 0) continue;
      edges_[forward].twin = backward;
      edges_[backward].twin = forward;
    }
  }

  void examine_surface() {
    Findings findings("surface");
    const bool is_disk = embeddings_[0]->target.topology == Topology::disk;
    DisjointSets pieces(face_count());
    long long boundary = 0;
    std::vector<int> leaving(overlay_.vertex_count(), 0);
    if (repeated_edge_ >= 0)
      findings.add("two faces run along the edge from {} to {}", edges_[repeated_edge_].origin,
                   edges_[repeated_edge_].target);
    for (const DirectedEdge& edge : edges_) {
      if (edge.twin >= 0) {
        pieces.unite(edge.face, edges_[edge.twin].face);
        continue;
      }
      ++boundary;
      if (++leaving[edge.origin] > 1) findings.add("the boundary meets vertex {} twice", edge.origin);
      if (!is_disk) findings.add("face {} has an edge without a neighbour", edge.face);
    }
    for (int f = 1; f < face_count(); ++f)
      if (pieces.find(f) != pieces.find(0)) {
        findings.add("face {} is not connected with face 0", f);
        break;
      }
    examine_fans(findings);
    conclude(findings);
    const long long undirected = (static_cast<long long>(edges_.size()) + boundary) / 2;
    result_.euler_characteristic = static_cast<int>(overlay_.vertex_count() - undirected + face_count());
    const int expected = is_disk ? 1 : 2;
    Findings characteristic("euler_characteristic");
    if (result_.euler_characteristic != expected)
      characteristic.add("it is {} and not {}", result_.euler_characteristic, expected);
    conclude(characteristic);
  }

  // Are the faces around every vertex one fan? A turn around it from the edge of any face meets them all.
  void examine_fans(Findings& findings) {
    std::vector<int> faces(overlay_.vertex_count(), 0), met(overlay_.vertex_count(), 0);
    std::vector<char> is_begun(overlay_.vertex_count(), 0);
    for (const int v : overlay_.faces.corners) ++faces[v];
    for (const DirectedEdge& edge : edges_) {
      const int v = edge.origin;
      const bool is_first = edge.twin < 0;
      if (is_begun[v] == 2 || (is_begun[v] == 1 && !is_first)) continue;
      is_begun[v] = is_first ? 2 : 1;
      met[v] = faces_around(edge);
    }
    for (int v = 0; v < overlay_.vertex_count(); ++v)
      if (met[v] != faces[v] || faces[v] == 0) findings.add("the faces around vertex {} are not one fan", v);
  }

  // Counterclockwise from the face on the left of an edge, until the same face or the boundary: on by the
  // twin of the edge of the face that leads to the vertex.
  int faces_around(const DirectedEdge& first) const {
    int count = 0;
    const DirectedEdge* edge = &first;
    do {
      ++count;
      const int twin = edges_[edge_to(edge->face, first.origin)].twin;
      edge = twin < 0 ? nullptr : &edges_[twin];
    } while (edge && edge != &first && count <= face_count());
    return count;
  }

  // The edge of a face that leads to one of its corners.
  int edge_to(int face, int corner) const {
    int e = first_edge(face);
    while (edges_[e].target != corner) ++e;
    return e;
  }

  // -- Vertices --

  void examine_vertices() {
    Findings findings("vertices"), landmarks("landmarks");
    for (int side = 0; side < 2; ++side) {
      std::vector<int> times(surface(side).vertex_count(), 0);
      for (int v = 0; v < overlay_.vertex_count(); ++v)
        if (const int of_input = vertex_on(side, v); of_input >= 0) ++times[of_input];
      for (int v = 0; v < surface(side).vertex_count(); ++v)
        if (times[v] != (surface(side).first_halfedge[v] >= 0 ? 1 : 0))
          findings.add("vertex {} of {} is {} vertices of the overlay", v, side == 0 ? "A" : "B", times[v]);
    }
    std::vector<int> partner(surface(0).vertex_count(), -1);
    for (const OverlayVertex& v : overlay_.vertices)
      if (v.a_vertex >= 0) partner[v.a_vertex] = v.b_vertex;
    for (std::size_t k = 0; k < embeddings_[0]->cones.size(); ++k) {
      const int of_a = embeddings_[0]->cones[k].vertex, of_b = embeddings_[1]->cones[k].vertex;
      if (partner[of_a] != of_b)
        landmarks.add("the marked vertex {} of A does not lie on the marked vertex {} of B", of_a, of_b);
    }
    conclude(findings);
    conclude(landmarks);
  }

  // -- Corners --

  // A corner of a parent of face f, in the frame of its triangle of A.
  MovedSite corner_of_parent(int side, int f, int k) const {
    return {&surface(side), surface(side).site_of(3 * parent(side, f) + k),
            side == 0 ? ElementTable::identity : element(f)};
  }

  // Of the corner that entry k of all faces' corners is.
  const PlaceInParent& place(int side, int k) const { return places_in_parents_[side][k]; }

  std::array<MovedSite, 2> edge_of_parent(int side, int f, int k) const {
    return {corner_of_parent(side, f, k), corner_of_parent(side, f, (k + 1) % 3)};
  }

  void examine_parents() {
    Findings findings("parents");
    const std::vector<int> wrong =
        parallel_select(face_count(), [&](int f) { return !all_corners_belong(f); });
    for (const int f : wrong)
      findings.add("face {} has a corner that does not belong to both of its parents", f);
    conclude(findings);
  }

  bool all_corners_belong(int f) const {
    for (int k = first_edge(f); k < first_edge(f + 1); ++k)
      if (!belongs(f, k)) return false;
    return true;
  }

  // A vertex of one parent is in the other, as it says: at a corner, on an edge, or inside. A crossing is on
  // an edge of each.
  bool belongs(int f, int k) const {
    const int v = overlay_.faces.corners[k];
    const PlaceInParent &on_a = place(0, k), &on_b = place(1, k);
    if ((vertex_on(0, v) >= 0) != (on_a.corner >= 0)) return false;
    if ((vertex_on(1, v) >= 0) != (on_b.corner >= 0)) return false;
    if (on_a.corner >= 0 && on_b.corner >= 0) return is_same_point(f, on_a.corner, on_b.corner);
    if (on_a.corner >= 0) return lies_as_claimed(f, k, 1, corner_of_parent(0, f, on_a.corner));
    if (on_b.corner >= 0) return lies_as_claimed(f, k, 0, corner_of_parent(1, f, on_b.corner));
    return on_a.edge >= 0 && on_b.edge >= 0 &&
           do_cross(edge_of_parent(0, f, on_a.edge), edge_of_parent(1, f, on_b.edge));
  }

  // Both lie on one line through the origin of R^3, seen from two other points.
  bool is_same_point(int f, int of_a, int of_b) const {
    const MovedSite x = corner_of_parent(0, f, of_a), y = corner_of_parent(1, f, of_b);
    for (int k = 1; k < 3; ++k)
      if (points_.sign(x, y, corner_of_parent(0, f, (of_a + k) % 3)) != 0) return false;
    return true;
  }

  // In the parent of a side: on the edge that it names, or inside if it names none.
  bool lies_as_claimed(int f, int k, int side, const MovedSite& point) const {
    const int on = place(side, k).edge;
    if (halfedge_on(side, overlay_.faces.corners[k]) >= 0 && on < 0) return false;
    for (int i = 0; i < 3; ++i) {
      const auto edge = edge_of_parent(side, f, i);
      if (points_.sign(edge[0], edge[1], point) != (i == on ? 0 : 1)) return false;
    }
    return true;
  }

  bool do_cross(const std::array<MovedSite, 2>& a, const std::array<MovedSite, 2>& b) const {
    const int from = points_.sign(a[0], a[1], b[0]), to = points_.sign(a[0], a[1], b[1]),
              before = points_.sign(b[0], b[1], a[0]), after = points_.sign(b[0], b[1], a[1]);
    return from * to < 0 && before * after < 0;
  }

  // -- Shapes --

  void examine_shapes() {
    Findings findings("positive_faces");
    result_.nonpositive_faces = parallel_select(face_count(), [&](int f) { return !is_convex(f); });
    for (const int f : result_.nonpositive_faces)
      findings.add("face {} is no convex polygon that is counterclockwise on the target", f);
    conclude(findings);
  }

  // Three corners of a face.
  using CornerTriple = std::array<int, 3>;

  // Those of a face whose sign is still to be found.
  class OpenTriples {
   public:
    // Every three corners that follow each other, and the triangles from the first corner.
    explicit OpenTriples(int count) {
      for (int k = 0; k < count; ++k) triples_[size_++] = {k, (k + 1) % count, (k + 2) % count};
      for (int k = 2; k + 1 < count; ++k) triples_[size_++] = {0, k, k + 1};
    }

    bool empty() const { return size_ == 0; }

    // Removes those whose sign is positive; false if one is negative.
    template <typename Sign>
    bool remove_positive(const Sign& sign) {
      int kept = 0;
      for (int i = 0; i < size_; ++i) {
        const int found = sign(triples_[i]);
        if (found < 0) return false;
        if (found == 0) triples_[kept++] = triples_[i];
      }
      size_ = kept;
      return true;
    }

   private:
    std::array<CornerTriple, 9> triples_;
    int size_ = 0;
  };

  // All of these triples turn left.
  bool is_convex(int f) const {
    const int count = static_cast<int>(corners(f).size());
    if (count < 3 || count > 6) return false;
    OpenTriples open(count);
    if (!is_positive_within<double>(f, open) || !is_positive_within<DoubleDouble>(f, open)) return false;
    if (!is_positive_with_digits<Precise>(f, open)) return false;
    if (points_.has_offsets() && !is_positive_with_digits<MostPrecise>(f, open)) return false;
    return open.empty();
  }

  template <typename Number>
  bool is_positive_within(int f, OpenTriples& open) const {
    if (open.empty()) return true;
    std::array<PointWithin<Number>, 6> x;
    const int first = first_edge(f), count = first_edge(f + 1) - first;
    for (int k = 0; k < count; ++k) x[k] = corner_within<Number>(f, first + k);
    return open.remove_positive(
        [&](const CornerTriple& k) { return sign_within<Number>(x[k[0]], x[k[1]], x[k[2]]).value_or(0); });
  }

  template <typename Real>
  bool is_positive_with_digits(int f, OpenTriples& open) const {
    if (open.empty()) return true;
    std::array<DigitPoint<Real>, 6> x;
    const int first = first_edge(f), count = first_edge(f + 1) - first;
    for (int k = 0; k < count; ++k) x[k] = corner_with_digits<Real>(f, first + k);
    return open.remove_positive(
        [&](const CornerTriple& k) { return sign_with_digits<Real>(x[k[0]], x[k[1]], x[k[2]]); });
  }

  template <typename Real>
  DigitPoint<Real> corner_with_digits(int f, int k) const {
    const PlaceInParent &on_a = place(0, k), &on_b = place(1, k);
    if (on_a.corner >= 0) return points_.with_digits<Real>(corner_of_parent(0, f, on_a.corner));
    if (on_b.corner >= 0) return points_.with_digits<Real>(corner_of_parent(1, f, on_b.corner));
    if (on_a.edge < 0 || on_b.edge < 0) return {Vector3Of<Real>::Zero(), 1};
    return points_.crossing<Real>(edge_of_parent(0, f, on_a.edge), edge_of_parent(1, f, on_b.edge));
  }

  template <typename Number>
  PointWithin<Number> site_within(const MovedSite& at) const {
    if constexpr (std::is_same_v<Number, double>)
      return points_.near(at);
    else
      return points_.nearer(at);
  }

  template <typename Number>
  PointWithin<Number> corner_within(int f, int k) const {
    const PlaceInParent &on_a = place(0, k), &on_b = place(1, k);
    if (on_a.corner >= 0) return site_within<Number>(corner_of_parent(0, f, on_a.corner));
    if (on_b.corner >= 0) return site_within<Number>(corner_of_parent(1, f, on_b.corner));
    if (on_a.edge < 0 || on_b.edge < 0) return {Vector3Of<Number>::Zero(), 1};
    return crossing_within<Number>(edge_of_parent(0, f, on_a.edge), edge_of_parent(1, f, on_b.edge));
  }

  // A crossing is a + s (b - a) with s = det[a c d]/(det[a c d] - det[b c d]): it is off by the error of s
  // along the edge.
  template <typename Number>
  PointWithin<Number> crossing_within(const std::array<MovedSite, 2>& edge,
                                      const std::array<MovedSite, 2>& line) const {
    constexpr double unit = rounding_of<Number>;
    const PointWithin<Number> a = site_within<Number>(edge[0]), b = site_within<Number>(edge[1]),
                              c = site_within<Number>(line[0]), d = site_within<Number>(line[1]);
    const DeterminantWithin<Number> of_a = determinant_of<Number>(a, c, d),
                                    of_b = determinant_of<Number>(b, c, d);
    const Number sum = of_a.value - of_b.value;
    const Vector3Of<Number> along = b.x - a.x;
    const double error = of_a.error + of_b.error, length = largest_coordinate(in_doubles(along)),
                 size = std::max(largest_coordinate(in_doubles(a.x)), largest_coordinate(in_doubles(b.x)));
    if (!(2 * error < std::abs(in_doubles(sum)))) return {a.x, length + a.error + b.error};
    const double off = 4 * error / std::abs(in_doubles(sum)) + 8 * unit;
    return {a.x + Number(of_a.value / sum) * along, length * off + a.error + b.error + 4 * unit * size};
  }

  // -- Neighbours --

  void examine_neighbours() {
    Findings findings("neighbours");
    for (int e = 0; e < static_cast<int>(edges_.size()); ++e) {
      const DirectedEdge& edge = edges_[e];
      if (edge.twin < 0) {
        if (!is_on_boundary(e)) findings.add("face {} ends where a surface goes on", edge.face);
      } else if (const int other = edges_[edge.twin].face; e < edge.twin && !fits(e, other)) {
        findings.add("faces {} and {} do not fit along the edge from {} to {}", edge.face, other, edge.origin,
                     edge.target);
      }
    }
    conclude(findings);
  }

  // The half-edge of the parent that edge e of the overlay lies on, or -1: its target is entry e of all
  // faces' corners, its origin the one before in the face.
  int halfedge_under(int side, int e) const {
    const int f = edges_[e].face, before = e == first_edge(f) ? first_edge(f + 1) - 1 : e - 1;
    const unsigned both = place(side, before).edges() & place(side, e).edges();
    return both == 0 ? -1 : 3 * parent(side, f) + std::countr_zero(both);
  }

  bool is_on_boundary(int e) const {
    for (int side = 0; side < 2; ++side) {
      const int h = halfedge_under(side, e);
      if (h < 0 || surface(side).opposite[h] >= 0) return false;
    }
    return true;
  }

  bool fits(int e, int other) {
    const std::array<int, 2> crossed = {halfedge_under(0, e), halfedge_under(1, e)};
    if (crossed[0] < 0 && crossed[1] < 0) return false;
    for (int side = 0; side < 2; ++side) {
      const int h = crossed[side], o = h < 0 ? -1 : surface(side).opposite[h];
      if (h >= 0 && o < 0) return false;
      if (parent(side, other) != (h < 0 ? parent(side, edges_[e].face) : o / 3)) return false;
    }
    return element_beyond(e) == element(other);
  }

  // -- Positions and areas --

  // The coordinates of a vertex of the overlay in the parent of a face, from those in another triangle.
  std::optional<Vector3> coordinates_in(int side, int f, int v) const {
    const int stored = places(side).triangle[v];
    const Vector3 there = places(side).barycentric.row(v);
    if (stored == parent(side, f)) return there;
    Vector3 here = Vector3::Zero();
    for (int k = 0; k < 3; ++k) {
      if (there[k] == 0) continue;
      const int h = surface(side).corner_at(parent(side, f), surface(side).vertex_of(3 * stored + k));
      if (h < 0) return std::nullopt;
      here[h % 3] = there[k];
    }
    return here;
  }

  // An image on the target up to its length, and by how much the rounding of coordinates may move it: in
  // triangles of the size of a hemisphere they cancel. Two doubles: what moves a point far out in the
  // hyperbolic plane has entries as large as the square of its distance, which doubles would round.
  std::optional<NearerPoint> point_of(int side, int f, int v) const {
    const std::optional<Vector3> coordinates = coordinates_in(side, f, v);
    if (!coordinates || !coordinates->allFinite() || coordinates->minCoeff() < 0 ||
        std::abs(coordinates->sum() - 1) > 1e-9)
      return std::nullopt;
    NearerPoint result = {Vector3Of<DoubleDouble>::Zero(), 0};
    for (int k = 0; k < 3; ++k)
      if (const double weight = (*coordinates)[k]; weight != 0)
        result.x += DoubleDouble(weight) * points_.nearer(corner_of_parent(side, f, k)).x;
    const double length = std::sqrt(std::abs(in_doubles(embeddings_[0]->space().form(result.x, result.x))));
    result.x *= DoubleDouble(1 / length);
    result.error = 1e-14 / std::min(1.0, length);
    return result;
  }

  // The chord between two points, which no isometry changes.
  double chord_between(const Vector3Of<DoubleDouble>& p, const Vector3Of<DoubleDouble>& q) const {
    const Vector3Of<DoubleDouble> d = p - q;
    return std::sqrt(std::abs(in_doubles(embeddings_[0]->space().squared_norm(d))));
  }

  void examine_positions() {
    Findings findings("positions");
    const std::vector<int> wrong =
        parallel_select(face_count(), [&](int f) { return wrongly_placed_corner(f) >= 0; });
    for (const int f : wrong)
      findings.add("vertex {} has different images on the target from A and from B",
                   wrongly_placed_corner(f));
    conclude(findings);
  }

  // -1 for none. Lengths in the plane have no scale of their own.
  int wrongly_placed_corner(int f) const {
    constexpr double bound = 1e-9;
    const bool is_flat = embeddings_[0]->space().curvature() == 0;
    for (const int v : corners(f)) {
      const std::optional<NearerPoint> on_a = point_of(0, f, v), on_b = point_of(1, f, v);
      if (!on_a || !on_b) return v;
      const double scale = is_flat ? std::max(1.0, in_doubles(on_a->x).norm()) : 1.0;
      if (!(chord_between(on_a->x, on_b->x) <= bound * scale + on_a->error + on_b->error)) return v;
    }
    return -1;
  }

  void examine_shares(int side, const char* name) {
    constexpr double bound = 1e-9;
    std::vector<double> sum(surface(side).triangle_count(), 0.0);
    for (int f = 0; f < face_count(); ++f) sum[parent(side, f)] += share_of(side, f);
    Findings findings(name);
    for (int t = 0; t < static_cast<int>(sum.size()); ++t) {
      const double off = std::abs(sum[t] - 1);
      result_.max_share_error = std::max(result_.max_share_error, off);
      if (!(off <= bound))
        findings.add("the faces in triangle {} of {} have {} of its area", t, side == 0 ? "A" : "B", sum[t]);
    }
    conclude(findings);
  }

  // The area of the face over that of its parent: barycentric coordinates are affine.
  double share_of(int side, int f) const {
    double share = 0;
    std::array<Vector3, 3> x;
    for (std::size_t k = 0; k < corners(f).size(); ++k) {
      const std::optional<Vector3> at = coordinates_in(side, f, corners(f)[k]);
      if (!at) return std::numeric_limits<double>::quiet_NaN();
      x[std::min<std::size_t>(k, 2)] = *at;
      if (k < 2) continue;
      share += x[0].dot(x[1].cross(x[2]));
      x[1] = x[2];
    }
    return share;
  }

  // Far out in the hyperbolic plane doubles do not place the corners of a face well enough.
  double area_on_target(int f) const {
    constexpr double precise_enough = 1e-13;
    const int begin = first_edge(f), end = first_edge(f + 1);
    bool is_precise = true;
    for (int k = begin; k < end && is_precise; ++k) {
      const NearPoint at = corner_within<double>(f, k);
      is_precise = at.error * largest_coordinate(at.x) < precise_enough;
    }
    return is_precise ? area_of_face<double>(f) : area_of_face<DoubleDouble>(f);
  }

  template <typename Number>
  double area_of_face(int f) const {
    const Space space = embeddings_[0]->space();
    const auto at = [&](int k) -> Vector3Of<Number> {
      const Vector3Of<Number> x = corner_within<Number>(f, k).x;
      return x * Number(1 / std::sqrt(std::abs(in_doubles(space.form(x, x)))));
    };
    const int begin = first_edge(f);
    const Vector3Of<Number> first = at(begin);
    const Vector3 corner = in_doubles(first);
    Vector3 last = in_doubles(Vector3Of<Number>(at(begin + 1) - first));
    double area = 0;
    for (int k = begin + 2; k < first_edge(f + 1); ++k) {
      const Vector3 next = in_doubles(Vector3Of<Number>(at(k) - first));
      area +=
          visit_curvature(space, [&](auto curvature) { return area_between(curvature, corner, last, next); });
      last = next;
    }
    return area;
  }

  void examine_area() {
    constexpr double bound = 1e-8;
    const double area = parallel_sum(face_count(), [&](int f) { return area_on_target(f); });
    const Embedding& a = *embeddings_[0];
    const double expected = parallel_sum(surface(0).triangle_count(), [&](int t) {
      const auto corner = [&](int k) { return Vector3(a.positions.row(a.triangles(t, k))); };
      return a.space().area(corner(0), corner(1), corner(2));
    });
    const double off = std::abs(area - expected) / expected;
    result_.checks.push_back(
        {"target_area", off <= bound, off, bound,
         off <= bound
             ? std::string()
             : fmt::format("the faces have the area {} on the target, and A has {}", area, expected)});
  }

  const Overlay& overlay_;
  std::array<const Embedding*, 2> embeddings_;
  ElementTable elements_;
  SharedGroup group_;
  std::array<DevelopedSurface, 2> surfaces_;
  PointSource points_;
  std::vector<int> element_of_;  // of faces
  std::array<std::vector<PlaceInParent>, 2> places_in_parents_;
  std::vector<DirectedEdge> edges_;

  // One whose ends another edge has in the same direction; -1 for none.
  int repeated_edge_ = -1;
  OverlayCertificate result_;
};

// The overlay of the parts is what is proved; the other one names the same vertices and faces.
OverlayCertificate certify_of_parts(const Overlay& overlay, const DividedEars& a, const DividedEars& b) {
  OverlayCertificate result;
  Findings findings("ears");
  if (!overlay.of_parts)
    findings.add("the overlay does not say how triangles that are flat on the target are divided");
  else
    result = OverlayExaminer(*overlay.of_parts, a.parts(), b.parts()).run();
  // What names vertices and triangles that do not exist cannot be joined.
  if (!result.checks.empty() && result.checks.front().passed &&
      !say_the_same(overlay, joined_overlay(*overlay.of_parts, a, b)))
    findings.add("the overlay is not that of the divided triangles");
  result.checks.push_back(findings.check());
  result.holds = result.holds && result.checks.back().passed;
  return result;
}

}  // namespace

OverlayCertificate certify(const Overlay& overlay, const Embedding& a, const Embedding& b) {
  try {
    const DividedEars of_a(a), of_b(b);
    if (!of_a.any() && !of_b.any()) return OverlayExaminer(overlay, a, b).run();
    return certify_of_parts(overlay, of_a, of_b);
  } catch (const Error& error) {
    OverlayCertificate result;
    result.checks.push_back({"embeddings", false, 0, 0, error.what()});
    return result;
  }
}

}  // namespace orbitutte
