// SPDX-License-Identifier: MIT
#include "orbitutte/solve/repair.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <set>

#include "orbitutte/parallel.h"
#include "orbitutte/solve/kernel.h"
#include "orbitutte/solve/star_shape.h"

namespace orbitutte {
namespace {

constexpr int most_sweeps = 60, sweeps_per_ring = 6, smoothing_sweeps = 8;
constexpr int most_rings = 7;
constexpr std::size_t most_growth = 4, few_faces = 40;  // growth of the broken, beyond these few
constexpr double clamp = 0.01;                          // in place of weights that are not positive
constexpr double enough = 0.3;                          // of the largest margin that a star allows
constexpr double enough_gain = 1e-3;                    // of a star's distortion, for its vertex to be moved
constexpr double gain_of_sweep = 2e-2;                  // of one star at least, for another sweep
constexpr double flattest = 1e-6;  // twice the area of a source triangle, in squared edges

// Below these, rounding decides: the gain of a star's least margin, relative to its radius; the height of a
// triangle; and, where there are more digits, its part of the longest edge. What is all smaller than
// limb_edge is a limb.
constexpr double least_gain_of_margin = 1e-10, least_height_in_doubles = 5e-14, least_part_of_edge = 1e-12,
                 limb_edge = 1e-10;

enum class PatchWeights { cotan, mean_value };

class Repair {
 public:
  Repair(const RepairSite& site, MovablePositions& positions)
      : site_(site), positions_(positions), space_(site.gluing.boundary.space) {}

  std::vector<int> run() {
    const std::vector<int> turned = unclear_faces();
    if (!open_stars(turned) && !relax_patches(turned) && !repair_groups(turned)) return {};
    smooth_around(vertices_of(turned));
    return {moved_.begin(), moved_.end()};
  }

 private:
  // Those that are turned over, and those that rounding alone may decide about: which these are depends on
  // the cut, and what is repaired must not.
  std::vector<int> unclear_faces() const {
    const int m = static_cast<int>(site_.gluing.cut.F.rows());
    std::vector<char> may_be_unclear(m);
    parallel_ranges(m, [&](int begin, int end) {
      for (int f = begin; f < end; ++f) may_be_unclear[f] = !is_plain(f);
    });
    std::vector<int> faces;
    for (int f = 0; f < m; ++f)
      if (may_be_unclear[f]) faces.push_back(f);
    return unclear_at(vertices_of(faces));
  }

  // Is a face so large and so high, in doubles, that no closer look is needed?
  bool is_plain(int face) const {
    constexpr double least_edge = 1e-6, least_part = 1e-7;
    const CutMesh& cut = site_.gluing.cut;
    const auto corner = [&](int k) -> Vector3 {
      const int v = cut.F(face, k), source = cut.source_vertex[v];
      const Vector3 p = positions_.rounded(source);
      return v == source ? p : site_.gluing.boundary.transform(v) * p;
    };
    const Vector3 p = corner(0), a = corner(1) - p, b = corner(2) - p;
    const double longest = std::max({a.squaredNorm(), b.squaredNorm(), (b - a).squaredNorm()});
    return longest > least_edge * least_edge && p.dot(a.cross(b)) > least_part * longest;
  }

  // Is a triangle of the star positive, and higher than rounding? In limbs that have no more digits, where
  // whole triangles are as small as rounding, the sign must do.
  bool is_clearly_positive(int v, const StarTriangle& at) const {
    if (!positions_.is_positive(at.face)) return false;
    const Vector3 p = positions_.rounded(v), a = positions_.difference(v, at.a, at.element_a),
                  b = positions_.difference(v, at.b, at.element_b);
    const double longest = std::max({space_.norm(a), space_.norm(b), space_.norm(b - a)});
    double least_height = longest < limb_edge ? 0 : least_height_in_doubles;
    if (positions_.is_refined(v) && positions_.is_refined(at.a) && positions_.is_refined(at.b))
      least_height = least_part_of_edge * longest;
    return p.dot(a.cross(b)) > least_height * longest;
  }

  // Sweeps over the vertices and their neighbours. A vertex waits for its turn if something in its star has
  // moved since the last one.
  void smooth_around(const std::set<int>& vertices) {
    const std::set<int> around = site_.stars.with_neighbours(vertices);
    std::set<int> waiting = around;
    double largest = 1;
    for (int sweep = 0; sweep < smoothing_sweeps && largest > gain_of_sweep; ++sweep) {
      largest = 0;
      for (const int v : around) {
        const double gain = waiting.erase(v) == 1 ? smooth(v) : 0.0;
        if (gain > 0) waiting.merge(site_.stars.with_neighbours({v}));
        largest = std::max(largest, gain);
      }
    }
  }

  // Single vertices, sweep by sweep, in reach of the faces that are not clearly positive. If all are
  // positive, those that stay flat may. Where much more is broken than was, it does harm.
  bool open_stars(const std::vector<int>& turned) {
    const std::size_t before = positions_.moves();
    const std::set<int> moved_before = moved_;
    std::vector<int> broken = turned;
    std::set<int> reached = vertices_of(turned);
    for (int sweep = 0; sweep < most_sweeps && !broken.empty(); ++sweep) {
      std::set<int> vertices = vertices_of(broken);
      for (int ring = 0; ring < sweep / sweeps_per_ring; ++ring)
        vertices = site_.stars.with_neighbours(vertices);
      for (const int v : vertices) open_star(v);
      reached.merge(vertices);
      const std::size_t left = broken.size();
      broken = unclear_at(reached);
      if (broken.size() >= left && nonpositive_at(reached).empty()) break;
      if (broken.size() > most_growth * turned.size() + few_faces) break;
    }
    if (broken.empty() || nonpositive_at(reached).empty()) return true;
    positions_.take_back(before);
    moved_ = moved_before;
    return false;
  }

  // Tutte's embedding of patches that grow, their rings held.
  bool relax_patches(const std::vector<int>& turned) {
    const std::set<int> moved_before = moved_;
    std::set<int> patch = vertices_of(turned);
    for (int ring = 0; ring <= most_rings; ++ring, patch = site_.stars.with_neighbours(patch)) {
      for (const PatchWeights weights : {PatchWeights::cotan, PatchWeights::mean_value}) {
        const std::size_t before = positions_.moves();
        std::vector<Neighbourhood> neighbourhoods;
        for (const int v : patch)
          if (site_.may_move[v]) neighbourhoods.push_back(neighbourhood(v, weights));
        for (const Neighbourhood& at : neighbourhoods) moved_.insert(at.vertex);
        if (!neighbourhoods.empty())
          LocalMinimum(site_.gluing, positions_, std::move(neighbourhoods)).settle(positions_);
        if (nonpositive_at(patch).empty()) return true;
        positions_.take_back(before);
        moved_ = moved_before;
      }
    }
    return false;
  }

  // Faces that are no neighbours of each other apart, as long as one more group is repaired: what one needs
  // may do harm to others.
  bool repair_groups(const std::vector<int>& turned) {
    const std::size_t before = positions_.moves();
    std::vector<std::vector<int>> groups = groups_of(turned);
    if (groups.size() < 2) return false;
    std::size_t left = groups.size() + 1;
    while (!groups.empty() && groups.size() < left) {
      left = groups.size();
      std::erase_if(groups, [&](const std::vector<int>& group) {
        return nonpositive_at(vertices_of(group)).empty() || open_stars(group) || relax_patches(group);
      });
    }
    if (groups.empty()) return true;
    positions_.take_back(before);
    moved_.clear();
    return false;
  }

  // Faces whose neighbourhoods meet are in one group.
  std::vector<std::vector<int>> groups_of(const std::vector<int>& faces) const {
    std::vector<std::vector<int>> groups;
    std::vector<std::set<int>> reaches;
    for (const int f : faces) {
      std::vector<int> group = {f};
      std::set<int> reach = site_.stars.with_neighbours(vertices_of(group));
      for (std::size_t k = groups.size(); k-- > 0;) {
        const bool meet =
            std::any_of(reach.begin(), reach.end(), [&](int v) { return reaches[k].contains(v); });
        if (!meet) continue;
        group.insert(group.end(), groups[k].begin(), groups[k].end());
        reach.merge(reaches[k]);
        groups.erase(groups.begin() + static_cast<std::ptrdiff_t>(k));
        reaches.erase(reaches.begin() + static_cast<std::ptrdiff_t>(k));
      }
      groups.push_back(std::move(group));
      reaches.push_back(std::move(reach));
    }
    return groups;
  }

  // The edges of the input at v, with positive weights that are symmetric.
  Neighbourhood neighbourhood(int v, PatchWeights weights) const {
    std::map<std::pair<int, int>, double> sum;  // by neighbour and element
    const auto source = [&](int u) -> Vector3 { return site_.surface.V.row(u); };
    for (const StarTriangle& at : site_.stars.around(v)) {
      const std::array<Vector3, 3> corners = {source(v), source(at.a), source(at.b)};
      sum[{at.a, at.element_a}] += edge_weight(corners, weights);
      sum[{at.b, at.element_b}] += edge_weight({corners[0], corners[2], corners[1]}, weights);
    }
    Neighbourhood result = {v, {}};
    for (const auto& [neighbour, weight] : sum)
      result.neighbours.push_back({neighbour.first, neighbour.second, weight > 0 ? weight : clamp});
    return result;
  }

  // What a triangle adds to the weight of the edge between its first two corners; nothing if it is flat.
  static double edge_weight(const std::array<Vector3, 3>& corners, PatchWeights weights) {
    const auto& [v, a, b] = corners;
    const Vector3 va = a - v, vb = b - v, ab = b - a;
    const double twice_area = va.cross(vb).norm(), length = va.norm();
    if (!(twice_area > flattest * length * length)) return 0;
    if (weights == PatchWeights::cotan) return 0.5 * vb.dot(ab) / twice_area;
    // tan(angle/2) = (1 - cos)/sin at both ends
    const double at_v = (length * vb.norm() - va.dot(vb)) / twice_area,
                 at_a = (length * ab.norm() + va.dot(ab)) / twice_area;
    return (at_v + at_a) / length;
  }

  std::set<int> vertices_of(const std::vector<int>& faces) const {
    std::set<int> vertices;
    for (const int f : faces)
      for (const int v : site_.surface.triangles.row(f)) vertices.insert(v);
    return vertices;
  }

  std::vector<int> nonpositive_at(const std::set<int>& vertices) const {
    return faces_at(vertices, [&](int, const StarTriangle& at) { return !positions_.is_positive(at.face); });
  }

  std::vector<int> unclear_at(const std::set<int>& vertices) const {
    return faces_at(vertices, [&](int v, const StarTriangle& at) { return !is_clearly_positive(v, at); });
  }

  // The faces around vertices that a test (vertex, triangle of its star) holds for, ascending.
  template <typename Test>
  std::vector<int> faces_at(const std::set<int>& vertices, const Test& holds) const {
    std::set<int> faces;
    for (const int v : vertices)
      for (const StarTriangle& at : site_.stars.around(v))
        if (holds(v, at)) faces.insert(at.face);
    return {faces.begin(), faces.end()};
  }

  StarShape shape_of(int v, const std::vector<StarTriangle>& star) const {
    StarShape shape;
    shape.triangles.reserve(star.size());
    const Vector3 p = positions_.rounded(v);
    const auto source = [&](int u) -> Vector3 { return site_.surface.V.row(u); };
    for (const StarTriangle& at : star) {
      StarShape::Triangle& triangle = shape.triangles.emplace_back();
      const Vector3 a = positions_.difference(v, at.a, at.element_a),
                    b = positions_.difference(v, at.b, at.element_b);
      triangle.a = a;
      triangle.b = b;
      triangle.value = p.dot(a.cross(b));
      triangle.gradient = p.cross(b - a) + a.cross(b);
      const Vector3 va = source(at.a) - source(v), vb = source(at.b) - source(v);
      set_source(va, vb, triangle);
      shape.radius = std::max({shape.radius, a.norm(), b.norm()});
    }
    set_axes(v, p, star, shape);
    return shape;
  }

  // The direction to the neighbour with the lowest number that does not coincide with the vertex: a choice
  // that no cut changes.
  Vector3 direction_to_a_neighbour(const StarShape& shape, const std::vector<StarTriangle>& star) const {
    Vector3 direction = Vector3::Zero();
    int lowest = std::numeric_limits<int>::max();
    for (std::size_t k = 0; k < star.size(); ++k) {
      const double size = shape.triangles[k].a.cwiseAbs().maxCoeff();
      if (star[k].a >= lowest || !(size > 0)) continue;
      lowest = star[k].a;
      direction = shape.triangles[k].a / size;
    }
    return direction;
  }

  // The first axis points to a neighbour, or along the mirror to its side.
  void set_axes(int v, const Vector3& p, const std::vector<StarTriangle>& star, StarShape& shape) const {
    const BoundaryConditions& boundary = site_.gluing.boundary;
    shape.on_mirror = boundary.basis_of[v] != in_space;
    Vector3 first = space_.tangent(p, direction_to_a_neighbour(shape, star));
    if (shape.on_mirror) {
      const Vector3 to_neighbour = first;
      const Room& room = boundary.basis(v);
      first.setZero();
      for (Eigen::Index k = 0; k < room.cols(); ++k)
        if (const Vector3 along = space_.tangent(p, room.col(k)); space_.norm(along) > space_.norm(first))
          first = along;
      if (space_.dot(first, to_neighbour) < 0) first = -first;
    }
    first /= space_.norm(first);
    // The second makes det[p e1 e2] positive: along the cross product, made tangent.
    Vector3 second = space_.tangent(p, p.cross(first));
    second -= space_.dot(first, second) * first;
    shape.axes << first, second / space_.norm(second);
  }

  // Moves v to where its triangles have room, if one of them has none. Lengths are taken along the tangent
  // plane, so that it does not matter where the star lies.
  void open_star(int v) {
    if (!site_.may_move[v]) return;
    const std::vector<StarTriangle> star = site_.stars.around(v);
    const auto is_open = [&](const StarTriangle& at) { return is_clearly_positive(v, at); };
    if (std::all_of(star.begin(), star.end(), is_open)) return;
    const StarShape shape = shape_of(v, star);
    if (!(shape.radius > 0)) return;
    const double source_radius = longest_source_edge(shape);
    std::vector<KernelCondition> conditions;
    for (const StarShape::Triangle& triangle : shape.triangles) {
      const Eigen::Vector2d gradient = shape.axes.transpose() * triangle.gradient;
      const double length = std::max(gradient.norm(), std::numeric_limits<double>::min());
      conditions.push_back({gradient / length, triangle.value / length / shape.radius,
                            source_radius > 0 ? triangle.height / source_radius : 1});
    }
    const KernelStep widest = widest_step(conditions, {1, shape.on_mirror ? 0 : 1});
    if (!(widest.margin > least_margin(conditions) + least_gain_of_margin)) return;
    double fraction = 1;  // of the way, on which the least margin grows at least in proportion
    if (widest.margin > 0) fraction = shortest_fraction(conditions, widest);
    positions_.move(v, shape.axes * (fraction * shape.radius * widest.step));
    moved_.insert(v);
  }

  // Without a step.
  static double least_margin(const std::vector<KernelCondition>& conditions) {
    double least = std::numeric_limits<double>::infinity();
    for (const KernelCondition& at : conditions) least = std::min(least, at.margin({0, 0}));
    return least;
  }

  bool are_positive(const std::vector<StarTriangle>& star) const {
    return std::all_of(star.begin(), star.end(),
                       [&](const StarTriangle& at) { return positions_.is_positive(at.face); });
  }

  static double longest_source_edge(const StarShape& shape) {
    double longest = 0;
    for (const StarShape::Triangle& triangle : shape.triangles)
      longest = std::max({longest, triangle.source[0], triangle.source[1]});
    return std::sqrt(longest);
  }

  // How far towards the widest step the least margin is enough, by bisection of a concave function.
  static double shortest_fraction(const std::vector<KernelCondition>& conditions, const KernelStep& widest) {
    double low = 0, high = 1;
    for (int k = 0; k < 52; ++k) {
      const double middle = 0.5 * (low + high);
      const bool holds = std::all_of(conditions.begin(), conditions.end(), [&](const KernelCondition& at) {
        return at.margin(middle * widest.step) >= enough * widest.margin;
      });
      (holds ? high : low) = middle;
    }
    return high;
  }

  // Moves v to where its star is distorted least. The share of the distortion that this takes away, if it is
  // worth a move.
  double smooth(int v) {
    if (!site_.may_move[v]) return 0;
    const std::vector<StarTriangle> star = site_.stars.around(v);
    const StarShape shape = shape_of(v, star);
    const auto [step, at_first, least] = least_distortion(shape);
    const double gain = 1 - least / at_first;
    if (!(gain > enough_gain)) return 0;
    const std::size_t before = positions_.moves();
    positions_.move(v, shape.axes * step);
    if (!are_positive(star)) {
      positions_.take_back(before);
      return 0;
    }
    moved_.insert(v);
    return gain;
  }

  const RepairSite& site_;
  MovablePositions& positions_;
  Space space_;
  std::set<int> moved_;
};

}  // namespace

std::vector<int> repair(const RepairSite& site, MovablePositions& positions) {
  return Repair(site, positions).run();
}

}  // namespace orbitutte
