// SPDX-License-Identifier: MIT
#include "orbitutte/orbifold/seam_group.h"

#include <Eigen/Geometry>
#include <Eigen/QR>
#include <algorithm>
#include <limits>
#include <optional>
#include <unordered_map>

#include "orbitutte/geometry/precise_isometry.h"
#include "orbitutte/orbifold/moduli.h"

namespace orbitutte {
namespace {

// The angles of the marks. In the plane those that are no 2 pi/n are doubles that add up but for rounding:
// without corners, which would take it, the rest is shared out among them.
template <typename Real>
std::vector<Real> exact_angles(Space space, bool is_closed, const std::vector<ConeCopies>& marks) {
  const Real& two_pi = boost::math::constants::two_pi<Real>();
  std::vector<Real> angles;
  std::vector<std::size_t> inexact;
  bool has_corners = false;
  Real rest = is_closed ? Real(2 * two_pi) : two_pi;  // 2 pi chi - sum of (2 pi - angle)
  for (const ConeCopies& at : marks) {
    if (at.mark.kind != ConeKind::rotation) has_corners = true;
    if (precise_angle<Real>(at.mark) == Real(at.mark.angle)) inexact.push_back(angles.size());
    angles.push_back(precise_angle<Real>(at.mark));
    rest -= two_pi - angles.back();
  }
  if (space.curvature() != 0 || has_corners) return angles;
  for (const std::size_t k : inexact) angles[k] -= rest / Real(static_cast<int>(inexact.size()));
  return angles;
}

// The gluings of all seams, from a walk along the boundary.
template <typename Real>
class GluingWalk {
 public:
  GluingWalk(const Target& target, const GluedBoundary<Real>& boundary)
      : space_(target.space),
        is_closed_(target.topology == Topology::sphere),
        boundary_(boundary),
        count_(static_cast<int>(boundary.loop.size())) {
    for (int place = 0; place < count_; ++place) place_[boundary.loop[place]] = place;
    meet_marks();
    lay_mirrors();
  }

  std::vector<PreciseElement<Real>> generators() const {
    std::vector<PreciseElement<Real>> result;
    for (std::size_t s = 0; s < boundary_.seams.size(); ++s) {
      const Seam& seam = boundary_.seams[s];
      result.push_back({seam.transform, seam.is_mirror() ? mirrors_.at(s) : gluing(seam)});
    }
    return result;
  }

  std::vector<Vector3Of<Real>> corners() const {
    std::vector<Vector3Of<Real>> result;
    for (const MetMark& mark : met_) result.push_back(mark.position);
    return result;
  }

 private:
  using Matrix = Matrix3Of<Real>;
  using Point = Vector3Of<Real>;

  // A mark, or where the loop of a disk without corners begins, and the place of the copy met first.
  struct MetMark {
    int place = 0;
    Point position;
    Real angle = 0;
    std::optional<Matrix> rotation;  // of cones
  };

  // Along a mirror, which cuts may interrupt: from one corner to the next.
  struct MirrorPiece {
    std::size_t seam = 0;
    int begin = 0, end = 0;
  };

  int source_at(int place) const { return boundary_.source_vertex[boundary_.loop[place % count_]]; }

  int place_of(int cut_vertex) const {
    const auto at = place_.find(cut_vertex);
    if (at == place_.end()) throw ArgumentError("a seam leaves the boundary of the cut mesh");
    return at->second;
  }

  void meet_marks() {
    const std::vector<Real> angles = exact_angles<Real>(space_, is_closed_, boundary_.cones);
    std::unordered_map<int, int> mark_at;
    for (std::size_t k = 0; k < boundary_.cones.size(); ++k)
      mark_at[boundary_.cones[k].vertex] = static_cast<int>(k);
    if (count_ > 0 && !is_closed_) mark_at.try_emplace(source_at(0), -1);
    for (int place = 0; place < count_; ++place) {
      const auto at = mark_at.find(source_at(place));
      if (at == mark_at.end() || !met_at_.emplace(at->first, place).second) continue;
      MetMark met = {place, precise_retract(space_, boundary_.position(boundary_.loop[place])), 0, {}};
      if (const int k = at->second; k >= 0 && boundary_.cones[k].mark.kind == ConeKind::rotation) {
        met.angle = angles[k];
        met.rotation = rotation_about(met);
      }
      met_.push_back(std::move(met));
    }
    if (is_closed_ && !met_.empty()) close();
  }

  // Moves the marks so that the product of all rotations is the identity: of curved surfaces all of them, as
  // little as possible, and then, as in the plane, where the angles alone close, the first to where the
  // others leave it.
  void close() {
    if (space_.curvature() != 0) turn_by_angle();
    MetMark& first = met_.front();
    const Matrix others = product_between(first.place, count_);
    first.position = precise_fixed_point(space_, others, first.position.template cast<double>());
    first.rotation.reset();
  }

  // Newton's method with one Jacobian in doubles: each step gains some ten digits.
  void turn_by_angle() {
    constexpr int most_steps = 400;
    const Real finest = ldexp(Real(1), 40 - std::numeric_limits<Real>::digits);
    Points marks(static_cast<Eigen::Index>(met_.size()), 3);
    std::vector<double> angles;
    for (std::size_t k = 0; k < met_.size(); ++k) {
      marks.row(static_cast<Eigen::Index>(k)) = met_[k].position.template cast<double>();
      angles.push_back(static_cast<double>(met_[k].angle));
    }
    const Moduli moduli(space_, angles);
    const auto solver = moduli.closing_jacobian(marks).completeOrthogonalDecomposition();
    Real least = 1;
    for (int step = 0; step < most_steps; ++step) {
      const Point rest = closing_defect();
      const Real size = std::max({Real(abs(rest[0])), Real(abs(rest[1])), Real(abs(rest[2]))});
      if (size < finest || !(size < least / 10)) break;
      least = size;
      const Point scaled = rest / size;  // which doubles hold, however small the rest is
      const Points moves = moduli.tangents(marks, -solver.solve(scaled.template cast<double>()));
      for (std::size_t k = 0; k < met_.size(); ++k)
        move(met_[k], size * moves.row(static_cast<Eigen::Index>(k)).transpose().template cast<Real>());
    }
  }

  // The product of all rotations at first order (Moduli::closing).
  Point closing_defect() const {
    const Matrix M = met_.front().rotation.value() * product_between(met_.front().place, count_);
    const int k = space_.curvature();
    return {(k * M(2, 1) - M(1, 2)) / 2, (M(0, 2) - k * M(2, 0)) / 2, (M(1, 0) - M(0, 1)) / 2};
  }

  void move(MetMark& mark, const Point& step) const {
    mark.position = precise_retract(space_, Point(mark.position + step));
    mark.rotation = rotation_about(mark);
  }

  // A half turn is 2 p n^T - 1, with n = (k x, k y, z), without series for sines.
  Matrix rotation_about(const MetMark& mark) const {
    const int k = space_.curvature();
    if (k == 0 || mark.angle != boost::math::constants::pi<Real>())
      return precise_rotation(space_, mark.position, mark.angle);
    const Point n(k * mark.position.x(), k * mark.position.y(), mark.position.z());
    return Real(2) * (mark.position * n.transpose()) - Matrix::Identity();
  }

  // Of the rotations about the cones that are met after `after`, up to `last`.
  Matrix product_between(int after, int last) const {
    Matrix product = Matrix::Identity();
    for (const MetMark& mark : met_)
      if (mark.rotation && after < mark.place && mark.place <= last) product = product * *mark.rotation;
    return product;
  }

  // Does the loop go along the bank from its front to its back?
  bool runs_forward(const std::vector<int>& bank) const {
    return boundary_.loop[(place_of(bank[0]) + 1) % count_] == bank[1];
  }

  // left = gluing * right.
  Matrix gluing(const Seam& seam) const {
    if (seam.left.size() < 2 || seam.transform.reverses_orientation())
      throw ArgumentError("a seam is none of a cut along a tree");
    if (!runs_forward(seam.left)) return precise_inverse(space_, beyond(seam.right, seam.left));
    return beyond(seam.left, seam.right);
  }

  // The gluing of a bank that runs forward, from another: what lies between them must not be where the loop
  // begins.
  Matrix beyond(const std::vector<int>& forward, const std::vector<int>& back) const {
    const int begin = place_of(forward.front()), end = place_of(back.back());
    if (begin < end) return product_between(begin, end);
    return precise_inverse(space_, product_between(end, begin));
  }

  std::vector<MirrorPiece> mirror_pieces() const {
    std::vector<MirrorPiece> pieces;
    for (std::size_t s = 0; s < boundary_.seams.size(); ++s) {
      const std::vector<int>& bank = boundary_.seams[s].left;
      if (!boundary_.seams[s].is_mirror()) continue;
      if (bank.size() < 2) throw ArgumentError("a mirror is a point");
      const bool is_forward = runs_forward(bank);
      const int begin = place_of(is_forward ? bank.front() : bank.back()),
                end = place_of(is_forward ? bank.back() : bank.front());
      pieces.push_back({s, begin, end > begin ? end : end + count_});
    }
    std::sort(pieces.begin(), pieces.end(),
              [](const MirrorPiece& a, const MirrorPiece& b) { return a.begin < b.begin; });
    return pieces;
  }

  // All that is seen of a mirror, beyond the cuts that end on it, from the corner where it begins.
  void lay_mirrors() {
    int corner = 0;
    std::vector<MirrorPiece> along;
    for (const MirrorPiece& piece : mirror_pieces()) {
      along.push_back(piece);
      const auto at = met_at_.find(source_at(piece.end));
      if (at == met_at_.end()) continue;
      const bool is_last = at->second == 0;  // it ends where the loop begins
      const Matrix through = product_between(corner, is_last ? count_ : piece.begin);
      lay_mirror(along, corner, through * position_met(at->second));
      corner = at->second;
      along.clear();
    }
    if (!along.empty()) throw ArgumentError("a mirror does not end at a corner");
  }

  void lay_mirror(const std::vector<MirrorPiece>& along, int corner, const Point& end) {
    const Point line = position_met(corner).cross(end);
    const Matrix reflection = precise_reflection(space_, line);
    for (const MirrorPiece& piece : along) {
      const Matrix behind = product_between(corner, piece.begin);
      mirrors_[piece.seam] = precise_inverse(space_, behind) * reflection * behind;
    }
  }

  const Point& position_met(int place) const {
    return std::find_if(met_.begin(), met_.end(), [&](const MetMark& mark) { return mark.place == place; })
        ->position;
  }

  Space space_;
  bool is_closed_;
  const GluedBoundary<Real>& boundary_;
  int count_;
  std::unordered_map<int, int> place_;   // of a cut vertex
  std::unordered_map<int, int> met_at_;  // where a mark, an input vertex, is met first
  std::vector<MetMark> met_;
  std::unordered_map<std::size_t, Matrix> mirrors_;  // of seams
};

}  // namespace

template <typename Real>
PreciseGroup<Real> group_of_boundary(const Target& target, const GluedBoundary<Real>& boundary) {
  if (!target.has_free_tile) return PreciseGroup<Real>(target);
  const GluingWalk<Real> walk(target, boundary);
  return PreciseGroup<Real>(target.space, walk.generators(), walk.corners());
}

template PreciseGroup<Precise> group_of_boundary(const Target&, const GluedBoundary<Precise>&);
template PreciseGroup<MorePrecise> group_of_boundary(const Target&, const GluedBoundary<MorePrecise>&);
template PreciseGroup<MostPrecise> group_of_boundary(const Target&, const GluedBoundary<MostPrecise>&);

}  // namespace orbitutte
