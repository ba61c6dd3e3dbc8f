// SPDX-License-Identifier: MIT
#include "orbitutte/solve/development.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <queue>
#include <utility>

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
  const Vector3 left = space.turned_left(p, ahead);
  return space.retract(
      space.at(p, std::cos(place.angle) * ahead + std::sin(place.angle) * left, place.distance));
}

// Goes over the triangles of a cut mesh from each to those beside it, always across the longest side: a walk
// through small triangles knows directions less exactly.
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
    while (!waiting_.empty()) {
      const int h = waiting_.top().second;
      waiting_.pop();
      if (is_met_[h / 3]) continue;
      put_apex(h);
      leave(h / 3);
    }
    return std::move(positions_);
  }

 private:
  void put(int vertex, const Vector3& position) {
    positions_.row(vertex) = position;
    is_placed_[vertex] = 1;
  }

  // At the longest side.
  void begin() {
    Eigen::Index f = 0, k = 0;
    metric_.lengths.maxCoeff(&f, &k);
    const int h = static_cast<int>(3 * f + k);
    put(halfedge_origin(cut_.F, h), Space::origin());
    put(halfedge_target(cut_.F, h), space_.polar(metric_.lengths(f, k), 0));
    put_apex(h);
    leave(h / 3);
  }

  // The third corner of the triangle on the left of a half-edge whose ends lie in their places.
  void put_apex(int h) {
    const int last = previous_halfedge(h), apex = halfedge_origin(cut_.F, last);
    if (is_placed_[apex]) return;
    const PolarPlace place = {metric_.angles.data()[h], metric_.lengths.data()[last]};
    put(apex, placed(space_, positions_.row(halfedge_origin(cut_.F, h)),
                     positions_.row(halfedge_target(cut_.F, h)), place));
  }

  // The triangles across the sides of one that lies in its place wait, if the cut does not run in between.
  void leave(int f) {
    is_met_[f] = 1;
    for (int h = 3 * f; h < 3 * f + 3; ++h) {
      const int g = surface_.connectivity.opposite[h];
      if (g < 0 || is_met_[g / 3] || halfedge_origin(cut_.F, g) != halfedge_target(cut_.F, h) ||
          halfedge_target(cut_.F, g) != halfedge_origin(cut_.F, h))
        continue;
      const double length = metric_.lengths.data()[h];
      waiting_.push({metric_.is_flat[g / 3] ? length - flat_last : length, g});
    }
  }

  // More than any length between triangles that are not flat.
  static constexpr double flat_last = 1e6;

  const Surface& surface_;
  const CutMesh& cut_;
  Space space_;
  const ConformalMetric& metric_;
  Points positions_;
  std::vector<char> is_placed_, is_met_;

  // Half-edges of triangles beside those that lie in their places, the longest first.
  std::priority_queue<std::pair<double, int>> waiting_;
};

// The point whose distances d from all copies of the marks have the least sum of cosh d.
Vector3 middle_of_marks(Space space, const CutMesh& cut, const Points& positions) {
  Vector3 sum = Vector3::Zero();
  for (const int v : cut.boundary)
    if (std::find(cut.marks.begin(), cut.marks.end(), cut.source_vertex[v]) != cut.marks.end())
      sum += positions.row(v).transpose();
  return space.retract(sum);
}

}  // namespace

Points developed(const Surface& surface, const CutMesh& cut, Space space, const ConformalMetric& metric) {
  Points positions = Layout(surface, cut, space, metric).run();
  if (space.is_closed()) return positions;
  return space.to_origin(middle_of_marks(space, cut, positions)).on_rows(positions);
}

}  // namespace orbitutte
