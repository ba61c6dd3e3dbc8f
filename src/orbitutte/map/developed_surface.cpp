// SPDX-License-Identifier: MIT
#include "orbitutte/map/developed_surface.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <unordered_map>
#include <utility>

#include "orbitutte/geometry/precise_isometry.h"
#include "orbitutte/mesh/connectivity.h"
#include "orbitutte/orbifold/exact_positions.h"
#include "orbitutte/parallel.h"

namespace orbitutte {
namespace {

using ExactPoint = Vector3Of<MostPrecise>;

std::uint64_t key_of_pair(int from, int to) {
  return static_cast<std::uint64_t>(static_cast<std::uint32_t>(from)) << 32 | static_cast<std::uint32_t>(to);
}

// Half-edges by their ends, ordered.
class HalfedgeList {
 public:
  explicit HalfedgeList(const Triangles& F) : entries_(static_cast<std::size_t>(F.size())) {
    for (int h = 0; h < static_cast<int>(F.size()); ++h)
      entries_[h] = {key_of_pair(halfedge_origin(F, h), halfedge_target(F, h)), h};
    std::sort(entries_.begin(), entries_.end());
  }

  // The half-edge from one cut vertex to another, or -1.
  int find(int from, int to) const {
    const auto at = std::lower_bound(entries_.begin(), entries_.end(), std::pair(key_of_pair(from, to), -1));
    return at != entries_.end() && at->first == key_of_pair(from, to) ? at->second : -1;
  }

 private:
  std::vector<std::pair<std::uint64_t, int>> entries_;
};

// Makes a DevelopedSurface.
class Development {
 public:
  Development(const Embedding& embedding, const SharedGroup& group, ElementTable& elements, std::string name)
      : embedding_(embedding),
        group_(group),
        elements_(elements),
        name_(std::move(name)),
        positions_(embedding),
        out_(exact_isometry(embedding.space(), embedding.placement)),
        result_{embedding.triangles,       embedding.source_vertex, {}, {}, {}, {}, {},
                Sites(embedding.positions)} {}

  DevelopedSurface run() {
    join_inside();
    join_seams();
    number_edges();
    find_vertices();
    place_offsets();
    place_copies();
    require_positive();
    return std::move(result_);
  }

 private:
  int halfedge_count() const { return static_cast<int>(result_.triangles.size()); }

  void join_inside() {
    const Triangles& F = result_.triangles;
    const HalfedgeList list(F);
    result_.opposite.assign(halfedge_count(), -1);
    result_.beyond.assign(halfedge_count(), ElementTable::identity);
    parallel_ranges(halfedge_count(), [&](int begin, int end) {
      for (int h = begin; h < end; ++h)
        result_.opposite[h] = list.find(halfedge_target(F, h), halfedge_origin(F, h));
    });
    for (int h = 0; h < halfedge_count(); ++h)
      if (result_.opposite[h] < 0)
        on_boundary_[ascending_key(halfedge_origin(F, h), halfedge_target(F, h))] = h;
  }

  static std::uint64_t ascending_key(int a, int b) { return key_of_pair(std::min(a, b), std::max(a, b)); }

  int boundary_halfedge(int a, int b) const {
    const auto at = on_boundary_.find(ascending_key(a, b));
    if (at == on_boundary_.end())
      throw ArgumentError(fmt::format("a seam of {} leaves the boundary of its cut mesh", name_));
    return at->second;
  }

  // The element of a seam, in the frame of the positions.
  int element_of(const Seam& seam) {
    const Isometry& placement = embedding_.placement;
    const Matrix3Of<MostPrecise> element = group_.element(placement.inverse() * seam.transform * placement);
    if (placement.is_identity()) return elements_.add(element);
    return elements_.add(out_ * element * precise_inverse(embedding_.space(), out_));
  }

  void join_seams() {
    for (const Seam& seam : embedding_.seams) {
      const bool is_mirror = seam.is_mirror();
      if (!is_mirror && seam.transform.reverses_orientation())
        throw ArgumentError(fmt::format(
            "{} is glued by a rotary reflection; maps between surfaces need spheres or disks", name_));
      const int element = element_of(seam), inverse = elements_.inverse(element);
      for (std::size_t k = 1; k < seam.left.size(); ++k) {
        const int left = boundary_halfedge(seam.left[k - 1], seam.left[k]);
        if (is_mirror) {
          mirror_[left] = element;
          continue;
        }
        const int right = boundary_halfedge(seam.right[k - 1], seam.right[k]);
        result_.opposite[left] = right;
        result_.opposite[right] = left;
        result_.beyond[left] = element;
        result_.beyond[right] = inverse;
      }
    }
    for (const auto& [ends, h] : on_boundary_)
      if (result_.opposite[h] < 0 && !mirror_.contains(h))
        throw ArgumentError(fmt::format(
            "{} has a boundary that is held; maps between surfaces need seams and mirrors", name_));
  }

  void number_edges() {
    result_.edge.resize(halfedge_count());
    for (int h = 0; h < halfedge_count(); ++h) {
      const int o = result_.opposite[h];
      if (o >= 0 && o < h) {
        result_.edge[h] = result_.edge[o];
        continue;
      }
      result_.edge[h] = result_.edge_count();
      result_.reference.push_back(h);
    }
  }

  void find_vertices() {
    int vertices = 0;
    for (const int v : result_.source_vertex) vertices = std::max(vertices, v + 1);
    result_.first_halfedge.assign(vertices, -1);
    for (int h = 0; h < halfedge_count(); ++h) {
      int& first = result_.first_halfedge[result_.vertex_of(h)];
      if (first < 0 || result_.opposite[h] < 0) first = h;
    }
  }

  void place_offsets() {
    if (!positions_.has_offsets()) return;
    for (int c = 0; c < result_.sites.count(); ++c)
      if (positions_.has_offsets(c)) result_.sites.set_exact(c, positions_.exact(c));
  }

  // Vertices where more meets than triangles of one piece.
  void place_copies() {
    std::vector<int> vertices;
    for (const auto& [ends, h] : on_boundary_) {
      vertices.push_back(result_.vertex_of(h));
      vertices.push_back(result_.vertex_of(next_halfedge(h)));
    }
    std::sort(vertices.begin(), vertices.end());
    vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
    for (const int v : vertices) place_copies_of(v);
  }

  // A corner at a vertex, and the element that takes the vertex from the first corner to this one.
  struct Corner {
    int halfedge;
    int element;
  };

  // Around the vertex, counterclockwise; the last one is the first again where there is no boundary.
  std::vector<Corner> corners_around(int v) {
    const int first = result_.first_halfedge[v];
    std::vector<Corner> corners = {{first, ElementTable::identity}};
    while (corners.size() <= static_cast<std::size_t>(halfedge_count())) {
      const int back = previous_halfedge(corners.back().halfedge), o = result_.opposite[back];
      if (o < 0) return corners;
      const int element = elements_.product(elements_.inverse(result_.beyond[back]), corners.back().element);
      corners.push_back({o, element});
      if (o == first) return corners;
    }
    throw ArgumentError(fmt::format("the triangles of {} around vertex {} do not close", name_, v));
  }

  void place_copies_of(int v) {
    const std::vector<Corner> corners = corners_around(v);
    const bool is_inside = result_.opposite[corners.front().halfedge] >= 0;
    const ExactPoint here = positions_.exact(result_.site_of(corners.front().halfedge));
    const ExactPoint place =
        is_inside ? held_by(corners.back().element, here) : on_mirrors(corners.front(), corners.back(), here);
    for (const Corner& corner : corners) place_copy(v, corner, place);
  }

  void place_copy(int v, const Corner& corner, const ExactPoint& place) {
    const int site = result_.site_of(corner.halfedge);
    const ExactPoint position = elements_.exact(corner.element) * place;
    const Vector3 rough = position.cast<double>(), stored = positions_.rounded(site);
    constexpr double tolerance = 1e-5;
    if (!((rough - stored).cwiseAbs().maxCoeff() <= tolerance * std::max(1.0, stored.cwiseAbs().maxCoeff())))
      throw ArgumentError(fmt::format(
          "the gluings of {} do not take the copies of vertex {} to each other; certify the embedding first",
          name_, v));
    if (position != positions_.exact(site)) result_.sites.set_exact(site, position);
  }

  // The point near `here` that a rotation leaves in place; `here` itself if it is the identity.
  ExactPoint held_by(int rotation, const ExactPoint& here) const {
    if (rotation == ElementTable::identity) return here;
    return precise_fixed_point(embedding_.space(), elements_.exact(rotation), here.cast<double>());
  }

  // The point near `here` on the mirrors of the first and the last triangle around a vertex.
  ExactPoint on_mirrors(const Corner& first, const Corner& last, const ExactPoint& here) {
    const int right = mirror_.at(first.halfedge), beyond_left = mirror_.at(previous_halfedge(last.halfedge)),
              left = elements_.product(elements_.product(elements_.inverse(last.element), beyond_left),
                                       last.element);
    const int rotation = elements_.product(left, right);
    if (rotation != ElementTable::identity) return held_by(rotation, here);
    const ExactPoint image = elements_.exact(right) * here;
    return precise_retract(embedding_.space(), ExactPoint(here + image));
  }

  void require_positive() {
    ExactSigns signs(elements_);
    if (positions_.has_offsets()) signs.use_all_digits();
    const auto is_wrong = [&](int t) {
      const auto corner = [&](int k) { return signs.placed(result_.sites, result_.triangles(t, k)); };
      return signs.orientation(corner(0), corner(1), corner(2)) <= 0;
    };
    const std::vector<int> wrong = parallel_select(result_.triangle_count(), is_wrong);
    if (wrong.empty()) return;
    throw MeshError(fmt::format(
        "triangle {} of {} is not positive on the target, nor are {} others: it is turned over, or so thin "
        "that the rounding of the seams turns it over",
        wrong.front(), name_, wrong.size() - 1));
  }

  const Embedding& embedding_;
  const SharedGroup& group_;
  ElementTable& elements_;
  std::string name_;
  ExactPositions positions_;
  Matrix3Of<MostPrecise> out_;
  DevelopedSurface result_;
  std::unordered_map<std::uint64_t, int> on_boundary_;  // of the cut mesh: half-edges
  std::unordered_map<int, int> mirror_;                 // the reflections beyond half-edges
};

}  // namespace

int DevelopedSurface::corner_at(int triangle, int vertex) const {
  for (int h = 3 * triangle; h < 3 * triangle + 3; ++h)
    if (vertex_of(h) == vertex) return h;
  return -1;
}

int DevelopedSurface::halfedge_on(int triangle, int on) const {
  for (int h = 3 * triangle; h < 3 * triangle + 3; ++h)
    if (edge[h] == on) return h;
  return -1;
}

DevelopedSurface developed_surface(const Embedding& embedding, const SharedGroup& group,
                                   ElementTable& elements, const std::string& name) {
  return Development(embedding, group, elements, name).run();
}

}  // namespace orbitutte
