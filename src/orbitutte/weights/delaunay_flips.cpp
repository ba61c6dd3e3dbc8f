// SPDX-License-Identifier: MIT
#include "orbitutte/weights/delaunay_flips.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "orbitutte/parallel.h"

namespace orbitutte {
namespace {

constexpr double mollification = 1e-8;  // slack in units of the mean length
// An edge is not worth a flip if its cotangents add up to zero within `cocircular`, or within
// `cotangent_rounding` of their own size.
constexpr double cocircular = 1e-9;
constexpr double cotangent_rounding = 1e-6;
constexpr std::size_t most_flips_per_edge = 100;

// 16 times the square of the area (W. Kahan, "Miscalculating area and angles of a needle-like triangle").
double sixteen_squared_areas(double a, double b, double c) {
  if (a < b) std::swap(a, b);
  if (b < c) std::swap(b, c);
  if (a < b) std::swap(a, b);
  return (a + (b + c)) * (c - (a - b)) * (c + (a - b)) * (a + (b - c));
}

// The point above the x axis at the distances r from (0, 0) and s from (d, 0).
struct PlanePoint {
  double x, y;
};
PlanePoint apex_over(double d, double r, double s) {
  return {(d * d + (r - s) * (r + s)) / (2 * d),
          std::sqrt(std::max(0.0, sixteen_squared_areas(d, r, s))) / (2 * d)};
}

class DelaunayFlips {
 public:
  explicit DelaunayFlips(IntrinsicTriangulation& triangulation)
      : T_(triangulation),
        opposite_(triangulation.connectivity.opposite),
        edge_of_(triangulation.connectivity.edge_of),
        halfedge_(triangulation.connectivity.edges.size()),
        waiting_(triangulation.connectivity.edges.size(), 0),
        kept_(triangulation.connectivity.edges.size(), 0) {
    parallel_ranges(static_cast<int>(edge_of_.size()), [&](int begin, int end) {
      for (int h = begin; h < end; ++h)
        if (opposite_[h] < h) halfedge_[edge_of_[h]] = h;
    });
    for (const int f : triangulation.kept_faces)
      for (int h = 3 * f; h < 3 * f + 3; ++h) kept_[edge_of_[h]] = 1;
  }

  // All edges but these must be Delaunay.
  void run(const std::vector<int>& edges) {
    for (const int e : edges) push(e);
    const std::size_t most_flips = T_.flips.size() + most_flips_per_edge * halfedge_.size();
    std::size_t before = 0;
    do {
      before = T_.flips.size();
      flip_all_that_wait(most_flips);
      for (const int e : std::exchange(blocked_, {})) push(e);  // a later flip may have removed the obstacle
    } while (T_.flips.size() > before && T_.flips.size() < most_flips);
  }

  // All edges that are not Delaunay, ascending. Half-edges are visited in the order of their angles.
  std::vector<int> flippable_edges() const {
    std::vector<int> edges = parallel_select(static_cast<int>(opposite_.size()), [&](int h) {
      return opposite_[h] >= 0 && opposite_[h] < h && !are_delaunay(h, opposite_[h]);
    });
    for (int& h : edges) h = edge_of_[h];
    std::sort(edges.begin(), edges.end());
    return edges;
  }

 private:
  void flip_all_that_wait(std::size_t most_flips) {
    for (std::size_t k = 0; k < queue_.size() && T_.flips.size() < most_flips; ++k) {
      const int e = queue_[k];
      waiting_[e] = 0;
      if (is_delaunay(e)) continue;
      const Flip flip = flip_of(halfedge_[e]);
      if (is_blocked(flip)) {
        blocked_.push_back(e);
      } else {
        apply(flip);
      }
    }
    queue_.clear();
  }

  void push(int e) {
    if (waiting_[e] || kept_[e] || is_delaunay(e)) return;
    waiting_[e] = 1;
    queue_.push_back(e);
  }

  bool is_delaunay(int e) const {
    const int h = halfedge_[e], g = opposite_[h];
    return g < 0 || are_delaunay(h, g);
  }

  bool are_delaunay(int h, int g) const {
    const double left = T_.half_cotangent[h], right = T_.half_cotangent[g];
    return left + right >= -(cocircular + cotangent_rounding * (std::abs(left) + std::abs(right)));
  }

  Flip flip_of(int h) const {
    Flip flip;
    flip.h = h;
    flip.g = opposite_[h];
    flip.al = next_halfedge(flip.g);
    flip.lb = previous_halfedge(flip.g);
    if (halfedge_origin(T_.F, flip.g) == halfedge_origin(T_.F, h)) std::swap(flip.al, flip.lb);
    flip.beyond_al = opposite_[flip.al];
    flip.beyond_lb = opposite_[flip.lb];
    return flip;
  }

  bool is_blocked(const Flip& flip) const {
    const int bk = next_halfedge(flip.h), ka = previous_halfedge(flip.h);
    const bool leaves_an_ear =
        (opposite_[ka] < 0 && flip.beyond_al < 0) || (opposite_[bk] < 0 && flip.beyond_lb < 0);
    const int l = halfedge_origin(T_.F, previous_halfedge(flip.g));
    const int k = halfedge_origin(T_.F, ka);
    return leaves_an_ear || k == l || are_kept_apart(k, l) || are_joined(ka, l);
  }

  bool are_kept_apart(int k, int l) const {
    return std::any_of(T_.kept_apart.begin(), T_.kept_apart.end(), [&](const std::array<int, 2>& pair) {
      return pair == std::array{k, l} || pair == std::array{l, k};
    });
  }

  // Does an edge join the origin of half-edge `out` to w? w is not a vertex of the face of `out`. Walks
  // around the origin, in both directions if the boundary ends the first walk.
  bool are_joined(int out, int w) const {
    const int v = halfedge_origin(T_.F, out);
    for (const int across : {previous_halfedge(out), out}) {
      int h = opposite_[across];
      for (; h >= 0 && h / 3 != out / 3; h = opposite_[h]) {
        const bool leaves = halfedge_origin(T_.F, h) == v;
        h = leaves ? previous_halfedge(h) : next_halfedge(h);
        if ((leaves ? halfedge_origin(T_.F, h) : halfedge_target(T_.F, h)) == w) return true;
      }
      if (h >= 0) break;
    }
    return false;
  }

  // The distance from k to l once both faces are laid out in the plane, in the unit of the first face.
  double diagonal(const Flip& flip, double unit) const {
    const std::vector<double>& length = T_.length;
    const double ab = length[flip.h];
    const PlanePoint k = apex_over(ab, length[previous_halfedge(flip.h)], length[next_halfedge(flip.h)]),
                     l = apex_over(ab, unit * length[flip.al], unit * length[flip.lb]);
    return std::hypot(k.x - l.x, k.y + l.y);
  }

  void apply(const Flip& flip) {
    const int h = flip.h, g = flip.g, bk = next_halfedge(h), ka = previous_halfedge(h);
    const double unit = T_.length[h] / T_.length[g], kl = diagonal(flip, unit);
    const int a = halfedge_origin(T_.F, h), b = halfedge_target(T_.F, h), k = halfedge_origin(T_.F, ka),
              l = halfedge_origin(T_.F, previous_halfedge(g));
    const std::array<int, 4> edges = {edge_of_[ka], edge_of_[flip.al], edge_of_[flip.lb], edge_of_[bk]},
                             beyond = {opposite_[ka], flip.beyond_al, flip.beyond_lb, opposite_[bk]},
                             place = {next_halfedge(h), previous_halfedge(h), next_halfedge(g),
                                      previous_halfedge(g)};
    const std::array<double, 4> lengths = {T_.length[ka], unit * T_.length[flip.al],
                                           unit * T_.length[flip.lb], T_.length[bk]};
    int* const corner = T_.F.data();
    corner[h] = l, corner[place[0]] = k, corner[place[1]] = a;
    corner[g] = k, corner[place[2]] = l, corner[place[3]] = b;
    T_.length[h] = T_.length[g] = kl;
    for (int s = 0; s < 4; ++s) {
      edge_of_[place[s]] = edges[s];
      opposite_[place[s]] = beyond[s];
      if (beyond[s] >= 0) opposite_[beyond[s]] = place[s];
      halfedge_[edges[s]] = place[s];
      T_.length[place[s]] = lengths[s];
    }
    T_.connectivity.edges[edge_of_[h]] = {k, l};
    measure_angles(T_, h / 3);
    measure_angles(T_, g / 3);
    T_.flips.push_back(flip);
    for (const int near : edges) push(near);
  }

  IntrinsicTriangulation& T_;
  std::vector<int>&opposite_, &edge_of_;
  std::vector<int> halfedge_;         // one half-edge of every edge
  std::vector<char> waiting_;         // is the edge in the queue?
  std::vector<char> kept_;            // does the edge belong to a kept face?
  std::vector<int> queue_, blocked_;  // edges
};

}  // namespace

std::vector<double> mollified_lengths(const Surface& surface) {
  const Connectivity& connectivity = surface.connectivity;
  const int count = static_cast<int>(connectivity.edges.size());
  const auto difference = [&](int e) -> Vector3 {
    const auto [i, j] = connectivity.edges[e];
    return surface.V.row(i) - surface.V.row(j);
  };
  const double largest = parallel_max(count, [&](int e) { return difference(e).lpNorm<Eigen::Infinity>(); });
  // A power of two near 1/largest prevents overflow.
  const double scale = largest > 0 ? std::exp2(-std::clamp(std::ilogb(largest), -1000, 1000)) : 1.0;
  std::vector<double> length(count);
  const double total = parallel_sum(count, [&](int e) { return length[e] = (scale * difference(e)).norm(); });
  const double mean = total > 0 ? total / count : 1.0;
  parallel_ranges(count, [&](int begin, int end) {
    for (int e = begin; e < end; ++e) length[e] /= mean;
  });
  const auto side = [&](int h) { return length[connectivity.edge_of[h]]; };
  const double missing = parallel_max(static_cast<int>(connectivity.edge_of.size()), [&](int h) {
    return mollification + side(h) - side(next_halfedge(h)) - side(previous_halfedge(h));
  });
  parallel_ranges(count, [&](int begin, int end) {
    for (int e = begin; e < end; ++e) length[e] += missing;
  });
  return length;
}

double half_cotangent(double a, double b, double c) {
  const double area = std::sqrt(sixteen_squared_areas(a, b, c));  // four times the area
  return area > 0 ? 0.5 * (b * b + c * c - a * a) / area : 0.0;
}

double half_angle_tangent(double a, double b, double c) {
  return std::sqrt(std::max(0.0, (a - (b - c)) * (a + (b - c))) / ((a + (b + c)) * ((b + c) - a)));
}

void measure_angles(IntrinsicTriangulation& triangulation, int face) {
  const double* const length = &triangulation.length[3 * face];
  for (int k = 0; k < 3; ++k)
    triangulation.half_cotangent[3 * face + k] =
        half_cotangent(length[k], length[(k + 1) % 3], length[(k + 2) % 3]);
}

IntrinsicTriangulation intrinsic_triangulation(const Surface& surface) {
  const std::vector<double> length = mollified_lengths(surface);
  const std::vector<int>& edge_of = surface.connectivity.edge_of;
  IntrinsicTriangulation result = {surface.triangles, surface.connectivity, {}, {}, {}, {}};
  result.length.resize(edge_of.size());
  result.half_cotangent.resize(edge_of.size());
  parallel_ranges(surface.triangle_count(), [&](int begin, int end) {
    for (int h = 3 * begin; h < 3 * end; ++h) result.length[h] = length[edge_of[h]];
    for (int f = begin; f < end; ++f) measure_angles(result, f);
  });
  return result;
}

void make_delaunay(IntrinsicTriangulation& triangulation, const std::vector<int>& edges) {
  DelaunayFlips(triangulation).run(edges);
}

void make_delaunay(IntrinsicTriangulation& triangulation) {
  DelaunayFlips flips(triangulation);
  flips.run(flips.flippable_edges());
}

}  // namespace orbitutte
