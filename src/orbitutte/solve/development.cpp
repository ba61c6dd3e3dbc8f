// SPDX-License-Identifier: MIT
#include "orbitutte/solve/development.h"

#include <Eigen/Geometry>
#include <deque>

namespace orbitutte {
namespace {

// The point at a distance from p in the direction that is turned counterclockwise, by an angle, from that to
// q.
struct PolarPlace {
  double angle, distance;
};

Vector3 placed(Space space, const Vector3& p, const Vector3& q, const PolarPlace& place) {
  const Vector3 towards = space.tangent(p, q - p);
  const double length = space.norm(towards);
  const Vector3 ahead = length > 0 ? Vector3(towards / length)
                                   : Vector3(space.to_origin(p).inverse() * Vector3(Vector3::UnitX()));
  Vector3 left = p.cross(ahead);
  left.z() *= space.curvature();
  return space.retract(
      space.at(p, std::cos(place.angle) * ahead + std::sin(place.angle) * left, place.distance));
}

// Goes over the triangles of a cut mesh from each to those beside it.
class Layout {
 public:
  Layout(const Surface& surface, const CutMesh& cut, Space space, const ConformalMetric& metric)
      : surface_(surface),
        cut_(cut),
        space_(space),
        metric_(metric),
        positions_(cut.vertex_count(), 3),
        is_placed_(cut.vertex_count(), 0),
        is_met_(cut.F.rows(), 0) {}

  Points run() {
    begin();
    while (!next_.empty() || !flat_.empty()) {
      std::deque<int>& some = next_.empty() ? flat_ : next_;
      const int f = some.front();
      some.pop_front();
      for (int h = 3 * f; h < 3 * f + 3; ++h) cross(h);
    }
    return std::move(positions_);
  }

 private:
  void put(int vertex, const Vector3& position) {
    positions_.row(vertex) = position;
    is_placed_[vertex] = 1;
  }

  // The first triangle that is not flat.
  void begin() {
    int f = 0;
    while (f + 1 < cut_.F.rows() && metric_.is_flat[f]) ++f;
    const Vector3 p = Space::origin(), q = space_.polar(metric_.lengths(f, 0), 0);
    put(cut_.F(f, 0), p);
    put(cut_.F(f, 1), q);
    put_apex(3 * f);
    is_met_[f] = 1;
    next_.push_back(f);
  }

  // The third corner of the triangle on the left of a half-edge whose ends lie in their places.
  void put_apex(int h) {
    const int last = previous_halfedge(h), apex = halfedge_origin(cut_.F, last);
    if (is_placed_[apex]) return;
    const PolarPlace place = {metric_.angles.data()[h], metric_.lengths.data()[last]};
    put(apex, placed(space_, positions_.row(halfedge_origin(cut_.F, h)),
                     positions_.row(halfedge_target(cut_.F, h)), place));
  }

  // To the triangle on the other side, if the cut does not run along the half-edge.
  void cross(int h) {
    const int g = surface_.connectivity.opposite[h];
    if (g < 0 || is_met_[g / 3]) return;
    if (halfedge_origin(cut_.F, g) != halfedge_target(cut_.F, h) ||
        halfedge_target(cut_.F, g) != halfedge_origin(cut_.F, h))
      return;
    is_met_[g / 3] = 1;
    put_apex(g);
    (metric_.is_flat[g / 3] ? flat_ : next_).push_back(g / 3);
  }

  const Surface& surface_;
  const CutMesh& cut_;
  Space space_;
  const ConformalMetric& metric_;
  Points positions_;
  std::vector<char> is_placed_, is_met_;
  std::deque<int> next_, flat_;
};

}  // namespace

Points developed(const Surface& surface, const CutMesh& cut, Space space, const ConformalMetric& metric) {
  const Points positions = Layout(surface, cut, space, metric).run();
  if (space.is_closed()) return positions;
  const Vector3 middle = space.retract(positions.colwise().mean().transpose());
  return space.to_origin(middle).on_rows(positions);
}

}  // namespace orbitutte
