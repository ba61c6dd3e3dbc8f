// SPDX-License-Identifier: MIT
#include "orbitutte/map/surface_pair.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>

#include "orbitutte/geometry/precise_isometry.h"
#include "orbitutte/mesh/connectivity.h"

namespace orbitutte {
namespace {

using Kind = Place::Kind;

bool has_offsets(const Embedding& embedding) { return !embedding.offsets.empty(); }

void require_partners(const Embedding& a, const Embedding& b) {
  if (a.target.signature != b.target.signature)
    throw ArgumentError(fmt::format("the embeddings are into different targets, {} and {}",
                                    a.target.signature, b.target.signature));
  if (a.target.topology != Topology::sphere && a.target.topology != Topology::disk)
    throw ArgumentError("maps between surfaces need spheres or disks");
  if (a.cones.size() != b.cones.size())
    throw ArgumentError(fmt::format("one embedding has {} marked vertices, the other has {}", a.cones.size(),
                                    b.cones.size()));
}

bool is_inside(const ConeCopies& cone) { return cone.mark.kind == ConeKind::rotation; }

// A copy of a mark on either surface, and the element of the canonical frame that takes one to the other.
struct MeetingCopies {
  int walked = -1, walker = -1;
  Isometry element;
};

// Finds copies of marks that an element brings together.
class CopyMatcher {
 public:
  CopyMatcher(const Embedding& walked, const Embedding& walker)
      : walked_(walked),
        walker_(walker),
        on_walked_(walked.canonical_positions()),
        on_walker_(walker.canonical_positions()) {}

  std::optional<MeetingCopies> find(const std::vector<Isometry>& elements) const {
    const std::vector<ConeCopies>& cones = walked_.cones;
    const auto inside = std::find_if(cones.begin(), cones.end(), is_inside);
    const std::size_t first = inside == cones.end() ? 0 : static_cast<std::size_t>(inside - cones.begin());
    for (const Isometry& element : elements) {
      std::optional<MeetingCopies> found = meeting(first, element);
      if (found && (inside != cones.end() || all_meet(element))) return found;
    }
    return std::nullopt;
  }

 private:
  bool all_meet(const Isometry& element) const {
    for (std::size_t k = 0; k < walked_.cones.size(); ++k)
      if (!meeting(k, element)) return false;
    return true;
  }

  std::optional<MeetingCopies> meeting(std::size_t mark, const Isometry& element) const {
    constexpr double tolerance = 1e-6;
    for (const int a : walked_.cones[mark].copies) {
      for (const int b : walker_.cones[mark].copies) {
        const Vector3 x = on_walked_.row(a), y = element * Vector3(on_walker_.row(b));
        if ((x - y).cwiseAbs().maxCoeff() <= tolerance * std::max(1.0, x.cwiseAbs().maxCoeff()))
          return MeetingCopies{a, b, element};
      }
    }
    return std::nullopt;
  }

  const Embedding& walked_;
  const Embedding& walker_;
  Points on_walked_, on_walker_;
};

// The middle one of those that begin at a copy.
int halfedge_from_site(const DevelopedSurface& surface, int site) {
  const auto is_there = [&](int h) { return h >= 0 && surface.site_of(h) == site; };
  int first = 0;
  const int halfedges = static_cast<int>(surface.triangles.size());
  while (first < halfedges && !is_there(first)) ++first;
  if (first == halfedges)
    throw ArgumentError(fmt::format("no triangle uses the marked vertex {}", surface.source_vertex[site]));
  const auto clockwise = [&](int h) {
    const int o = surface.opposite[h];
    return o < 0 || surface.beyond[h] != ElementTable::identity ? -1 : next_halfedge(o);
  };
  const auto counterclockwise = [&](int h) {
    const int back = previous_halfedge(h);
    return surface.beyond[back] != ElementTable::identity ? -1 : surface.opposite[back];
  };
  int h = first;
  for (int next = clockwise(h); is_there(next) && next != first; next = clockwise(h)) h = next;
  std::vector<int> around = {h};
  for (int next = counterclockwise(h); is_there(next) && next != around.front();
       next = counterclockwise(around.back()))
    around.push_back(next);
  return around[around.size() / 2];
}

// A vertex that is not on the boundary, if there is one.
int some_halfedge(const DevelopedSurface& surface) {
  for (const int h : surface.first_halfedge)
    if (h >= 0 && surface.opposite[h] >= 0) return h;
  return 0;
}

// Walks along the edges of one surface, from one vertex to the next.
class Expedition {
 public:
  Expedition(SurfacePair& pair, const SurfacePair::Visit& visit)
      : pair_(pair),
        walker_(pair.walker()),
        visit_(visit),
        fixes_(walker_.vertex_count()),
        is_done_(walker_.edge_count(), 0) {}

  std::vector<Fix> run(const Fix& start) {
    arrive(walker_.vertex_of(start.halfedge), start);
    for (std::size_t k = 0; k < reached_.size(); ++k) leave(reached_[k]);
    return std::move(fixes_);
  }

 private:
  // Counterclockwise around the vertex, and, on a boundary, the other way then.
  void leave(int vertex) {
    const Fix fix = fixes_[vertex];
    Fix at = fix;
    do {
      leave_along(at);
      const int back = previous_halfedge(at.halfedge), o = walker_.opposite[back];
      if (o < 0) {
        leave_against({back, at.place});
        leave_clockwise(fix);
        return;
      }
      at = {o, at.place};
      at.place.element = pair_.elements().product(at.place.element, walker_.beyond[back]);
    } while (at.halfedge != fix.halfedge);
  }

  void leave_clockwise(Fix at) {
    for (int o = walker_.opposite[at.halfedge]; o >= 0; o = walker_.opposite[at.halfedge]) {
      at.place.element = pair_.elements().product(at.place.element, walker_.beyond[at.halfedge]);
      at.halfedge = next_halfedge(o);
      leave_along(at);
    }
  }

  // Is there nothing to be found out along a half-edge to a vertex?
  bool is_known(int halfedge, int vertex) {
    char& is_done = is_done_[walker_.edge[halfedge]];
    if (is_done || (!visit_ && fixes_[vertex].halfedge >= 0)) return true;
    is_done = 1;
    return false;
  }

  // Also an edge that is known turns the place, so that directions follow each other by less than pi: around
  // a cone it does not depend on them alone how far to turn.
  void leave_along(Fix& at) {
    const int h = at.halfedge, next = next_halfedge(h), goal = walker_.vertex_of(next);
    const Course course = {walker_.site_of(h), walker_.site_of(next)};
    if (is_known(h, goal)) {
      pair_.tracer().turn(course, at.place);
      return;
    }
    pair_.tracer().trace(course, at.place, walk_);
    arrive(goal, seen_from_goal(h, walk_.stops.back()));
    if (visit_) visit_(h, walk_);
  }

  // At the target of a half-edge that a walk has come along: the half-edge that leads back, in the angle at
  // which the place is; on a boundary the next one.
  Fix seen_from_goal(int h, Place place) {
    const int o = walker_.opposite[h];
    if (o < 0) return {next_halfedge(h), place};
    place.element = pair_.elements().product(place.element, walker_.beyond[h]);
    return {o, place};
  }

  // From the end of a half-edge to its beginning.
  void leave_against(Fix at) {
    const int h = at.halfedge, next = next_halfedge(h), goal = walker_.vertex_of(h);
    if (is_known(h, goal)) return;
    pair_.tracer().trace({walker_.site_of(next), walker_.site_of(h)}, at.place, walk_);
    arrive(goal, {h, walk_.stops.back()});
    walk_.reverse();
    if (visit_) visit_(h, walk_);
  }

  void arrive(int vertex, const Fix& fix) {
    require_partner(vertex, fix.place);
    if (fixes_[vertex].halfedge >= 0) return;
    fixes_[vertex] = fix;
    reached_.push_back(vertex);
  }

  void require_partner(int vertex, const Place& place) const {
    const int partner = pair_.partners()[vertex];
    if (partner < 0) return;
    if (place.kind == Kind::at_vertex && pair_.walked().vertex_of(place.halfedge) == partner) return;
    throw ArgumentError(fmt::format(
        "the embeddings do not lie on the same tile: the marked vertex {} of one does not come to lie on the "
        "marked vertex {} of the other",
        vertex, partner));
  }

  SurfacePair& pair_;
  const DevelopedSurface& walker_;
  const SurfacePair::Visit& visit_;
  std::vector<Fix> fixes_;
  std::vector<char> is_done_;
  std::vector<int> reached_;
  Walk walk_;
};

}  // namespace

SurfacePair::SurfacePair(const Embedding& walked, const Embedding& walker)
    : elements_((require_partners(walked, walker), walked.space())),
      group_(walked, walker),
      walked_(developed_surface(walked, group_, elements_, "one surface")),
      walker_(developed_surface(walker, group_, elements_, "the other surface")),
      signs_(elements_),
      tracer_(walked_, walker_.sites, signs_, elements_) {
  if (has_offsets(walked) || has_offsets(walker)) signs_.use_all_digits();
  find_partners(walked, walker);
  start_ = start(walked, walker);
}

void SurfacePair::find_partners(const Embedding& walked, const Embedding& walker) {
  partner_.assign(walker_.vertex_count(), -1);
  for (std::size_t k = 0; k < walked.cones.size(); ++k)
    partner_[walker.cones[k].vertex] = walked.cones[k].vertex;
}

// At a mark inside the surface, where any element that brings copies together does: the walks turn around it
// until they find their directions. If there are marks on the boundary alone, all of them meet. Without marks
// a triangle is searched that holds some vertex.
Fix SurfacePair::start(const Embedding& walked, const Embedding& walker) {
  const Matrix3Of<MostPrecise> out = exact_isometry(walked.space(), walked.placement),
                               in = precise_inverse(walked.space(),
                                                    exact_isometry(walked.space(), walker.placement));
  if (walked.cones.empty()) {
    const int h = some_halfedge(walker_), element = elements_.add(out * in);
    Fix fix = {h, {}};
    for (int t = 0; t < walked_.triangle_count(); ++t)
      if (tracer_.holds(t, element, walker_.site_of(h), fix.place)) return fix;
    throw ArgumentError("the surfaces do not cover the same part of the target");
  }
  const std::optional<MeetingCopies> copies = CopyMatcher(walked, walker).find(group_.elements_near(walked));
  if (!copies)
    throw ArgumentError("the embeddings do not lie on the same tile: no copies of their marks meet");
  const int element = elements_.add(out * group_.element(copies->element) * in);
  require_same_point(copies->walked, copies->walker, element);
  const int h = halfedge_from_site(walker_, copies->walker);
  Fix fix = {h, {Kind::at_vertex, halfedge_from_site(walked_, copies->walked), element}};
  tracer_.turn_least({walker_.site_of(h), walker_.site_of(next_halfedge(h))}, fix.place);
  return fix;
}

void SurfacePair::require_same_point(int walked_site, int walker_site, int element) const {
  const Vector3Of<Precise> here = walked_.sites.precise(walked_site),
                           there = elements_.precise(element) * walker_.sites.precise(walker_site);
  const double size = std::max(1.0, here.cast<double>().cwiseAbs().maxCoeff());
  for (int i = 0; i < 3; ++i)
    if (abs(Precise(here[i] - there[i])) > ldexp(Precise(size), -200))
      throw ArgumentError(fmt::format(
          "the embeddings do not lie on the same tile: the images of the marked vertices {} and {} differ",
          walked_.source_vertex[walked_site], walker_.source_vertex[walker_site]));
}

std::vector<Fix> SurfacePair::trace_edges(const Visit& visit) { return Expedition(*this, visit).run(start_); }

std::vector<Fix> SurfacePair::locate_vertices() {
  const Visit none;
  return Expedition(*this, none).run(start_);
}

Vector3 SurfacePair::coordinates(const Place& place, int site) const {
  const int first = 3 * place.triangle(), k = place.halfedge - first;
  Vector3 result = Vector3::Unit(k);
  if (place.kind == Kind::at_vertex) return result;
  const auto corner = [&](int h) { return signs_.placed(walked_.sites, walked_.site_of(h)); };
  result = signs_.coordinates({corner(first), corner(first + 1), corner(first + 2)},
                              signs_.placed(walker_.sites, site, place.element));
  if (place.kind == Kind::inside) return result;
  result[(k + 2) % 3] = 0;
  return result / result.sum();
}

}  // namespace orbitutte
