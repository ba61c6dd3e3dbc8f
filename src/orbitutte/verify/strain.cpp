// SPDX-License-Identifier: MIT
#include "orbitutte/verify/strain.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "orbitutte/orbifold/exact_positions.h"
#include "orbitutte/parallel.h"
#include "orbitutte/verify/distortion.h"
#include "orbitutte/verify/flat_triangles.h"

namespace orbitutte {
namespace {

using TriangleSides = std::array<double, 3>;

// A triangle in the source and in the image, both flat. Its areas are 0 if it is not measured.
struct StrainedTriangle {
  TriangleSides source = {}, image = {};
  double source_area = 0, image_area = 0;

  // sigma_1/sigma_2; 0 if the triangle is not measured.
  double elongation = 0;
};

void measure(StrainedTriangle& triangle) {
  const TriangleSides &source = triangle.source, &image = triangle.image;
  const auto p = lay_out(source[0], source[1], source[2]), q = lay_out(image[0], image[1], image[2]);
  if (!p || !q) return;
  triangle.source_area = 0.5 * source[0] * source[0] * p->y;
  triangle.image_area = 0.5 * image[0] * image[0] * q->y;
  const double elongation = ratio_of_singular_values(*p, *q),
               ratio = triangle.image_area / triangle.source_area;
  if (std::isfinite(elongation) && std::isfinite(ratio) && ratio > 0) triangle.elongation = elongation;
}

// With the lengths of all edges, be the triangle measured or not.
std::vector<StrainedTriangle> strained_triangles(const Surface& surface, const Embedding& embedding) {
  const std::vector<FaceDistortion> faces = measure_triangles(surface, embedding);
  const ExactPositions positions(embedding);
  std::vector<StrainedTriangle> result(faces.size());
  parallel_ranges(static_cast<int>(faces.size()), [&](int begin, int end) {
    for (int t = begin; t < end; ++t) {
      for (int k = 0; k < 3; ++k) {
        const int a = embedding.triangles(t, k), b = embedding.triangles(t, (k + 1) % 3);
        result[t].source[k] =
            (surface.V.row(embedding.source_vertex[b]) - surface.V.row(embedding.source_vertex[a])).norm();
        result[t].image[k] = positions.chord(a, b);
      }
      if (faces[t].area > 0) measure(result[t]);
    }
  });
  return result;
}

// What the lengths of the image are multiplied by.
double image_scale(const std::vector<StrainedTriangle>& triangles, double radius) {
  if (radius > 0) return radius;
  double source = 0, image = 0;
  for (const StrainedTriangle& triangle : triangles) {
    if (!(triangle.elongation > 0)) continue;
    source += triangle.source_area;
    image += triangle.image_area;
  }
  return image > 0 && source > 0 ? std::sqrt(source / image) : 1;
}

// Gathers the triangles and edges of a vertex or a face.
class StrainSum {
 public:
  // `weight` is that of its ratios among those of the other triangles.
  void add(const StrainedTriangle& triangle, double weight) {
    if (!(triangle.elongation > 0)) return;
    source_area_ += triangle.source_area;
    image_area_ += triangle.image_area;
    ratio_ += weight * triangle.image_area / triangle.source_area;
    elongation_ += weight * triangle.elongation;
    weight_ += weight;
  }

  void add_edge(double doublings) {
    edge_ += std::abs(doublings);
    ++edges_;
  }

  bool is_measured() const { return weight_ > 0; }

  Eigen::Matrix<double, 1, strain_measures> row(double scale) const {
    const double doublings = 2 * std::log2(scale);
    return {std::log2(image_area_ / source_area_) + doublings, std::log2(ratio_ / weight_) + doublings,
            std::log2(elongation_ / weight_), edges_ > 0 ? edge_ / edges_ : 0};
  }

 private:
  double source_area_ = 0, image_area_ = 0, ratio_ = 0, elongation_ = 0, weight_ = 0, edge_ = 0;
  int edges_ = 0;
};

StrainMap strain_map(const std::vector<StrainSum>& sums, double scale) {
  StrainMap map;
  map.values.setZero(static_cast<Eigen::Index>(sums.size()), strain_measures);
  map.measured.reserve(sums.size());
  for (std::size_t k = 0; k < sums.size(); ++k) {
    map.measured.push_back(sums[k].is_measured() ? 1 : 0);
    if (sums[k].is_measured()) map.values.row(static_cast<Eigen::Index>(k)) = sums[k].row(scale);
  }
  return map;
}

// The edge of the surface along side k of a triangle of the cut mesh, which may be turned over (its second
// and third vertex exchanged); -1 for a diagonal of a polygon.
int edge_along(const Surface& surface, const Embedding& embedding, int t, int k) {
  const bool is_turned = embedding.source_vertex[embedding.triangles(t, 1)] != surface.triangles(t, 1);
  return surface.connectivity.edge_of[3 * t + (is_turned ? 2 - k : k)];
}

// log2 of the length of every edge of the surface, image over source.
std::vector<double> doublings_of_edges(const Surface& surface, const Embedding& embedding,
                                       const std::vector<StrainedTriangle>& triangles, double scale) {
  constexpr double unknown = -1;
  std::vector<double> result(surface.connectivity.edges.size(), unknown);
  for (int t = 0; t < static_cast<int>(triangles.size()); ++t)
    for (int k = 0; k < 3; ++k)
      if (const int edge = edge_along(surface, embedding, t, k); edge >= 0 && result[edge] == unknown)
        result[edge] = scale * triangles[t].image[k] / triangles[t].source[k];
  parallel_ranges(static_cast<int>(result.size()), [&](int begin, int end) {
    for (int edge = begin; edge < end; ++edge) result[edge] = std::log2(result[edge]);
  });
  return result;
}

double percentile_of(const std::vector<double>& sorted, double percent) {
  const double at = percent / 100 * static_cast<double>(sorted.size() - 1);
  const auto below = static_cast<std::size_t>(at);
  const std::size_t above = std::min(below + 1, sorted.size() - 1);
  return sorted[below] + (at - static_cast<double>(below)) * (sorted[above] - sorted[below]);
}

// Percentiles of a measure and its means.
StrainStatistics statistics_of(std::vector<double> values) {
  StrainStatistics result;
  if (values.empty()) return result;
  const auto count = static_cast<double>(values.size());
  for (const double value : values) {
    result.mean += value / count;
    result.mean_absolute += std::abs(value) / count;
  }
  std::sort(values.begin(), values.end());
  for (std::size_t p = 0; p < std::size(StrainStatistics::percents); ++p)
    result.percentiles[p] = percentile_of(values, StrainStatistics::percents[p]);
  return result;
}

}  // namespace

SurfaceStrain measure_strain(const Surface& surface, const Embedding& embedding, double radius) {
  const std::vector<StrainedTriangle> triangles = strained_triangles(surface, embedding);
  const double scale = image_scale(triangles, radius);
  const std::vector<double> doublings = doublings_of_edges(surface, embedding, triangles, scale);
  const FaceView faces = embedding.faces();
  std::vector<StrainSum> of_vertex(surface.V.rows()), of_face(faces.count());
  const auto add_triangle = [&](int t, StrainSum& face) {
    face.add(triangles[t], triangles[t].source_area);
    for (int k = 0; k < 3; ++k) {
      of_vertex[embedding.source_vertex[embedding.triangles(t, k)]].add(triangles[t], 1);
      const int edge = edge_along(surface, embedding, t, k);
      if (edge >= 0 && std::isfinite(doublings[edge])) face.add_edge(doublings[edge]);
    }
  };
  int t = 0;
  for (int f = 0; f < faces.count(); ++f)
    for (int k = 2; k < faces.degree(f); ++k) add_triangle(t++, of_face[f]);
  for (std::size_t edge = 0; edge < doublings.size(); ++edge)
    if (std::isfinite(doublings[edge]))
      for (const int v : surface.connectivity.edges[edge]) of_vertex[v].add_edge(doublings[edge]);
  return {strain_map(of_vertex, scale), strain_map(of_face, scale)};
}

std::vector<StrainStatistics> strain_statistics(const StrainMap& map) {
  std::vector<StrainStatistics> result(strain_measures);
  parallel_for(strain_measures, [&](int measure) {
    std::vector<double> values;
    values.reserve(map.measured.size());
    for (std::size_t k = 0; k < map.measured.size(); ++k)
      if (map.measured[k]) values.push_back(map.values(static_cast<Eigen::Index>(k), measure));
    result[measure] = statistics_of(std::move(values));
  });
  return result;
}

}  // namespace orbitutte
