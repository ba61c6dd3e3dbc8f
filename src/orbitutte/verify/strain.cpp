// SPDX-License-Identifier: MIT
#include "orbitutte/verify/strain.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "orbitutte/orbifold/exact_positions.h"
#include "orbitutte/verify/distortion.h"
#include "orbitutte/verify/flat_triangles.h"

namespace orbitutte {
namespace {

using TriangleSides = std::array<double, 3>;

// A triangle in the source and in the image, both flat.
struct StrainedTriangle {
  TriangleSides source, image;
  double source_area = 0, image_area = 0;

  // sigma_1/sigma_2; 0 if the triangle is not measured.
  double elongation = 0;
};

StrainedTriangle strained(const TriangleSides& source, const TriangleSides& image) {
  StrainedTriangle result = {source, image};
  const auto p = lay_out(source[0], source[1], source[2]), q = lay_out(image[0], image[1], image[2]);
  if (!p || !q) return result;
  result.source_area = 0.5 * source[0] * source[0] * p->y;
  result.image_area = 0.5 * image[0] * image[0] * q->y;
  const double elongation = ratio_of_singular_values(*p, *q), ratio = result.image_area / result.source_area;
  if (std::isfinite(elongation) && std::isfinite(ratio) && ratio > 0) result.elongation = elongation;
  return result;
}

std::vector<StrainedTriangle> strained_triangles(const Surface& surface, const Embedding& embedding) {
  const std::vector<FaceDistortion> faces = measure_triangles(surface, embedding);
  const ExactPositions positions(embedding);
  std::vector<StrainedTriangle> result(faces.size());
  for (std::size_t t = 0; t < faces.size(); ++t) {
    if (!(faces[t].area > 0)) continue;
    TriangleSides source, image;
    for (int k = 0; k < 3; ++k) {
      const int a = embedding.triangles(static_cast<Eigen::Index>(t), k),
                b = embedding.triangles(static_cast<Eigen::Index>(t), (k + 1) % 3);
      source[k] =
          (surface.V.row(embedding.source_vertex[b]) - surface.V.row(embedding.source_vertex[a])).norm();
      image[k] = positions.chord(a, b);
    }
    result[t] = strained(source, image);
  }
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

// An edge of a face of the input, between input vertices a < b.
struct StrainedEdge {
  int a, b;
  double doublings;  // log2 of its length, image over source

  bool operator<(const StrainedEdge& other) const { return a != other.a ? a < other.a : b < other.b; }
  bool is_same(const StrainedEdge& other) const { return a == other.a && b == other.b; }
};

// Of all faces, in their order: each edge inside occurs twice.
std::vector<StrainedEdge> edges_of_faces(const Surface& surface, const Embedding& embedding, double scale) {
  const ExactPositions positions(embedding);
  const FaceView faces = embedding.faces();
  std::vector<StrainedEdge> edges;
  edges.reserve(static_cast<std::size_t>(faces.start(faces.count())));
  for (int f = 0; f < faces.count(); ++f)
    for (int k = 0; k < faces.degree(f); ++k) {
      const int from = faces[f][k], to = faces[f][(k + 1) % faces.degree(f)];
      const int a = embedding.source_vertex[from], b = embedding.source_vertex[to];
      const double length = (surface.V.row(b) - surface.V.row(a)).norm();
      edges.push_back(
          {std::min(a, b), std::max(a, b), std::log2(scale * positions.chord(from, to) / length)});
    }
  return edges;
}

void add_edges_of_faces(const FaceView& faces, const std::vector<StrainedEdge>& edges,
                        std::vector<StrainSum>& sums) {
  for (int f = 0; f < faces.count(); ++f)
    for (int k = faces.start(f); k < faces.start(f) + faces.degree(f); ++k)
      if (std::isfinite(edges[k].doublings)) sums[f].add_edge(edges[k].doublings);
}

// Each edge once.
void add_edges_of_vertices(std::vector<StrainedEdge> edges, std::vector<StrainSum>& sums) {
  std::stable_sort(edges.begin(), edges.end());
  const auto end = std::unique(edges.begin(), edges.end(),
                               [](const StrainedEdge& x, const StrainedEdge& y) { return x.is_same(y); });
  for (auto edge = edges.begin(); edge != end; ++edge) {
    if (!std::isfinite(edge->doublings)) continue;
    sums[edge->a].add_edge(edge->doublings);
    sums[edge->b].add_edge(edge->doublings);
  }
}

double percentile_of(const std::vector<double>& sorted, double percent) {
  const double at = percent / 100 * static_cast<double>(sorted.size() - 1);
  const auto below = static_cast<std::size_t>(at);
  const std::size_t above = std::min(below + 1, sorted.size() - 1);
  return sorted[below] + (at - static_cast<double>(below)) * (sorted[above] - sorted[below]);
}

}  // namespace

SurfaceStrain measure_strain(const Surface& surface, const Embedding& embedding, double radius) {
  const std::vector<StrainedTriangle> triangles = strained_triangles(surface, embedding);
  const double scale = image_scale(triangles, radius);
  const FaceView faces = embedding.faces();
  std::vector<StrainSum> of_vertex(surface.V.rows()), of_face(faces.count());
  std::size_t t = 0;
  for (int f = 0; f < faces.count(); ++f)
    for (int k = 0; k < faces.degree(f) - 2; ++k, ++t) {
      of_face[f].add(triangles[t], triangles[t].source_area);
      for (const int v : embedding.triangles.row(static_cast<Eigen::Index>(t)))
        of_vertex[embedding.source_vertex[v]].add(triangles[t], 1);
    }
  const std::vector<StrainedEdge> edges = edges_of_faces(surface, embedding, scale);
  add_edges_of_faces(faces, edges, of_face);
  add_edges_of_vertices(edges, of_vertex);
  return {strain_map(of_vertex, scale), strain_map(of_face, scale)};
}

std::vector<StrainStatistics> strain_statistics(const StrainMap& map) {
  std::vector<StrainStatistics> result(strain_measures);
  for (int measure = 0; measure < strain_measures; ++measure) {
    std::vector<double> values;
    values.reserve(map.measured.size());
    for (std::size_t k = 0; k < map.measured.size(); ++k)
      if (map.measured[k]) values.push_back(map.values(static_cast<Eigen::Index>(k), measure));
    if (values.empty()) continue;
    StrainStatistics& statistics = result[measure];
    const auto count = static_cast<double>(values.size());
    for (const double value : values) {
      statistics.mean += value / count;
      statistics.mean_absolute += std::abs(value) / count;
    }
    std::sort(values.begin(), values.end());
    for (std::size_t p = 0; p < std::size(StrainStatistics::percents); ++p)
      statistics.percentiles[p] = percentile_of(values, StrainStatistics::percents[p]);
  }
  return result;
}

}  // namespace orbitutte
