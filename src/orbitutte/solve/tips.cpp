// SPDX-License-Identifier: MIT
#include "orbitutte/solve/tips.h"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <Eigen/SparseCholesky>
#include <Eigen/SparseLU>
#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>
#include <map>
#include <numbers>
#include <optional>
#include <set>
#include <utility>

namespace orbitutte {
namespace {

using std::numbers::pi;
using RootNumber = std::complex<double>;
using Roots = std::map<int, RootNumber>;

// Of the vertices inside a patch, by neighbour.
using TipWeights = std::map<int, std::map<int, double>>;

// How the cone comes to lie at zero in the plane of roots.
enum class Centring { shift, bias };

constexpr int most_rings_around_tip = 40;
constexpr double least_tip_weight = 0.01;  // in place of weights that are not positive

// Where a vertex is seen from the cone: its image under `frame`, and the angle there, which goes on around
// the cone.
struct SeenFromTip {
  Isometry frame;
  double angle = 0;
};

// The neighbourhood of the cone within some rings: the vertices inside, and the ring around them.
struct TipPatch {
  std::set<int> inside;

  // Counterclockwise.
  std::vector<int> ring;
};

class Tip {
 public:
  Tip(const RepairSite& site, const ConeCopies& cone, MovablePositions& positions)
      : site_(site),
        positions_(positions),
        space_(site.gluing.boundary.space),
        cone_(cone.vertex),
        share_(cone.mark.angle / (2 * pi)),
        centre_(positions.rounded(cone.vertex)),
        from_centre_(space_.to_origin(centre_)) {}

  // Is a face beside the cone or beside a neighbour of it not positive?
  bool is_turned() const { return count_turned(site_.stars.with_neighbours({cone_})) > 0; }

  // All faces positive, or, if no patch does that, the fewest not: thin ones are left for others to repair.
  std::vector<int> run() {
    std::optional<TipPatch> best;
    Centring best_way = Centring::shift;
    int fewest = std::numeric_limits<int>::max();
    std::set<int> inside = {cone_};
    for (int rings = 0; rings < most_rings_around_tip && fewest > 0; ++rings) {
      inside = site_.stars.with_neighbours(inside);
      if (!may_all_move(inside)) break;
      const std::optional<TipPatch> patch = patch_of(inside);
      if (!patch) continue;
      for (const Centring way : {Centring::shift, Centring::bias}) {
        if (fewest == 0) break;
        const int turned_before = count_turned(patch->inside);
        const std::size_t before = positions_.moves();
        const int turned = place(*patch, way) ? count_turned(patch->inside) : turned_before;
        positions_.take_back(before);
        if (turned >= std::min(fewest, turned_before)) continue;
        fewest = turned;
        best = patch;
        best_way = way;
      }
    }
    if (!best) return {};
    place(*best, best_way);
    return moved(best->inside);
  }

 private:
  // Without other marks and mirrors.
  bool may_all_move(const std::set<int>& inside) const {
    return std::all_of(inside.begin(), inside.end(),
                       [&](int v) { return v == cone_ || site_.gluing.boundary.basis_of[v] == in_space; });
  }

  int count_turned(const std::set<int>& inside) const {
    std::set<int> turned;
    for (const int v : inside)
      for (const StarTriangle& triangle : site_.stars.around(v))
        if (!positions_.is_positive(triangle.face)) turned.insert(triangle.face);
    return static_cast<int>(turned.size());
  }

  std::vector<int> moved(const std::set<int>& inside) const {
    std::vector<int> result(inside.begin(), inside.end());
    std::erase(result, cone_);
    return result;
  }

  // The edges of faces with one corner inside that lie across from it, by their beginnings; and the vertices
  // where two begin, or that are surrounded by what is inside.
  struct Surround {
    std::map<int, int> next;
    std::set<int> pinched;
  };
  Surround surround_of(const std::set<int>& inside) const {
    Surround around;
    for (const int v : inside)
      for (const StarTriangle& triangle : site_.stars.around(v))
        if (!inside.contains(triangle.a) && !inside.contains(triangle.b) &&
            !around.next.emplace(triangle.a, triangle.b).second)
          around.pinched.insert(triangle.a);
    for (const int v : inside)
      for (const StarTriangle& triangle : site_.stars.around(v))
        if (!inside.contains(triangle.a) && !around.next.contains(triangle.a))
          around.pinched.insert(triangle.a);
    return around;
  }

  // The loops that they make.
  static std::vector<std::vector<int>> loops_of(std::map<int, int> next) {
    std::vector<std::vector<int>> loops;
    while (!next.empty()) {
      std::vector<int>& loop = loops.emplace_back();
      for (int v = next.begin()->first;;) {
        const auto at = next.find(v);
        if (at == next.end()) break;
        loop.push_back(v);
        v = at->second;
        next.erase(at);
        if (v == loop.front()) break;
      }
    }
    return loops;
  }

  // With what is enclosed filled in, until one simple loop surrounds it; nothing if that does not come about.
  std::optional<TipPatch> patch_of(std::set<int> inside) const {
    constexpr int most_fillings = 30;
    for (int filling = 0; filling < most_fillings; ++filling) {
      const Surround around = surround_of(inside);
      if (around.next.empty() || !may_all_move(inside)) return std::nullopt;
      if (!around.pinched.empty()) {
        inside.insert(around.pinched.begin(), around.pinched.end());
        continue;
      }
      std::vector<std::vector<int>> loops = loops_of(around.next);
      std::swap(loops.front(),
                *std::max_element(loops.begin(), loops.end(),
                                  [](const auto& l, const auto& m) { return l.size() < m.size(); }));
      if (loops.size() == 1) return TipPatch{std::move(inside), std::move(loops.front())};
      for (std::size_t k = 1; k < loops.size(); ++k) inside.insert(loops[k].begin(), loops[k].end());
    }
    return std::nullopt;
  }

  // The element through which a neighbour is seen; the ring's vertices see each other, too.
  std::optional<Isometry> element_between(int v, int u) const {
    for (const StarTriangle& triangle : site_.stars.around(v)) {
      if (triangle.a == u) return site_.gluing.elements[triangle.element_a];
      if (triangle.b == u) return site_.gluing.elements[triangle.element_b];
    }
    return std::nullopt;
  }

  // In the frame of the cone, moved to (0, 0, 1).
  Vector3 seen(const Isometry& frame, int v) const {
    return from_centre_ * Vector3(frame * positions_.rounded(v));
  }

  static double bearing(const Vector3& p) { return std::atan2(p.y(), p.x()); }

  double distance_from_tip(int v, const Isometry& frame) const {
    return space_.distance(Space::origin(), seen(frame, v));
  }

  // A frame in which the cone sees a vertex, along edges inside the patch.
  std::optional<Isometry> frame_of(int wanted, const std::set<int>& inside) const {
    std::map<int, Isometry> frames = {{cone_, Isometry()}};
    std::vector<int> reached = {cone_};
    for (std::size_t k = 0; k < reached.size(); ++k) {
      const int v = reached[k];
      for (const StarTriangle& triangle : site_.stars.around(v))
        for (const auto& [u, element] :
             {std::pair(triangle.a, triangle.element_a), std::pair(triangle.b, triangle.element_b)})
          if (frames.try_emplace(u, frames.at(v) * site_.gluing.elements[element]).second &&
              inside.contains(u))
            reached.push_back(u);
    }
    const auto at = frames.find(wanted);
    return at == frames.end() ? std::nullopt : std::optional(at->second);
  }

  // The ring as it is seen on a walk around the cone; nothing if it does not run around it once.
  std::optional<std::map<int, SeenFromTip>> seen_ring(const TipPatch& patch) const {
    const std::optional<Isometry> first = frame_of(patch.ring.front(), patch.inside);
    if (!first) return std::nullopt;
    SeenFromTip at = {*first, bearing(seen(*first, patch.ring.front()))};
    const double start = at.angle;
    std::map<int, SeenFromTip> result;
    for (std::size_t k = 0; k < patch.ring.size(); ++k) {
      const int v = patch.ring[k], u = patch.ring[(k + 1) % patch.ring.size()];
      result[v] = at;
      const std::optional<Isometry> step = element_between(v, u);
      if (!step) return std::nullopt;
      const double before = bearing(seen(at.frame, v));
      at.frame = at.frame * *step;
      at.angle += std::remainder(bearing(seen(at.frame, u)) - before, 2 * pi);
    }
    constexpr double much = 0.1;
    return std::abs(at.angle - start - 2 * pi * share_) < much ? std::optional(result) : std::nullopt;
  }

  // Cotangents of the angle opposite to a and b's common edges, half of what an edge weighs.
  static double half_cotangent(const Vector3& apex, const Vector3& a, const Vector3& b) {
    const Vector3 u = a - apex, v = b - apex;
    return 0.5 * u.dot(v) / std::max(u.cross(v).norm(), 1e-300);
  }

  // By neighbour.
  std::map<int, double> weights_at(int v) const {
    std::map<int, double> weights;
    const auto source = [&](int u) -> Vector3 { return site_.surface.V.row(u); };
    for (const StarTriangle& t : site_.stars.around(v)) {
      weights[t.a] += half_cotangent(source(t.b), source(v), source(t.a));
      weights[t.b] += half_cotangent(source(t.a), source(v), source(t.b));
    }
    for (auto& [u, weight] : weights) weight = weight > least_tip_weight ? weight : least_tip_weight;
    return weights;
  }

  TipWeights weights_inside(const TipPatch& patch) const {
    TipWeights result;
    for (const int v : patch.inside) result.emplace(v, weights_at(v));
    return result;
  }

  // Tutte's embedding in the plane of roots: of all vertices inside, the ring being held.
  template <class Solver>
  static Roots embedded(const TipPatch& patch, Roots held, const TipWeights& weights) {
    std::map<int, int> row;
    for (const int v : patch.inside) row.emplace(v, static_cast<int>(row.size()));
    std::vector<Eigen::Triplet<double>> entries;
    Eigen::MatrixXd right = Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(row.size()), 2);
    for (const auto& [v, r] : row)
      for (const auto& [u, weight] : weights.at(v)) {
        entries.emplace_back(r, r, weight);
        if (const auto at = row.find(u); at != row.end()) {
          entries.emplace_back(r, at->second, -weight);
        } else {
          right(r, 0) += weight * held[u].real();
          right(r, 1) += weight * held[u].imag();
        }
      }
    Eigen::SparseMatrix<double> matrix(right.rows(), right.rows());
    matrix.setFromTriplets(entries.begin(), entries.end());
    const Eigen::MatrixXd solution = Solver(matrix).solve(right);
    for (const auto& [v, r] : row) held[v] = {solution(r, 0), solution(r, 1)};
    return held;
  }

  // The cone has come to lie somewhere inside, and all of its limb beside it. The disk is moved so that it
  // lies at zero, step by step: by a short part of its distance from the ring, the limb as it is, and the
  // less the farther away, which keeps all in its order. False if it does not come there.
  bool recentre(const TipPatch& patch, Roots& roots) const {
    constexpr int most_moves = 40;
    constexpr double part = 0.4;  // the share that moves, (1 - t^2)^2, falls by less than 1.6
    for (int k = 0; k < most_moves; ++k) {
      const RootNumber centre = roots[cone_];
      if (centre == 0.0) return true;
      double room = std::numeric_limits<double>::infinity();
      for (const int v : patch.ring) room = std::min(room, std::abs(roots[v] - centre));
      const RootNumber step = centre * std::min(1.0, part * room / std::abs(centre));
      for (const int v : patch.inside) {
        const double t = std::abs(roots[v] - centre) / room;
        if (t < 1) roots[v] -= step * std::pow(1 - t * t, 2);
      }
      if (step == centre) roots[cone_] = 0;
    }
    return roots[cone_] == 0.0;
  }

  // The weights w of edges from v to u times exp(b . (x_u - x_v)): vertices are drawn into the direction b.
  static TipWeights biased(TipWeights weights, const Roots& x, const RootNumber& b) {
    for (auto& [v, some] : weights)
      for (auto& [u, weight] : some) weight *= std::exp((std::conj(b) * (x.at(u) - x.at(v))).real());
    return weights;
  }

  // The same by weights that draw it there: not symmetric, but positive, which Tutte's embedding asks for (M.
  // S. Floater, "One-to-one piecewise linear mappings over triangulations", 2003). Newton's method, with
  // differences for derivatives. Where the triangles between limb and ring are large, to move their vertices
  // would turn them over.
  bool draw_to_centre(const TipPatch& patch, const Roots& ring, Roots& roots) const {
    using Solver = Eigen::SparseLU<Eigen::SparseMatrix<double>>;
    constexpr int most_steps = 20;
    constexpr double probe = 0.02, longest = 1, near = 1e-14;
    TipWeights weights = weights_inside(patch);
    for (int step = 0; step < most_steps && std::abs(roots[cone_]) > near; ++step) {
      const RootNumber centre = roots[cone_];
      const auto change = [&](const RootNumber& b) {
        return (embedded<Solver>(patch, ring, biased(weights, roots, b))[cone_] - centre) / probe;
      };
      Eigen::Matrix2d derivative;
      for (int k = 0; k < 2; ++k) {
        const RootNumber column = change(k == 0 ? RootNumber(probe, 0) : RootNumber(0, probe));
        derivative.col(k) << column.real(), column.imag();
      }
      Eigen::Vector2d b = -derivative.inverse() * Eigen::Vector2d(centre.real(), centre.imag());
      if (!b.allFinite()) return false;
      b *= std::min(1.0, longest / b.norm());
      weights = biased(std::move(weights), roots, {b.x(), b.y()});
      roots = embedded<Solver>(patch, ring, weights);
    }
    return recentre(patch, roots);
  }

  // Moves the vertices inside; false if that cannot be told.
  bool place(const TipPatch& patch, Centring way) {
    std::optional<std::map<int, SeenFromTip>> ring = seen_ring(patch);
    if (!ring) return false;
    double farthest = 0;
    for (const auto& [v, at] : *ring) farthest = std::max(farthest, distance_from_tip(v, at.frame));
    Roots roots;
    for (const auto& [v, at] : *ring)
      roots[v] =
          std::polar(std::pow(distance_from_tip(v, at.frame) / farthest, 1 / share_), at.angle / share_);
    const Roots held = roots;
    roots = embedded<Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>>>(patch, held, weights_inside(patch));
    if (!(way == Centring::shift ? recentre(patch, roots) : draw_to_centre(patch, held, roots))) return false;
    std::vector<int> reached = patch.ring;
    for (std::size_t k = 0; k < reached.size(); ++k) {
      const int v = reached[k];
      for (const StarTriangle& triangle : site_.stars.around(v))
        for (const auto& [u, element] :
             {std::pair(triangle.a, triangle.element_a), std::pair(triangle.b, triangle.element_b)}) {
          if (u == cone_ || !patch.inside.contains(u) || ring->contains(u)) continue;
          const SeenFromTip& from = ring->at(v);
          const SeenFromTip at = {from.frame * site_.gluing.elements[element],
                                  from.angle + share_ * std::arg(roots[u] / roots[v])};
          const Vector3 there = space_.polar(farthest * std::pow(std::abs(roots[u]), share_), at.angle);
          const Vector3 position = at.frame.inverse() * Vector3(from_centre_.inverse() * there);
          if (!position.allFinite()) return false;
          positions_.move(u, position - positions_.rounded(u));
          ring->emplace(u, at);
          reached.push_back(u);
        }
    }
    return true;
  }

  const RepairSite& site_;
  MovablePositions& positions_;
  Space space_;
  int cone_;

  // Of a whole turn.
  double share_;
  Vector3 centre_;
  Isometry from_centre_;
};

}  // namespace

std::vector<int> unroll_tip(const RepairSite& site, const ConeCopies& cone, MovablePositions& positions) {
  return Tip(site, cone, positions).run();
}

std::vector<int> unroll_tips(const RepairSite& site, MovablePositions& positions) {
  std::vector<int> result;
  for (const ConeCopies& cone : site.gluing.boundary.cones) {
    const bool is_great = cone.mark.kind == ConeKind::rotation && cone.mark.angle > pi;
    if (!is_great || !Tip(site, cone, positions).is_turned()) continue;
    const std::vector<int> moved = unroll_tip(site, cone, positions);
    result.insert(result.end(), moved.begin(), moved.end());
  }
  std::sort(result.begin(), result.end());
  result.erase(std::unique(result.begin(), result.end()), result.end());
  return result;
}

}  // namespace orbitutte
