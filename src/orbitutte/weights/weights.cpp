// SPDX-License-Identifier: MIT
#include "orbitutte/weights/weights.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

#include "orbitutte/io/file.h"
#include "orbitutte/io/text_scanner.h"
#include "orbitutte/mesh/intrinsic_triangulation.h"
#include "orbitutte/parallel.h"
#include "orbitutte/weights/delaunay_flips.h"

namespace orbitutte {
namespace {

// Replaces weights of zero in an intrinsic triangulation, which concyclic points cause. The theory requires
// positive weights; one as small as this has no visible effect.
constexpr double concyclic_weight = 1e-6;

// Edges of no length have the largest mean value weights: bounded by so many times the median, they leave the
// rounding errors of the others small enough for the optimiser to converge.
constexpr double largest_ratio = 1e4;

// Half the cotangent of the angle at vertex o of a triangle (i, j, o). Zero if the area is nothing but
// rounding error, by the criterion of `inspect`: the cotangent, 1e15 or so, would be rounding error, too.
double half_cotangent(const Points& V, int i, int j, int o) {
  Vector3 a = V.row(i) - V.row(o), b = V.row(j) - V.row(o);
  const double longest =
      std::max({a.lpNorm<Eigen::Infinity>(), b.lpNorm<Eigen::Infinity>(), (b - a).lpNorm<Eigen::Infinity>()});
  if (!(longest > 0)) return 0;
  // A power of two near 1/longest prevents overflow and keeps right angles exact.
  const double scale = std::exp2(-std::clamp(std::ilogb(longest), -1000, 1000));
  a *= scale;
  b *= scale;
  const double twice_area = a.cross(b).norm();
  return twice_area > 8 * std::numeric_limits<double>::epsilon() ? 0.5 * a.dot(b) / twice_area : 0.0;
}

// For every edge, the sum of the values of its half-edges.
Eigen::VectorXd summed_over_sides(const Connectivity& connectivity, const std::vector<double>& value) {
  Eigen::VectorXd sum(static_cast<Eigen::Index>(connectivity.edges.size()));
  parallel_ranges(static_cast<int>(value.size()), [&](int begin, int end) {
    for (int h = begin; h < end; ++h) {
      const int other = connectivity.opposite[h], e = connectivity.edge_of[h];
      if (e < 0) continue;  // a diagonal
      if (other < 0) sum[e] = value[h];
      if (other > h) sum[e] = value[h] + value[other];
    }
  });
  return sum;
}

EdgeWeights cotangent_weights(const Surface& surface, double clamp) {
  EdgeWeights result;
  result.clamp = clamp;
  const Triangles& F = surface.triangles;
  const int halfedges = static_cast<int>(F.size());
  std::vector<double> cotangent(halfedges);
  parallel_ranges(halfedges, [&](int begin, int end) {
    for (int h = begin; h < end; ++h)
      cotangent[h] = half_cotangent(surface.V, halfedge_origin(F, h), halfedge_target(F, h),
                                    halfedge_origin(F, previous_halfedge(h)));
  });
  result.w = summed_over_sides(surface.connectivity, cotangent);
  const std::vector<int> not_positive =
      parallel_select(static_cast<int>(result.w.size()), [&](int e) { return !(result.w[e] > 0); });
  for (const int e : not_positive) result.w[e] = clamp;
  result.clamped_edges = static_cast<int>(not_positive.size());
  return result;
}

void require_positive(double clamp) {
  if (!(clamp > 0) || !std::isfinite(clamp))
    throw ArgumentError(fmt::format("the clamp of the weights is {}; it must be positive and finite", clamp));
}

// The triangulation of the result is null.
EdgeWeights weights_of_triangulation(const IntrinsicTriangulation& triangulation, double clamp) {
  EdgeWeights result;
  result.kind = WeightKind::delaunay;
  result.clamp = clamp;
  result.w = summed_over_sides(triangulation.connectivity, triangulation.half_cotangent);
  const std::vector<int> tiny = parallel_select(static_cast<int>(result.w.size()),
                                                [&](int e) { return result.w[e] < concyclic_weight; });
  for (const int e : tiny) {
    double& w = result.w[e];
    const bool is_negative = w < -concyclic_weight;
    if (is_negative) ++result.clamped_edges;
    w = is_negative ? std::max(clamp, concyclic_weight) : concyclic_weight;
  }
  return result;
}

EdgeWeights delaunay_weights(const Surface& surface, double clamp, const UnflippedEdges& unflipped) {
  IntrinsicTriangulation triangulation = delaunay_triangulation(surface, unflipped);
  EdgeWeights result = weights_of_triangulation(triangulation, clamp);
  result.triangulation = std::make_shared<IntrinsicTriangulation>(std::move(triangulation));
  return result;
}

// For every vertex, half the mean length of its edges.
std::vector<double> half_mean_lengths(const Connectivity& connectivity, const std::vector<double>& length,
                                      int vertex_count) {
  std::vector<double> sum(vertex_count, 0.0);
  std::vector<int> degree(vertex_count, 0);
  for (std::size_t e = 0; e < length.size(); ++e) {
    for (const int v : connectivity.edges[e]) {
      sum[v] += length[e];
      ++degree[v];
    }
  }
  for (int v = 0; v < vertex_count; ++v) sum[v] /= 2 * std::max(degree[v], 1);
  return sum;
}

EdgeWeights mean_value_weights(const Surface& surface) {
  const Triangles& F = surface.triangles;
  const Connectivity& connectivity = surface.connectivity;
  const std::vector<double> length = mollified_lengths(surface);
  const std::vector<double> scale = half_mean_lengths(connectivity, length, surface.vertex_count());
  const auto side = [&](int h) { return length[connectivity.edge_of[h]]; };
  // of each half-edge: the part of the weight that its face contributes
  std::vector<double> share(connectivity.edge_of.size());
  parallel_ranges(static_cast<int>(share.size()), [&](int begin, int end) {
    for (int h = begin; h < end; ++h) {
      const double a = side(h), b = side(next_halfedge(h)), c = side(previous_halfedge(h));
      const double at_origin = scale[halfedge_origin(F, h)] * half_angle_tangent(b, c, a),
                   at_target = scale[halfedge_target(F, h)] * half_angle_tangent(c, a, b);
      share[h] = (at_origin + at_target) / (2 * a);
    }
  });
  EdgeWeights result;
  result.w = summed_over_sides(connectivity, share);
  std::vector<double> sorted(result.w.begin(), result.w.end());
  const auto middle = sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() / 2);
  std::nth_element(sorted.begin(), middle, sorted.end());
  if (middle != sorted.end()) result.w = result.w.cwiseMin(largest_ratio * *middle);
  return result;
}

int find_edge(const Connectivity& connectivity, int i, int j) {
  const std::array<int, 2> edge = {std::min(i, j), std::max(i, j)};
  const auto at = std::lower_bound(connectivity.edges.begin(), connectivity.edges.end(), edge);
  return at != connectivity.edges.end() && *at == edge ? static_cast<int>(at - connectivity.edges.begin())
                                                       : -1;
}

EdgeWeights uniform_weights(const Surface& surface) {
  EdgeWeights result;
  result.w = Eigen::VectorXd::Ones(static_cast<Eigen::Index>(surface.connectivity.edges.size()));
  return result;
}

// Collects weights that are given edge by edge. For messages, `place()` names one entry and `where` the whole
// list.
class WeightCollector {
 public:
  explicit WeightCollector(const Connectivity& connectivity) : connectivity_(connectivity) {
    result_.kind = WeightKind::file;
    result_.w.setConstant(static_cast<Eigen::Index>(connectivity.edges.size()), missing);
  }

  template <typename Place>
  void add(const Place& place, const WeightedEdge& given) {
    const auto& [i, j, w] = given;
    if (!(w >= 0) || !std::isfinite(w))
      throw MeshError(fmt::format(
          "{}: edge ({}, {}) has the weight {}; weights must be finite and not negative", place(), i, j, w));
    const int edge = find_edge(connectivity_, i, j);
    if (edge < 0)
      throw MeshError(fmt::format("{}: the mesh has no edge ({}, {}); leave it out", place(), i, j));
    if (result_.w[edge] != missing)
      throw MeshError(fmt::format("{}: edge ({}, {}) is given twice; give every edge once", place(), i, j));
    result_.w[edge] = w;
  }

  /// All weights, once every edge has one. For messages, `row` names an entry of the list.
  EdgeWeights weights(const std::string& where, const char* row) {
    const auto absent = std::find(result_.w.begin(), result_.w.end(), missing);
    if (absent != result_.w.end()) {
      const auto [i, j] = connectivity_.edges[absent - result_.w.begin()];
      throw MeshError(
          fmt::format("{}: edge ({}, {}) has no {}; give every edge of the mesh once", where, i, j, row));
    }
    result_.zero_edges = static_cast<int>(std::count(result_.w.begin(), result_.w.end(), 0.0));
    return std::move(result_);
  }

 private:
  static constexpr double missing = -1;
  const Connectivity& connectivity_;
  EdgeWeights result_;
};

}  // namespace

IntrinsicTriangulation delaunay_triangulation(const Surface& surface, const UnflippedEdges& unflipped) {
  for (const int f : unflipped.kept_faces)
    if (f < 0 || f >= surface.triangle_count())
      throw MeshError(fmt::format("there is no face {} to keep; the mesh has the faces 0 to {}", f,
                                  surface.triangle_count() - 1));
  IntrinsicTriangulation triangulation = intrinsic_triangulation(surface);
  triangulation.kept_faces = unflipped.kept_faces;
  triangulation.kept_apart = unflipped.kept_apart;
  make_delaunay(triangulation);
  return triangulation;
}

EdgeWeights intrinsic_weights(IntrinsicTriangulation triangulation, double clamp) {
  require_positive(clamp);
  EdgeWeights result = weights_of_triangulation(triangulation, clamp);
  triangulation.length = std::vector<double>();
  triangulation.half_cotangent = std::vector<double>();
  result.triangulation = std::make_shared<IntrinsicTriangulation>(std::move(triangulation));
  return result;
}

WeightKind weight_kind(const Surface& surface, WeightKind asked) {
  if (asked == WeightKind::standard) return surface.has_polygons() ? WeightKind::cotan : WeightKind::delaunay;
  const bool of_triangles = asked == WeightKind::delaunay || asked == WeightKind::mean_value;
  if (of_triangles && surface.has_polygons())
    throw ArgumentError(fmt::format(
        "the mesh has faces of more than three corners, for which there are no {} weights; take cotan or "
        "uniform weights, or a file of weights",
        name_of(asked)));
  return asked;
}

EdgeWeights edge_weights(const Surface& surface, const WeightOptions& options,
                         const UnflippedEdges& unflipped) {
  require_positive(options.clamp);
  if (options.kind == WeightKind::file && options.given.empty())
    throw ArgumentError("the kind of the weights is 'file'; call read_weights to read them");
  if (options.kind == WeightKind::file) return given_weights(options.given, surface.connectivity);
  const WeightKind kind = weight_kind(surface, options.kind);
  EdgeWeights result = kind == WeightKind::cotan        ? cotangent_weights(surface, options.clamp)
                       : kind == WeightKind::delaunay   ? delaunay_weights(surface, options.clamp, unflipped)
                       : kind == WeightKind::mean_value ? mean_value_weights(surface)
                                                        : uniform_weights(surface);
  result.kind = kind;
  result.clamp = options.clamp;
  return result;
}

EdgeWeights given_weights(const std::vector<WeightedEdge>& list, const Connectivity& connectivity) {
  WeightCollector collector(connectivity);
  for (std::size_t k = 0; k < list.size(); ++k)
    collector.add([&] { return fmt::format("weight {}", k); }, list[k]);
  return collector.weights("the weights", "entry");
}

EdgeWeights read_weights(const std::string& path, const Connectivity& connectivity) {
  const std::string text = read_file(path);
  WeightCollector collector(connectivity);
  for (TextScanner scanner(text, {.comment = '#'}); scanner.find_word(); scanner.skip_words()) {
    const int line = scanner.line();
    WeightedEdge edge;
    const bool is_edge = parse_number(scanner.word(), edge.i) == NumberError::none &&
                         parse_number(scanner.word(), edge.j) == NumberError::none &&
                         parse_number(scanner.word(), edge.weight) == NumberError::none;
    if (!is_edge)
      throw MeshError(
          fmt::format("{}: line {} is not 'i j w' (two vertices and a weight); mend it", path, line));
    collector.add([&] { return fmt::format("{}: line {}", path, line); }, edge);
  }
  return collector.weights(path, "line");
}

}  // namespace orbitutte
