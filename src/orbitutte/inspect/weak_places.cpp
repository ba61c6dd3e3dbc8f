// SPDX-License-Identifier: MIT
#include "orbitutte/inspect/weak_places.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <set>

#include "orbitutte/inspect/contacts.h"

namespace orbitutte {
namespace {

// Counts the places of one kind and keeps the sentence about the first.
class PlacesOfKind {
 public:
  explicit PlacesOfKind(WeakPlaceKind kind) : kind_(kind) {}

  template <typename... Arguments>
  void add(fmt::format_string<Arguments...> text, Arguments&&... arguments) {
    if (count_++ == 0) first_ = fmt::format(text, std::forward<Arguments>(arguments)...);
  }

  void append_to(std::vector<WeakPlace>& list, const char* consequence) const {
    if (count_ == 0) return;
    const std::string such = count_ > 1 ? fmt::format(" ({} such places)", count_) : std::string();
    list.push_back({kind_, fmt::format("{}{}: {}", first_, such, consequence), count_});
  }

 private:
  WeakPlaceKind kind_;
  long long count_ = 0;
  std::string first_;
};

int boundary_edges(const PolygonTopology& surface, int f) {
  const auto begin = surface.twin.begin();
  return static_cast<int>(std::count(begin + surface.face_start[f], begin + surface.face_start[f + 1], -1));
}

// Has the face all edges but one on the boundary?
bool is_ear(const PolygonTopology& surface, int f) {
  return boundary_edges(surface, f) + 1 >= surface.degree(f);
}

// Its edge inside; any other if there is none.
int inner_halfedge(const PolygonTopology& surface, int f) {
  int c = surface.face_start[f];
  while (surface.twin[c] < 0 && c + 1 < surface.face_start[f + 1]) ++c;
  return c;
}

PlacesOfKind vertices_with_two_edges(const PolygonTopology& surface, const std::vector<char>& on_boundary) {
  PlacesOfKind places(WeakPlaceKind::degree_two);
  std::vector<int> corners(on_boundary.size(), 0), corner(on_boundary.size(), -1);
  for (int c = 0; c < surface.corner_count(); ++c) {
    ++corners[surface.origin[c]];
    corner[surface.origin[c]] = c;
  }
  for (int v = 0; v < static_cast<int>(corners.size()); ++v) {
    if (corners[v] != 2 || on_boundary[v]) continue;
    places.add("vertex {} has edges only to the vertices {} and {}", v,
               surface.origin[surface.previous(corner[v])], surface.target(corner[v]));
  }
  return places;
}

PlacesOfKind ears(const PolygonTopology& surface) {
  PlacesOfKind places(WeakPlaceKind::ear);
  for (int f = 0; f < surface.face_count(); ++f) {
    if (!is_ear(surface, f)) continue;
    const int c = inner_halfedge(surface, f);
    places.add("face {} has all edges but ({}, {}) on the boundary", f, surface.origin[c], surface.target(c));
  }
  return places;
}

bool is_chord(const PolygonTopology& surface, const std::vector<char>& on_boundary, int c) {
  return surface.twin[c] >= 0 && on_boundary[surface.origin[c]] && on_boundary[surface.target(c)];
}

PlacesOfKind chords(const PolygonTopology& surface, const std::vector<char>& on_boundary) {
  PlacesOfKind places(WeakPlaceKind::chord);
  for (int c = 0; c < surface.corner_count(); ++c) {
    const int d = surface.twin[c];
    if (d < c || !is_chord(surface, on_boundary, c) || is_ear(surface, surface.face_of[c]) ||
        is_ear(surface, surface.face_of[d]))
      continue;
    places.add("edge ({}, {}) leads through the inside from one vertex of the boundary to another",
               surface.origin[c], surface.target(c));
  }
  return places;
}

PlacesOfKind faces_on_the_boundary(const PolygonTopology& surface, const std::vector<char>& on_boundary) {
  PlacesOfKind places(WeakPlaceKind::boundary_face);
  for (int f = 0; f < surface.face_count(); ++f) {
    int vertices = 0;
    bool has_chord = false;
    for (int c = surface.face_start[f]; c < surface.face_start[f + 1]; ++c) {
      vertices += on_boundary[surface.origin[c]];
      has_chord = has_chord || is_chord(surface, on_boundary, c);
    }
    const int contacts = vertices - boundary_edges(surface, f);
    if (contacts > 1 && !has_chord) places.add("face {} meets the boundary in {} places", f, contacts);
  }
  return places;
}

// Is the surface a projective plane? On it, vertices that two faces share need not separate anything.
bool is_projective_plane(const PolygonTopology& surface) {
  if (std::find(surface.twin.begin(), surface.twin.end(), -1) != surface.twin.end()) return false;
  const std::set<int> vertices(surface.origin.begin(), surface.origin.end());
  return static_cast<int>(vertices.size()) - surface.corner_count() / 2 + surface.face_count() == 1;
}

PlacesOfKind double_contact_places(const PolygonTopology& surface, int vertex_count) {
  PlacesOfKind places(WeakPlaceKind::double_contact);
  for (const auto& [f, g, v, w] : double_contacts(surface, vertex_count))
    places.add("faces {} and {} share the vertices {} and {}, but no edge of both joins these", f, g, v, w);
  return places;
}

// Floods of faces across edges.
class Parts {
 public:
  explicit Parts(const FaceView& faces) : surface(topology_of(faces)), seen_(surface.face_count(), -1) {}

  // The faces that can be reached from a half-edge's without passing through the two given ones; the search
  // ends if there are more than `most`.
  std::vector<int> reached(int halfedge, const std::array<int, 2>& walls, std::size_t most) {
    ++flood_;
    std::vector<int> part;
    const auto visit = [&](int f) {
      if (f == walls[0] || f == walls[1] || seen_[f] == flood_) return;
      seen_[f] = flood_;
      part.push_back(f);
    };
    visit(surface.face_of[halfedge]);
    for (std::size_t k = 0; k < part.size() && part.size() <= most; ++k) {
      for (int c = surface.face_start[part[k]]; c < surface.face_start[part[k] + 1]; ++c)
        if (surface.twin[c] >= 0) visit(surface.face_of[surface.twin[c]]);
    }
    return part;
  }

  const PolygonTopology surface;

 private:
  std::vector<int> seen_;
  int flood_ = 0;
};

// A stretch of a mirror that a face cuts off, from one of its vertices to the next one there.
struct CutOff {
  int from, to;  // places on the mirror
  int face;
};

class Collapse {
 public:
  Collapse(const FaceView& faces, const std::vector<int>& marks)
      : parts_(faces), collapsing_(faces.count(), 0), marks_(marks) {
    for (const int v : parts_.surface.origin) vertex_count_ = std::max(vertex_count_, v + 1);
    place_.assign(vertex_count_, -1);
  }

  void onto(const std::vector<int>& mirror) {
    for (int k = static_cast<int>(mirror.size()) - 1; k >= 0; --k) place_[mirror[k]] = k;
    end_of_loop_ = mirror.front() == mirror.back() ? static_cast<int>(mirror.size()) - 1 : 0;
    const std::vector<int> halfedge = boundary_halfedges(mirror);
    int end = 0;  // of the longest stretch so far that collapsed: those within it belong to its part
    for (const CutOff& cut : cut_off_stretches()) {
      if (cut.to <= end) continue;
      if (collapse_beyond(cut, mirror, halfedge)) end = cut.to;
    }
    for (int f = 0; f < surface().face_count(); ++f)
      if (lies_on_the_mirror(f) && !spans_the_corner(f, mirror, halfedge)) collapsing_[f] = 1;
    for (const int v : mirror) place_[v] = -1;
  }

  // The smaller of the two parts beside a double contact, or both if both are small.
  void between(const DoubleContact& contact) {
    int c = surface().face_start[contact.face];
    while (surface().origin[c] != contact.vertex) ++c;
    const std::array<int, 2> beside = {surface().twin[c], surface().twin[surface().previous(c)]};
    for (std::size_t most = 64; most < 8 * collapsing_.size() + 64; most *= 8) {
      bool found = false;
      for (const int h : beside) {
        if (h < 0) continue;
        const std::vector<int> part = parts_.reached(h, {contact.face, contact.other}, most);
        if (part.size() > most) continue;
        found = true;
        if (!meets_boundary(part)) collapse(part, {contact.vertex, contact.second});
      }
      if (found) return;
    }
  }

  const PolygonTopology& surface() const { return parts_.surface; }
  int vertex_count() const { return vertex_count_; }

  std::vector<int> faces() const {
    std::vector<int> result;
    for (int f = 0; f < static_cast<int>(collapsing_.size()); ++f)
      if (collapsing_[f]) result.push_back(f);
    return result;
  }

 private:
  // Collapses the part that a stretch of a mirror cuts off. If a mark holds it, and the mirror is all of the
  // boundary, the rest collapses instead. Returns whether the part collapsed.
  bool collapse_beyond(const CutOff& cut, const std::vector<int>& mirror, const std::vector<int>& halfedge) {
    const std::array<int, 2> ends = {mirror[cut.from], mirror[cut.to]};
    std::vector<int> part;
    for (int k = cut.from; k < cut.to; ++k) {
      if (halfedge[k] < 0 || collapsing_[surface().face_of[halfedge[k]]]) continue;
      part = parts_.reached(halfedge[k], {cut.face, cut.face}, collapsing_.size());
      if (collapse(part, ends)) continue;
      if (mirror.front() == mirror.back()) {
        part.push_back(cut.face);  // where it has vertices inside, it is no arc
        std::vector<int> rest = all_but(part);
        if (lies_on_the_mirror(cut.face)) rest.push_back(cut.face);
        collapse(rest, ends);
      }
      return false;
    }
    return true;
  }

  std::vector<int> all_but(const std::vector<int>& part) const {
    std::vector<char> is_in(collapsing_.size(), 0);
    for (const int f : part) is_in[f] = 1;
    std::vector<int> rest;
    for (int f = 0; f < static_cast<int>(is_in.size()); ++f)
      if (!is_in[f]) rest.push_back(f);
    return rest;
  }

  // If no mark holds the part in its place. At its two ends marks hold nothing.
  bool collapse(const std::vector<int>& part, const std::array<int, 2>& ends) {
    const auto holds = [&](int v) { return v != ends[0] && v != ends[1] && is_marked(v); };
    if (any_vertex(part, holds)) return false;
    for (const int f : part) collapsing_[f] = 1;
    return true;
  }

  template <typename Test>
  bool any_vertex(const std::vector<int>& part, const Test& test) const {
    for (const int f : part)
      for (int c = surface().face_start[f]; c < surface().face_start[f + 1]; ++c)
        if (test(surface().origin[c])) return true;
    return false;
  }

  bool is_marked(int v) const { return std::find(marks_.begin(), marks_.end(), v) != marks_.end(); }

  bool meets_boundary(const std::vector<int>& part) const {
    return std::any_of(part.begin(), part.end(), [&](int f) { return boundary_edges(surface(), f) > 0; });
  }

  bool lies_on_the_mirror(int f) const {
    const auto begin = surface().origin.begin();
    return std::all_of(begin + surface().face_start[f], begin + surface().face_start[f + 1],
                       [&](int v) { return place_[v] >= 0; });
  }

  // A loop from a marked corner to itself bends there. Does the corner lie between the vertices of a face,
  // and not with all other marks beyond it? Stretches have told of faces at the corner.
  bool spans_the_corner(int f, const std::vector<int>& mirror, const std::vector<int>& halfedge) {
    const int corner = mirror.front();
    if (end_of_loop_ == 0 || !is_marked(corner)) return false;
    int first = end_of_loop_, last = 0;
    for (int c = surface().face_start[f]; c < surface().face_start[f + 1]; ++c) {
      first = std::min(first, place_[surface().origin[c]]);
      last = std::max(last, place_[surface().origin[c]]);
    }
    if (first == 0) return true;
    const std::vector<int> beyond = parts_.reached(halfedge[last], {f, f}, collapsing_.size());
    return !any_vertex(beyond, [&](int v) { return v != corner && is_marked(v); });
  }

  // For every place but the last, the half-edge to the next one.
  std::vector<int> boundary_halfedges(const std::vector<int>& mirror) const {
    std::vector<int> result(mirror.size(), -1);
    for (int c = 0; c < surface().corner_count(); ++c)
      if (surface().twin[c] < 0 && place_[surface().origin[c]] >= 0) result[place_[surface().origin[c]]] = c;
    return result;
  }

  // By their beginnings, the longest first.
  std::vector<CutOff> cut_off_stretches() const {
    std::vector<CutOff> result;
    for (int f = 0; f < surface().face_count(); ++f) {
      int first = -1, last = -1;
      for (int c = surface().face_start[f]; c < surface().face_start[f + 1]; ++c) {
        const int place = place_[surface().origin[c]];
        if (place < 0) continue;
        if (last >= 0) add_stretch(last, c, result);
        if (first < 0) first = c;
        last = c;
      }
      if (first != last) add_stretch(last, first, result);
    }
    std::sort(result.begin(), result.end(), [](const CutOff& a, const CutOff& b) {
      return a.from != b.from ? a.from < b.from : a.to > b.to;
    });
    return result;
  }

  // Between two corners of one face that follow each other on the mirror, unless an edge of the boundary
  // joins them.
  void add_stretch(int c, int d, std::vector<CutOff>& stretches) const {
    const int from = place_[surface().origin[c]], place = place_[surface().origin[d]];
    const int to = place == 0 ? end_of_loop_ : place;
    const auto joins = [&](int a, int b) { return surface().next(a) == b && surface().twin[a] < 0; };
    if (from < to && !joins(c, d) && !joins(d, c)) stretches.push_back({from, to, surface().face_of[c]});
  }

  Parts parts_;
  std::vector<char> collapsing_;
  const std::vector<int>& marks_;
  std::vector<int> place_;  // of every vertex on the present mirror; -1 elsewhere
  int end_of_loop_ = 0;     // the other place of its first vertex, if the mirror is a loop
  int vertex_count_ = 0;
};

}  // namespace

std::vector<WeakPlace> find_weak_places(int vertex_count, const FaceView& faces) {
  const PolygonTopology surface = topology_of(faces);
  const std::vector<char> on_boundary = boundary_vertices(surface, vertex_count);
  std::vector<WeakPlace> places;
  vertices_with_two_edges(surface, on_boundary)
      .append_to(places, "it comes to lie straight between them, unless it is marked");
  ears(surface).append_to(places, "it becomes an arc, unless a vertex between the others is marked");
  chords(surface, on_boundary)
      .append_to(places, "what it cuts off becomes an arc, unless a vertex there is marked");
  faces_on_the_boundary(surface, on_boundary)
      .append_to(places, "what it cuts off becomes an arc, unless a vertex there is marked");
  // Two triangles share the edge between two vertices.
  const bool may_touch_twice = surface.corner_count() != 3 * surface.face_count();
  if (may_touch_twice && !is_projective_plane(surface))
    double_contact_places(surface, vertex_count)
        .append_to(places, "what they enclose becomes an arc, unless a vertex there is marked");
  return places;
}

std::vector<WeakPlace> find_weak_places(const PolygonMesh& mesh) {
  return find_weak_places(mesh.vertex_count(), FaceView(mesh.corners, mesh.face_start));
}

std::vector<int> collapsing_faces(const FaceView& faces, const std::vector<std::vector<int>>& mirrors,
                                  const std::vector<int>& marks) {
  Collapse collapse(faces, marks);
  for (const std::vector<int>& mirror : mirrors) collapse.onto(mirror);
  if (is_projective_plane(collapse.surface())) return {};
  for (const DoubleContact& contact : double_contacts(collapse.surface(), collapse.vertex_count()))
    collapse.between(contact);
  return collapse.faces();
}

}  // namespace orbitutte
