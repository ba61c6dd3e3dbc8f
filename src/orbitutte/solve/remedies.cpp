// SPDX-License-Identifier: MIT
#include "orbitutte/solve/remedies.h"

#include <algorithm>
#include <atomic>
#include <iterator>
#include <limits>
#include <set>

#include "orbitutte/geometry/orientation.h"
#include "orbitutte/orbifold/free_tile.h"
#include "orbitutte/parallel.h"
#include "orbitutte/solve/repair.h"
#include "orbitutte/solve/tips.h"

namespace orbitutte {
namespace {

constexpr double small = 1e-6;  // edges shorter than this belong to a limb
constexpr double finest_edge = 1e-60, finest_edge_of_all = 1e-290;  // of Precise and MostPrecise

// Far out in the hyperbolic plane coordinates are rounded by their length, and edges look longer by it: the
// square of the height. Of the copy of each input vertex that lies furthest out.
std::vector<double> lost_digits_of(const GluingProblem& problem, const Placement& placed) {
  const Points& positions = placed.minimum.positions;
  const std::vector<int>& source_vertex = problem.cut.source_vertex;
  std::vector<double> lost(positions.rows(), 1.0);
  for (int c = 0; c < static_cast<int>(source_vertex.size()); ++c) {
    const int v = source_vertex[c];
    const double height = Vector3(placed.boundary.transform(c) * Vector3(positions.row(v))).z();
    lost[v] = std::max(lost[v], height * height);
  }
  return lost;
}

// The map's gluing, and all that its remedies ask of it.
struct Site {
  Site(const GluingProblem& the_problem, const Placement& the_placed)
      : problem(the_problem),
        placed(the_placed),
        ears(ears_of(problem, placed)),
        stars(problem.cut, placed.boundary, ears, elements),
        may_move(placed.boundary.basis_of.size()) {
    for (std::size_t v = 0; v < may_move.size(); ++v)
      may_move[v] = placed.boundary.basis_of[v] != held_in_place;
    for (const Ear& ear : ears) may_move[ear.tip] = 0;
  }

  // Is an edge at a vertex too short for doubles, at one of the vertex's copies?
  bool is_small(int v, double edge) const { return edge < small * lost_digits[v]; }

  // Those along edges with weights. They are gathered when they are first asked for, since a few thin faces
  // can be repaired without.
  std::vector<Neighbour> neighbours(int v) {
    if (!energy) {
      energy.emplace(glued_along(problem, placed.boundary), problem.weights, placed.boundary);
      for (const Isometry& transform : energy->transforms()) elements.index(transform);
    }
    return energy->neighbours(v, elements);
  }

  const GluingProblem& problem;
  const Placement& placed;
  std::optional<DirichletEnergy> energy;
  Elements elements;
  std::vector<Ear> ears;
  Stars stars;
  std::vector<char> may_move;
  std::vector<double> lost_digits = lost_digits_of(problem, placed);
  Gluing gluing = {problem.cut, placed.boundary, elements};
};

// The length of the shortest edge of the input at a vertex.
double shortest_in_star(const Site& site, const MovablePositions& positions, int v) {
  double shortest = std::numeric_limits<double>::infinity();
  for (const StarTriangle& at : site.stars.around(v))
    shortest = std::min({shortest, positions.difference(v, at.a, at.element_a).norm(),
                         positions.difference(v, at.b, at.element_b).norm()});
  return shortest;
}

// The same, be the edge the input's or of the triangulation with the weights.
double shortest_edge(Site& site, const MovablePositions& positions, int v) {
  double shortest = shortest_in_star(site, positions, v);
  for (const Neighbour& at : site.neighbours(v))
    shortest = std::min(shortest, positions.difference(v, at.vertex, at.element).norm());
  return shortest;
}

std::vector<int> vertices_of_limbs(Site& site, const MovablePositions& positions) {
  const int n = static_cast<int>(site.may_move.size());
  std::vector<int> result;
  for (int v = 0; v < n; ++v)
    if (site.is_small(v, shortest_edge(site, positions, v))) result.push_back(v);
  return result;
}

std::vector<Neighbourhood> neighbourhoods_of(Site& site, const std::vector<int>& vertices) {
  std::vector<Neighbourhood> result;
  result.reserve(vertices.size());
  for (const int v : vertices)
    if (site.placed.boundary.basis_of[v] != held_in_place) result.push_back({v, site.neighbours(v)});
  return result;
}

// The minimum over the limbs; false if it is not found.
bool settle_limbs(Site& site, const std::vector<int>& limbs, MovablePositions& positions) {
  std::vector<Neighbourhood> neighbourhoods = neighbourhoods_of(site, limbs);
  if (neighbourhoods.empty()) return true;
  return LocalMinimum(site.gluing, positions, std::move(neighbourhoods)).settle(positions);
}

// Where the tip of an ear lies between the face's ends: their differences from it, and the part of the way.
struct BesideTip {
  Vector3 to_first, to_second;

  double part() const {
    const double first = to_first.norm(), second = to_second.norm();
    return first + second > 0 ? first / (first + second) : 0.5;
  }
};

BesideTip beside_tip(Site& site, const MovablePositions& positions, const Ear& ear) {
  const BoundaryConditions& boundary = site.placed.boundary;
  const auto difference = [&](int end) {
    const int element = site.elements.index(boundary.transform(ear.tip).inverse() * boundary.transform(end));
    return positions.difference(ear.tip, site.problem.cut.source_vertex[end], element);
  };
  return {difference(ear.ends[0]), difference(ear.ends[1])};
}

// Takes tips along with ends of their faces that moved, to the same part of the way between them, and adds
// them to those that moved.
void take_along(Site& site, const std::vector<double>& parts, MovablePositions& positions,
                std::vector<int>& moved) {
  const std::set<int> before(moved.begin(), moved.end());
  for (std::size_t k = 0; k < site.ears.size(); ++k) {
    const Ear& ear = site.ears[k];
    if (std::none_of(ear.ends.begin(), ear.ends.end(),
                     [&](int end) { return before.contains(site.problem.cut.source_vertex[end]); }))
      continue;
    const auto [first, second] = beside_tip(site, positions, ear);
    positions.move(ear.tip, first + parts[k] * (second - first));
    moved.push_back(ear.tip);
  }
  std::sort(moved.begin(), moved.end());
}

// Moves tips outward by a few units in the last place, or by a thousandth of the shortest edge if that is
// less. Refined tips move by less than the certificate notices.
void round_ears(Site& site, MovablePositions& positions) {
  constexpr double part = 1e-3, refined_part = 1e-10;
  for (const Ear& ear : site.ears) {
    const double shortest = shortest_edge(site, positions, ear.tip);
    const double length =
        positions.is_refined(ear.tip) ? refined_part * shortest : std::min(outward_rounding, part * shortest);
    positions.shift(ear.tip, length * ear.outward);
  }
}

std::vector<int> nonpositive_faces(const Site& site, const MovablePositions& positions) {
  const int m = static_cast<int>(site.problem.cut.F.rows());
  std::vector<char> positive(m);
  parallel_ranges(m, [&](int begin, int end) {
    for (int f = begin; f < end; ++f) positive[f] = positions.is_positive(f);
  });
  std::vector<int> result;
  for (int f = 0; f < m; ++f)
    if (!positive[f]) result.push_back(f);
  return result;
}

// The faces that are not positive, without ears: the signs of these are rounding errors.
std::vector<int> turned_faces(Site& site, const MovablePositions& positions) {
  std::vector<int> faces = nonpositive_faces(site, positions);
  std::erase_if(faces, [&](int f) { return site.stars.leaves_out(f); });
  return faces;
}

bool any_in_limbs(const Site& site, const MovablePositions& positions, const std::vector<int>& faces) {
  const auto is_in_limb = [&](int v) { return shortest_in_star(site, positions, v) < small; };
  return std::any_of(faces.begin(), faces.end(), [&](int f) {
    const auto corners = site.problem.surface.triangles.row(f);
    return std::any_of(corners.begin(), corners.end(), is_in_limb);
  });
}

// Where many faces are turned over, the weights are at fault, and to move single vertices would not do.
bool may_be_repaired(const Site& site, const std::vector<int>& turned) {
  return static_cast<Eigen::Index>(turned.size()) <= 1 + site.problem.cut.F.rows() / 20;
}

// Repairs the turned faces, and takes ears along and rounds them outward. The vertices that moved for it;
// nothing if faces remain.
std::optional<std::vector<int>> put_right(Site& site, const std::vector<int>& turned,
                                          MovablePositions& positions) {
  if (!may_be_repaired(site, turned)) return std::nullopt;
  std::vector<int> moved;
  if (!turned.empty()) {
    std::vector<double> parts;
    for (const Ear& ear : site.ears) parts.push_back(beside_tip(site, positions, ear).part());
    moved = repair({site.problem.surface, site.gluing, site.stars, site.may_move}, positions);
    if (moved.empty()) return std::nullopt;
    take_along(site, parts, positions, moved);
  }
  round_ears(site, positions);
  if (!site.ears.empty() && !nonpositive_faces(site, positions).empty()) return std::nullopt;
  return moved;
}

std::vector<int> united(const std::vector<int>& a, const std::vector<int>& b) {
  std::vector<int> result;
  std::set_union(a.begin(), a.end(), b.begin(), b.end(), std::back_inserter(result));
  return result;
}

// The tips of limbs that were unrolled; none if no cone of more than pi turns faces over.
std::vector<int> unrolled_tips(const Site& site, MovablePositions& positions) {
  return unroll_tips({site.problem.surface, site.gluing, site.stars, site.may_move}, positions);
}

// Adds the vertices that moved for both to the map.
void add_moved(const std::vector<int>& unrolled, const std::vector<int>& repaired, SpreadMap& map) {
  map.moved_vertices = united(unrolled, repaired);
  map.repairing_vertices = static_cast<int>(repaired.size());
}

Points positions_of_copies(const GluingProblem& problem, const Placement& placed) {
  const Points& positions = placed.minimum.positions;
  return problem.target.has_free_tile ? spread_on_free_tile(problem.target, problem.cut, positions)
                                      : placed.boundary.spread(positions, problem.cut.source_vertex);
}

SpreadMap spread_map(const GluingProblem& problem, Placement placed, std::vector<int> moved) {
  Points all = positions_of_copies(problem, placed);
  const int repairing = static_cast<int>(moved.size());
  return {std::move(placed), std::move(all), {}, std::move(moved), repairing};
}

// The vertices that say exactly how a free tile is glued: its marks, and the ends of its mirrors.
std::vector<int> vertices_of_gluing(const Site& site) {
  if (!site.problem.target.has_free_tile) return {};
  std::vector<int> result;
  for (const ConeCopies& cone : site.placed.boundary.cones) result.push_back(cone.vertex);
  for (const Seam& seam : site.placed.boundary.seams)
    if (seam.is_mirror())
      for (const int end : {seam.left.front(), seam.left.back()})
        result.push_back(site.problem.cut.source_vertex[end]);
  return result;
}

// Doubles put a copy of a vertex, moved by a matrix with large entries, further off than rounding does.
std::vector<int> vertices_with_copies(const CutMesh& cut) {
  std::vector<int> result;
  for (int c = 0; c < static_cast<int>(cut.source_vertex.size()); ++c)
    if (cut.source_vertex[c] != c) result.push_back(cut.source_vertex[c]);
  return result;
}

// Gives the limbs more digits where they belong; false if that fails.
template <typename Real>
using RefineLimbs = std::function<bool(Site&, const std::vector<int>&, PrecisePositions<Real>&)>;

// At the minimum.
template <typename Real>
bool refine_and_settle(Site& site, const std::vector<int>& limbs, PrecisePositions<Real>& positions) {
  for (const int v : limbs) positions.refine(v);
  return settle_limbs(site, limbs, positions);
}

// All vertices at their minimum.
template <typename Real>
bool settle_in_place(Site& site, const std::vector<int>&, PrecisePositions<Real>& positions) {
  std::vector<int> vertices;
  for (int v = 0; v < static_cast<int>(site.may_move.size()); ++v)
    if (!site.neighbours(v).empty()) vertices.push_back(v);
  for (const int v : vertices) positions.refine(v);
  std::vector<Neighbourhood> neighbourhoods = neighbourhoods_of(site, vertices);
  return LocalMinimum(site.gluing, positions, std::move(neighbourhoods)).settle_in_place(positions);
}

// The shortest edge that so many digits are enough for, and what is told if there is a shorter one.
struct Resolution {
  double finest;
  bool is_too_coarse = false;
};

// With the limbs refined; nothing if there are none, or if that fails.
template <typename Real>
std::optional<SpreadMap> refined(const GluingProblem& problem, const Placement& placed,
                                 Resolution& resolution, const RefineLimbs<Real>& refine) {
  Site site(problem, placed);
  SpreadMap result = {placed, {}, {}, {}};
  PrecisePositions<Real> positions(site.gluing, result.placed.minimum.positions, problem.target);
  const std::vector<int> limbs = vertices_of_limbs(site, positions);
  if (limbs.empty()) return std::nullopt;
  const std::vector<int> of_gluing = vertices_of_gluing(site);
  for (const int v : of_gluing) positions.refine(v);
  for (const int v : vertices_with_copies(problem.cut)) positions.refine(v);
  const bool are_refined = refine(site, limbs, positions);
  std::vector<double> shortest(site.may_move.size(), std::numeric_limits<double>::infinity());
  double least = 1;
  for (const int v : limbs) least = std::min(least, shortest_edge(site, positions, v));
  resolution.is_too_coarse = least < resolution.finest;
  if (!are_refined || resolution.is_too_coarse) return std::nullopt;
  const std::vector<int> unrolled = unrolled_tips(site, positions);
  const std::optional<std::vector<int>> moved = put_right(site, turned_faces(site, positions), positions);
  if (!moved) return std::nullopt;
  for (int v = 0; v < static_cast<int>(shortest.size()); ++v) {
    if (!positions.is_refined(v)) continue;
    if (const double edge = shortest_edge(site, positions, v); site.is_small(v, edge)) shortest[v] = edge;
  }
  for (const int v : of_gluing) shortest[v] = least;
  add_moved(unrolled, *moved, result);
  result.positions = positions.spread(shortest, result.offsets);
  result.placed.minimum.positions = result.positions.topRows(placed.minimum.positions.rows());
  return result;
}

}  // namespace

std::vector<Ear> ears_of(const GluingProblem& problem, const Placement& placed) {
  const Polygons polygons = problem.surface.polygons_on(problem.cut.F, problem.cut.turned);
  return find_ears(polygons.count() > 0 ? FaceView(polygons) : FaceView(problem.cut.F), placed.tile,
                   placed.boundary);
}

SpreadMap spread_map(const GluingProblem& problem, const Placement& placed) {
  Placement rounded = placed;
  round_outward(ears_of(problem, placed), rounded.minimum.positions);
  return spread_map(problem, std::move(rounded), {});
}

bool turns_faces_over(const GluingProblem& problem, const SpreadMap& map) {
  const Triangles& F = problem.cut.F;
  std::atomic<bool> any = false;
  parallel_ranges(static_cast<int>(F.rows()), [&](int begin, int end) {
    for (int f = begin; f < end && !any; ++f)
      if (!is_visibly_positive(map.positions.row(F(f, 0)), map.positions.row(F(f, 1)),
                               map.positions.row(F(f, 2))))
        any = true;
  });
  return any;
}

std::optional<SpreadMap> with_faces_repaired(const GluingProblem& problem, const Placement& placed) {
  Placement result = placed;
  Site site(problem, placed);
  MovablePositions positions(site.gluing, result.minimum.positions);
  const std::vector<int> turned = turned_faces(site, positions);
  if (any_in_limbs(site, positions, turned)) return std::nullopt;
  std::optional<std::vector<int>> moved = put_right(site, turned, positions);
  if (!moved) return std::nullopt;
  return spread_map(problem, std::move(result), std::move(*moved));
}

std::optional<SpreadMap> with_tips_unrolled(const GluingProblem& problem, const Placement& placed) {
  Placement result = placed;
  Site site(problem, placed);
  MovablePositions positions(site.gluing, result.minimum.positions);
  const std::vector<int> unrolled = unrolled_tips(site, positions);
  if (unrolled.empty()) return std::nullopt;
  const std::vector<int> turned = turned_faces(site, positions);
  if (any_in_limbs(site, positions, turned)) return std::nullopt;
  const std::optional<std::vector<int>> moved = put_right(site, turned, positions);
  if (!moved) return std::nullopt;
  SpreadMap map = spread_map(problem, std::move(result), {});
  add_moved(unrolled, *moved, map);
  return map;
}

std::optional<SpreadMap> with_limbs_resolved(const GluingProblem& problem, const Placement& placed) {
  if (has_held_side(placed.tile)) return std::nullopt;
  const DirichletEnergy energy(glued_along(problem, placed.boundary), problem.weights, placed.boundary);
  const auto [vertex, length] = energy.smallest_spot(placed.minimum.positions);
  if (!(length < small)) return std::nullopt;
  const Isometry frame = problem.target.space.to_origin(placed.minimum.positions.row(vertex));
  const Placement there = moved(problem, frame, placed);
  Placement result = there;
  Site site(problem, there);
  MovablePositions positions(site.gluing, result.minimum.positions);
  if (!settle_limbs(site, vertices_of_limbs(site, positions), positions)) return std::nullopt;
  std::optional<std::vector<int>> moved_vertices = put_right(site, turned_faces(site, positions), positions);
  if (!moved_vertices) return std::nullopt;
  return spread_map(problem, std::move(result), std::move(*moved_vertices));
}

std::optional<SpreadMap> with_digits_of(const PrecisePoint& point, const GluingProblem& problem,
                                        const Placement& placed) {
  Resolution resolution = {finest_edge};
  return refined<Precise>(problem, placed, resolution,
                          [&](Site&, const std::vector<int>& limbs, PrecisePositions<Precise>& positions) {
                            for (const int v : limbs) positions.refine_to(v, point(v));
                            return true;
                          });
}

std::optional<SpreadMap> with_more_digits(const GluingProblem& problem, const Placement& placed) {
  Resolution fine = {finest_edge}, finest = {finest_edge_of_all};
  try {
    std::optional<SpreadMap> result = refined<Precise>(problem, placed, fine, refine_and_settle<Precise>);
    if (fine.is_too_coarse)
      result = refined<MorePrecise>(problem, placed, finest, refine_and_settle<MorePrecise>);
    return result;
  } catch (const ArgumentError&) {  // doubles do not tell the group's elements apart
    return std::nullopt;
  }
}

std::optional<SpreadMap> with_limbs_in_place(const GluingProblem& problem, const Placement& placed) {
  constexpr Eigen::Index most_vertices = 60000;
  // Doubles put longer edges where they belong to some 1e-5 of themselves; of few vertices, which take a
  // second or two, to 1e-7.
  constexpr Eigen::Index few_vertices = 2000;
  const double misplaced = placed.minimum.positions.rows() <= few_vertices ? 1e-9 : 1e-11;
  const DirichletEnergy energy(glued_along(problem, placed.boundary), problem.weights, placed.boundary);
  const std::vector<double> shortest = energy.shortest_edges(placed.minimum.positions),
                            lost = lost_digits_of(problem, placed);
  bool any_misplaced = false;
  for (std::size_t v = 0; v < shortest.size(); ++v)
    any_misplaced = any_misplaced || shortest[v] < misplaced * lost[v];
  if (!any_misplaced) return std::nullopt;
  if (placed.minimum.positions.rows() <= most_vertices) {
    Resolution resolution = {finest_edge};
    try {
      if (std::optional<SpreadMap> map =
              refined<Precise>(problem, placed, resolution, settle_in_place<Precise>))
        return map;
    } catch (const ArgumentError&) {  // doubles do not tell the group's elements apart
      return std::nullopt;
    }
  }
  return with_more_digits(problem, placed);
}

}  // namespace orbitutte
