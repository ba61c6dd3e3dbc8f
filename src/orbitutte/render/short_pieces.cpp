// SPDX-License-Identifier: MIT
#include "orbitutte/render/short_pieces.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "orbitutte/mesh/connectivity.h"

namespace orbitutte {
namespace {

constexpr int most_parts = 48, most_added = 200000;

// Into how many parts a triangle is to be divided across, and its shortest side (half-edge 0, 1 or 2).
struct Division {
  int parts = 1, shortest = 0;
};

Division division_of(const Points& V, const Triangles& F, Eigen::Index f) {
  constexpr double stout = 6;  // times as long as wide, or less
  std::array<double, 3> length;
  for (int k = 0; k < 3; ++k) length[k] = (V.row(F(f, (k + 1) % 3)) - V.row(F(f, k))).norm();
  const auto [shortest, longest] = std::minmax_element(length.begin(), length.end());
  const Vector3 ab = V.row(F(f, 1)) - V.row(F(f, 0)), ac = V.row(F(f, 2)) - V.row(F(f, 0));
  const double width = ab.cross(ac).norm() / *longest;
  const double parts = std::clamp(*longest / (stout * width), 1.0, double{most_parts});  // 1 where it is NaN
  return {static_cast<int>(parts), static_cast<int>(shortest - length.begin())};
}

// Of every edge: the number of parts that either of its triangles needs.
std::vector<int> parts_of_edges(const std::vector<Division>& divisions, const Connectivity& connectivity) {
  long long wanted = 0;
  for (const Division& division : divisions) wanted += 2LL * (division.parts - 1);
  const double share =
      wanted > most_added ? static_cast<double>(most_added) / static_cast<double>(wanted) : 1;
  std::vector<int> parts(connectivity.edges.size(), 1);
  for (int h = 0; h < static_cast<int>(connectivity.edge_of.size()); ++h) {
    const Division& division = divisions[h / 3];
    if (h % 3 == division.shortest) continue;
    int& of_edge = parts[connectivity.edge_of[h]];
    of_edge = std::max(of_edge, 1 + static_cast<int>(share * (division.parts - 1)));
  }
  return parts;
}

// A point on the boundary of a triangle.
struct BoundaryPoint {
  int vertex;
  Eigen::Vector2f place;
};

class Divider {
 public:
  Divider(const Points& V, const Triangles& F, const Connectivity& connectivity, std::vector<int> parts)
      : F_(F), connectivity_(connectivity), parts_(std::move(parts)), first_(parts_.size()) {
    int next = static_cast<int>(V.rows());
    for (std::size_t e = 0; e < parts_.size(); ++e) {
      first_[e] = next;
      next += parts_[e] - 1;
    }
    result_.positions.resize(next, 3);
    result_.positions.topRows(V.rows()) = V;
    for (std::size_t e = 0; e < parts_.size(); ++e) {
      const auto [i, j] = connectivity.edges[e];
      for (int k = 1; k < parts_[e]; ++k)
        result_.positions.row(first_[e] + k - 1) = V.row(i) + (V.row(j) - V.row(i)) * k / parts_[e];
    }
  }

  // In a strip, from the corner opposite to the side of fewest parts: on the left down one side and along
  // that side, on the right down the other.
  void divide(int f) {
    std::array<std::vector<BoundaryPoint>, 3> sides;
    for (int k = 0; k < 3; ++k) sides[k] = side(3 * f + k);
    const auto fewest = std::min_element(sides.begin(), sides.end(),
                                         [](const auto& a, const auto& b) { return a.size() < b.size(); });
    const auto base = fewest - sides.begin();
    std::vector<BoundaryPoint> left = sides[(base + 2) % 3], right = sides[(base + 1) % 3];
    std::reverse(right.begin(), right.end());
    left.insert(left.end(), fewest->begin() + 1, fewest->end() - 1);
    std::size_t l = 1, r = 1;
    add(f, left[0], left[1], right[1]);
    while (l + 1 < left.size() || r + 1 < right.size()) {
      // The end of the right side comes last: it lies on one line with the points along the base.
      const bool ends_right = r + 2 >= right.size();
      const bool is_ahead = (r + 1) * (left.size() - 1) < (l + 1) * (right.size() - 1);
      if (l + 1 < left.size() && (ends_right || !is_ahead)) {
        add(f, left[l], left[l + 1], right[r]);
        ++l;
      } else {
        add(f, left[l], right[r + 1], right[r]);
        ++r;
      }
    }
  }

  Pieces release() { return std::move(result_); }

 private:
  // The points of a half-edge's side, from its origin to its target.
  std::vector<BoundaryPoint> side(int h) const {
    static const std::array<Eigen::Vector2f, 3> corners = {Eigen::Vector2f(0, 0), Eigen::Vector2f(1, 0),
                                                           Eigen::Vector2f(0, 1)};
    const int e = connectivity_.edge_of[h], count = parts_[e], from = halfedge_origin(F_, h);
    const bool is_forward = connectivity_.edges[e][0] == from;
    const Eigen::Vector2f &begin = corners[h % 3], &end = corners[next_halfedge(h) % 3];
    std::vector<BoundaryPoint> points = {{from, begin}};
    for (int k = 1; k < count; ++k)
      points.push_back({first_[e] + (is_forward ? k : count - k) - 1,
                        begin + (end - begin) * (static_cast<float>(k) / static_cast<float>(count))});
    points.push_back({halfedge_target(F_, h), end});
    return points;
  }

  void add(int f, const BoundaryPoint& a, const BoundaryPoint& b, const BoundaryPoint& c) {
    result_.pieces.push_back({f, {a.vertex, b.vertex, c.vertex}, {a.place, b.place, c.place}});
  }

  const Triangles& F_;
  const Connectivity& connectivity_;
  std::vector<int> parts_;
  // Of every edge: the row of its first point between the ends.
  std::vector<int> first_;
  Pieces result_;
};

}  // namespace

Pieces short_pieces(const Points& V, const Triangles& F) {
  const Connectivity connectivity = connectivity_of(F, static_cast<int>(V.rows()));
  std::vector<Division> divisions(F.rows());
  for (Eigen::Index f = 0; f < F.rows(); ++f) divisions[f] = division_of(V, F, f);
  Divider divider(V, F, connectivity, parts_of_edges(divisions, connectivity));
  for (int f = 0; f < static_cast<int>(F.rows()); ++f) divider.divide(f);
  return divider.release();
}

}  // namespace orbitutte
