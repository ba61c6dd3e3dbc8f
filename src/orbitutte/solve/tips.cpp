// SPDX-License-Identifier: MIT
#include "orbitutte/solve/tips.h"

#include <Eigen/LU>
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

#include "orbitutte/geometry/precise.h"

namespace orbitutte {
namespace {

using std::numbers::pi;

// Of the vertices of a patch in the plane of roots.
using Roots = Eigen::Matrix<Precise, Eigen::Dynamic, 2>;
using RoundedRoots = Eigen::Matrix<double, Eigen::Dynamic, 2>;
using RootNumber = std::complex<double>;

// How the cone comes to lie at zero in the plane of roots.
enum class Centring { shift, bias };

constexpr std::size_t most_vertices_around_tip = 6000;
constexpr int patience_with_rings = 12;    // rings that do not help, after one that did
constexpr double least_tip_weight = 0.01;  // in place of weights that are not positive

// An edge from a vertex inside a patch.
struct TipEdge {
  int from, to;
  double weight;
};

// The patch in the plane of roots. Its vertices are numbered, those inside first, then the ring, which is
// held.
class RootDisk {
 public:
  // ring: where it is held; cone: its number.
  RootDisk(std::vector<TipEdge> edges, const RoundedRoots& ring, int inside, int cone)
      : edges_(std::move(edges)), inside_(inside), cone_(cone), x_(inside + ring.rows(), 2) {
    x_ << RoundedRoots::Zero(inside, 2), ring;
    solver_.analyzePattern(matrix());
  }

  // Tutte's embedding of the vertices inside, and then the cone at zero: every vertex to so many digits of
  // its distance from the cone as doubles have, however near that is. Nothing if the cone does not come
  // there.
  std::optional<RoundedRoots> centred(Centring way) {
    if (!settle() || (way == Centring::bias && !draw_to_centre())) return std::nullopt;
    Roots x = with_more_digits();
    if (!recentre(x)) return std::nullopt;
    return RoundedRoots(x.cast<double>());
  }

 private:
  Eigen::SparseMatrix<double> matrix() const {
    std::vector<Eigen::Triplet<double>> entries;
    entries.reserve(2 * edges_.size());
    for (const auto& [from, to, weight] : edges_) {
      entries.emplace_back(from, from, weight);
      if (to < inside_) entries.emplace_back(from, to, -weight);
    }
    Eigen::SparseMatrix<double> result(inside_, inside_);
    result.setFromTriplets(entries.begin(), entries.end());
    return result;
  }

  // Of every vertex inside, sum_u w_vu (x_u - x_v).
  template <typename SomeRoots>
  SomeRoots pulls(const SomeRoots& x) const {
    using Real = typename SomeRoots::Scalar;
    SomeRoots result = SomeRoots::Zero(inside_, 2);
    for (const auto& [from, to, weight] : edges_)
      result.row(from) += Real(weight) * (x.row(to) - x.row(from));
    return result;
  }

  // All pulls zero; false if that fails.
  bool settle() {
    solver_.factorize(matrix());
    if (solver_.info() != Eigen::Success) return false;
    x_.topRows(inside_) += solver_.solve(pulls(x_));
    return x_.allFinite();
  }

  // The cone has come to lie somewhere inside, and all of its limb beside it: by weights it is drawn to zero,
  // which are not symmetric, but positive, as Tutte's embedding asks for (M. S. Floater, "One-to-one
  // piecewise linear mappings over triangulations", 2003): w_vu times exp(b . (x_u - x_v)) draws vertices
  // into the direction b. Newton's method for b; with A x = 0 for all pulls,
  //   A dx/db_k = sum_u w_vu (x_u - x_v)_k (x_u - x_v)
  // Where the triangles between limb and ring are large, to move their vertices would turn them over.
  bool draw_to_centre() {
    constexpr int most_steps = 20;
    constexpr double longest = 1, near = 1e-14;
    for (int step = 0; step < most_steps && x_.row(cone_).norm() > near; ++step) {
      Eigen::MatrixX4d change = Eigen::MatrixX4d::Zero(inside_, 4);
      for (const auto& [from, to, weight] : edges_) {
        const Eigen::RowVector2d away = x_.row(to) - x_.row(from);
        change.row(from).head<2>() += weight * away.x() * away;
        change.row(from).tail<2>() += weight * away.y() * away;
      }
      const Eigen::RowVector4d of_cone = Eigen::MatrixX4d(solver_.solve(change)).row(cone_);
      Eigen::Matrix2d derivative;
      derivative << of_cone.head<2>().transpose(), of_cone.tail<2>().transpose();
      Eigen::Vector2d b = -derivative.inverse() * x_.row(cone_).transpose();
      if (!b.allFinite()) return false;
      b *= std::min(1.0, longest / b.norm());
      for (auto& [from, to, weight] : edges_) weight *= std::exp((x_.row(to) - x_.row(from)).dot(b));
      if (!settle()) return false;
    }
    return true;
  }

  // Pulls are summed with all digits, and each solution in doubles gains as many as they have.
  Roots with_more_digits() const {
    constexpr int most_rounds = 8;
    constexpr double settled = 1e-14;
    Roots x = x_.cast<Precise>();
    for (int round = 0; round < most_rounds; ++round) {
      const RoundedRoots step = solver_.solve(RoundedRoots(pulls(x).cast<double>()));
      x.topRows(inside_) += step.cast<Precise>();
      bool has_settled = true;
      for (int v = 0; v < inside_; ++v)
        has_settled = has_settled && (step.row(v) - step.row(cone_)).norm() <= settled * distance(x, v);
      if (has_settled) break;
    }
    return x;
  }

  // From the cone.
  double distance(const Roots& x, int v) const {
    return Eigen::RowVector2d((x.row(v) - x.row(cone_)).cast<double>()).norm();
  }

  // The disk is moved so that the cone lies at zero, step by step: by a short part of its distance from the
  // ring, the limb as it is, and the less the farther away, which keeps all in its order. False if it does
  // not come there.
  bool recentre(Roots& x) const {
    constexpr int most_moves = 40;
    constexpr double part = 0.4;  // the share that moves, (1 - t^2)^2, falls by less than 1.6
    for (int k = 0; k < most_moves; ++k) {
      const double length = Eigen::RowVector2d(x.row(cone_).cast<double>()).norm();
      if (length == 0) return true;
      double room = std::numeric_limits<double>::infinity();
      for (int v = inside_; v < x.rows(); ++v) room = std::min(room, distance(x, v));
      Eigen::Matrix<Precise, 1, 2> step = x.row(cone_);
      if (part * room < length) step *= Precise(part * room / length);
      Eigen::VectorXd t(inside_);
      for (int v = 0; v < inside_; ++v) t[v] = distance(x, v) / room;
      for (int v = 0; v < inside_; ++v)
        if (const double t2 = t[v] * t[v]; t2 < 1) x.row(v) -= step - Precise(t2 * (2 - t2)) * step;
    }
    return false;
  }

  std::vector<TipEdge> edges_;
  int inside_, cone_;
  RoundedRoots x_;
  Eigen::SparseLU<Eigen::SparseMatrix<double>> solver_;
};

// Where a vertex is seen from the cone: its image under `frame`, the difference of that from the cone, the
// cone moved to (0, 0, 1), and its angle, which goes on around the cone.
struct SeenFromTip {
  Isometry frame;
  Vector3 difference = Vector3::Zero();
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
  bool is_turned() { return count_turned(with_neighbours({cone_})) > 0; }

  // All faces positive, or, if no patch does that, the fewest not: thin ones are left for others to repair.
  std::vector<int> run() {
    std::optional<TipPatch> best;
    Centring best_way = Centring::shift;
    int fewest = std::numeric_limits<int>::max();
    std::set<int> inside = {cone_};
    for (int vain = 0; fewest > 0 && vain <= patience_with_rings; vain += best ? 1 : 0) {
      inside = with_neighbours(inside);
      if (inside.size() > most_vertices_around_tip || !may_all_move(inside)) break;
      const std::optional<TipPatch> patch = patch_of(inside);
      if (!patch) continue;
      const int turned_before = count_turned(patch->inside);
      for (const Centring way : {Centring::shift, Centring::bias}) {
        if (fewest == 0) break;
        const std::size_t before = positions_.moves();
        const int turned = place(*patch, way) ? count_turned_now(patch->inside) : turned_before;
        positions_.take_back(before);
        if (turned >= std::min(fewest, turned_before)) continue;
        fewest = turned;
        best = patch;
        best_way = way;
        vain = 0;
      }
    }
    if (!best) return {};
    place(*best, best_way);
    return moved(best->inside);
  }

 private:
  // A star, looked up once.
  const std::vector<StarTriangle>& star(int v) {
    const auto [at, is_new] = stars_.try_emplace(v);
    if (is_new) at->second = site_.stars.around(v);
    return at->second;
  }

  std::set<int> with_neighbours(const std::set<int>& vertices) {
    std::set<int> result = vertices;
    for (const int v : vertices)
      for (const StarTriangle& triangle : star(v)) result.insert({triangle.a, triangle.b});
    return result;
  }

  // Without other marks and mirrors.
  bool may_all_move(const std::set<int>& inside) const {
    return std::all_of(inside.begin(), inside.end(),
                       [&](int v) { return v == cone_ || site_.gluing.boundary.basis_of[v] == in_space; });
  }

  template <typename IsTurned>
  int count_faces_at(const std::set<int>& inside, const IsTurned& is_turned) {
    std::set<int> faces;
    for (const int v : inside)
      for (const StarTriangle& triangle : star(v)) faces.insert(triangle.face);
    return static_cast<int>(std::count_if(faces.begin(), faces.end(), is_turned));
  }

  int count_turned_now(const std::set<int>& inside) {
    return count_faces_at(inside, [&](int face) { return !positions_.is_positive(face); });
  }

  // Before anything was moved: each face is looked at once.
  int count_turned(const std::set<int>& inside) {
    return count_faces_at(inside, [&](int face) {
      const auto [at, is_new] = was_turned_.try_emplace(face, false);
      if (is_new) at->second = !positions_.is_positive(face);
      return at->second;
    });
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
  Surround surround_of(const std::set<int>& inside) {
    Surround around;
    for (const int v : inside)
      for (const StarTriangle& triangle : star(v))
        if (!inside.contains(triangle.a) && !inside.contains(triangle.b) &&
            !around.next.emplace(triangle.a, triangle.b).second)
          around.pinched.insert(triangle.a);
    for (const int v : inside)
      for (const StarTriangle& triangle : star(v))
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
  std::optional<TipPatch> patch_of(std::set<int> inside) {
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
  std::optional<int> element_between(int v, int u) {
    for (const StarTriangle& triangle : star(v)) {
      if (triangle.a == u) return triangle.element_a;
      if (triangle.b == u) return triangle.element_b;
    }
    return std::nullopt;
  }

  // A neighbour u of a vertex v, as the cone sees it across v.
  SeenFromTip seen_across(const SeenFromTip& from, int v, int u, int element) const {
    const Vector3 step = from.frame * positions_.difference(v, u, element);
    return {from.frame * site_.gluing.elements[element], from.difference + from_centre_ * step, from.angle};
  }

  static double bearing(const Vector3& p) { return std::atan2(p.y(), p.x()); }

  double distance_from_tip(const SeenFromTip& at) const {
    return space_.length_of_half_sn(0.5 * space_.norm(at.difference));
  }

  // How the cone sees a vertex, along edges inside the patch.
  std::optional<SeenFromTip> first_sight(int wanted, const std::set<int>& inside) {
    std::map<int, SeenFromTip> seen = {{cone_, {}}};
    std::vector<int> reached = {cone_};
    for (std::size_t k = 0; k < reached.size(); ++k) {
      const int v = reached[k];
      for (const StarTriangle& triangle : star(v))
        for (const auto& [u, element] :
             {std::pair(triangle.a, triangle.element_a), std::pair(triangle.b, triangle.element_b)}) {
          if (seen.contains(u)) continue;
          seen.emplace(u, seen_across(seen.at(v), v, u, element));
          if (inside.contains(u)) reached.push_back(u);
        }
    }
    const auto at = seen.find(wanted);
    if (at == seen.end()) return std::nullopt;
    at->second.angle = bearing(at->second.difference);
    return at->second;
  }

  // The ring as it is seen on a walk around the cone; nothing if it does not run around it once.
  std::optional<std::map<int, SeenFromTip>> seen_ring(const TipPatch& patch) {
    const std::optional<SeenFromTip> first = first_sight(patch.ring.front(), patch.inside);
    if (!first) return std::nullopt;
    SeenFromTip at = *first;
    std::map<int, SeenFromTip> result;
    for (std::size_t k = 0; k < patch.ring.size(); ++k) {
      const int v = patch.ring[k], u = patch.ring[(k + 1) % patch.ring.size()];
      result[v] = at;
      const std::optional<int> element = element_between(v, u);
      if (!element) return std::nullopt;
      const double before = bearing(at.difference);
      at = seen_across(at, v, u, *element);
      at.angle += std::remainder(bearing(at.difference) - before, 2 * pi);
    }
    constexpr double much = 0.1;
    return std::abs(at.angle - first->angle - 2 * pi * share_) < much ? std::optional(result) : std::nullopt;
  }

  // Cotangents of the angle opposite to a and b's common edges, half of what an edge weighs.
  static double half_cotangent(const Vector3& apex, const Vector3& a, const Vector3& b) {
    const Vector3 u = a - apex, v = b - apex;
    return 0.5 * u.dot(v) / std::max(u.cross(v).norm(), 1e-300);
  }

  // By neighbour.
  std::map<int, double> weights_at(int v) {
    std::map<int, double> weights;
    const auto source = [&](int u) -> Vector3 { return site_.surface.V.row(u); };
    for (const StarTriangle& t : star(v)) {
      weights[t.a] += half_cotangent(source(t.b), source(v), source(t.a));
      weights[t.b] += half_cotangent(source(t.a), source(v), source(t.b));
    }
    for (auto& [u, weight] : weights) weight = weight > least_tip_weight ? weight : least_tip_weight;
    return weights;
  }

  // Where the vertices of a patch come to lie in the plane of roots, the ring at the roots of where it is;
  // lengths are parts of the farthest distance of the ring.
  struct RootMap {
    std::map<int, SeenFromTip> seen;
    double farthest = 0;
    std::map<int, RootNumber> roots;
  };
  std::optional<RootMap> root_map(const TipPatch& patch, Centring way) {
    std::optional<std::map<int, SeenFromTip>> seen = seen_ring(patch);
    if (!seen) return std::nullopt;
    RootMap result = {std::move(*seen), 0, {}};
    for (const auto& [v, at] : result.seen)
      result.farthest = std::max(result.farthest, distance_from_tip(at));
    std::map<int, int> number;
    for (const int v : patch.inside) number.emplace(v, static_cast<int>(number.size()));
    for (const int v : patch.ring) number.emplace(v, static_cast<int>(number.size()));
    RoundedRoots ring(static_cast<Eigen::Index>(patch.ring.size()), 2);
    for (std::size_t k = 0; k < patch.ring.size(); ++k) {
      const SeenFromTip& at = result.seen.at(patch.ring[k]);
      const RootNumber root =
          std::polar(std::pow(distance_from_tip(at) / result.farthest, 1 / share_), at.angle / share_);
      ring.row(static_cast<Eigen::Index>(k)) << root.real(), root.imag();
    }
    std::vector<TipEdge> edges;
    for (const int v : patch.inside)
      for (const auto& [u, weight] : weights_at(v)) edges.push_back({number.at(v), number.at(u), weight});
    RootDisk disk(std::move(edges), ring, static_cast<int>(patch.inside.size()), number.at(cone_));
    const std::optional<RoundedRoots> roots = disk.centred(way);
    if (!roots) return std::nullopt;
    for (const auto& [v, k] : number) result.roots[v] = {(*roots)(k, 0), (*roots)(k, 1)};
    return result;
  }

  // From the ring inward, under which angles the cone is to see the vertices inside.
  void look_inward(const TipPatch& patch, RootMap& map) {
    std::vector<int> reached = patch.ring;
    for (std::size_t k = 0; k < reached.size(); ++k) {
      const int v = reached[k];
      for (const StarTriangle& triangle : star(v))
        for (const auto& [u, element] :
             {std::pair(triangle.a, triangle.element_a), std::pair(triangle.b, triangle.element_b)}) {
          if (u == cone_ || !patch.inside.contains(u) || map.seen.contains(u)) continue;
          SeenFromTip at = seen_across(map.seen.at(v), v, u, element);
          at.angle += share_ * std::arg(map.roots.at(u) / map.roots.at(v));
          map.seen.emplace(u, at);
          reached.push_back(u);
        }
    }
  }

  // The point at the power of a root, less (0, 0, 1).
  Vector3 power(const RootNumber& root, double farthest, double angle) const {
    const Vector3 p = space_.polar(farthest * std::pow(std::abs(root), share_), angle);
    return {p.x(), p.y(), -space_.curvature() * p.head<2>().squaredNorm() / (1 + p.z())};
  }

  // From the cone outward, each vertex beside one that is nearer to it, so that all have as many digits of
  // their distance from it as doubles have.
  bool put_outward(const TipPatch& patch, const RootMap& map) {
    std::set<int> reached = {cone_};
    std::vector<int> order = {cone_};
    for (std::size_t k = 0; k < order.size(); ++k) {
      const int v = order[k];
      for (const StarTriangle& triangle : star(v))
        for (const int u : {triangle.a, triangle.b}) {
          if (!patch.inside.contains(u) || !reached.insert(u).second) continue;
          const SeenFromTip& at = map.seen.at(u);
          const RootNumber here = map.roots.at(u), beside = map.roots.at(v);
          Vector3 away = power(here, map.farthest, at.angle);
          if (v != cone_) away -= power(beside, map.farthest, at.angle + share_ * std::arg(beside / here));
          const Vector3 offset = at.frame.inverse() * Vector3(from_centre_.inverse() * away);
          if (!offset.allFinite()) return false;
          positions_.put(u, v, *element_between(u, v), offset);
          order.push_back(u);
        }
    }
    return true;
  }

  // Moves the vertices inside; false if that cannot be told.
  bool place(const TipPatch& patch, Centring way) {
    std::optional<RootMap> map = root_map(patch, way);
    if (!map) return false;
    look_inward(patch, *map);
    return put_outward(patch, *map);
  }

  const RepairSite& site_;
  MovablePositions& positions_;
  Space space_;
  int cone_;

  // Of a whole turn.
  double share_;
  Vector3 centre_;
  Isometry from_centre_;
  std::map<int, std::vector<StarTriangle>> stars_;
  std::map<int, bool> was_turned_;
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
