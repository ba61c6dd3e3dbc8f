// SPDX-License-Identifier: MIT
#include "orbitutte/orbifold/seam_group.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <optional>
#include <unordered_map>

#include "orbitutte/geometry/precise_isometry.h"

namespace orbitutte {
namespace {

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
    std::unordered_map<int, const Mark*> mark_at;
    for (const ConeCopies& cone : boundary_.cones) mark_at[cone.vertex] = &cone.mark;
    if (count_ > 0 && !is_closed_) mark_at.try_emplace(source_at(0), nullptr);
    for (int place = 0; place < count_; ++place) {
      const auto at = mark_at.find(source_at(place));
      if (at == mark_at.end() || !met_at_.emplace(at->first, place).second) continue;
      MetMark met = {place, precise_retract(space_, boundary_.position(boundary_.loop[place])), {}};
      if (at->second && at->second->kind == ConeKind::rotation)
        met.rotation = precise_rotation(space_, met.position, precise_angle<Real>(*at->second));
      met_.push_back(std::move(met));
    }
    if (is_closed_ && !met_.empty()) close();
  }

  // Puts the first cone where the others leave it.
  void close() {
    MetMark& first = met_.front();
    const Matrix others = product_between(first.place, count_);
    first.position = precise_fixed_point(space_, others, first.position.template cast<double>());
    first.rotation.reset();
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
