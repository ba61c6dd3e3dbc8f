// SPDX-License-Identifier: MIT
#include "orbitutte/verify/distortion.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "orbitutte/geometry/geodesic_triangle.h"
#include "orbitutte/orbifold/exact_positions.h"
#include "orbitutte/parallel.h"
#include "orbitutte/verify/flat_triangles.h"

namespace orbitutte {
namespace {

constexpr double position_rounding = 16;  // in units of tangential_rounding
constexpr double area_rounding = 4 * std::numeric_limits<double>::epsilon();

double triangle_area(const Vector3& a, const Vector3& b, const Vector3& c) {
  return 0.5 * (b - a).cross(c - a).norm();
}

// Reorders the values. 0 where there are none.
double median(std::vector<double>& values) {
  if (values.empty()) return 0;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return values.size() % 2 ? *middle : 0.5 * (*middle + *std::max_element(values.begin(), middle));
}

Distortion::Area statistics(std::vector<double>& values) {
  Distortion::Area result;
  if (values.empty()) return result;
  const int count = static_cast<int>(values.size());
  result.mean = parallel_sum(count, [&](int k) { return values[k]; }) / count;
  const double squares =
      parallel_sum(count, [&](int k) { return (values[k] - result.mean) * (values[k] - result.mean); });
  result.std = std::sqrt(squares / count);
  result.max = parallel_max(count, [&](int k) { return values[k]; });
  result.median = median(values);
  return result;
}

Distortion::Angle angle_statistics(const std::vector<FaceDistortion>& faces) {
  Distortion::Angle result;
  std::vector<double> angles;
  angles.reserve(faces.size());
  double sum = 0, weighted_sum = 0, weight = 0;
  for (const FaceDistortion& face : faces) {
    if (!(face.angle > 0)) continue;
    angles.push_back(face.angle);
    sum += face.angle;
    weighted_sum += face.share * face.angle;
    weight += face.share;
    result.max = std::max(result.max, face.angle);
  }
  if (angles.empty()) return result;
  result.mean = sum / static_cast<double>(angles.size());
  result.area_mean = weighted_sum / weight;
  result.median = median(angles);
  return result;
}

// The share of the source's area in triangles with lowest <= A <= highest.
double share_between(double lowest, double highest, const std::vector<FaceDistortion>& faces) {
  const double share = parallel_sum(static_cast<int>(faces.size()), [&](int f) {
    const FaceDistortion& face = faces[f];
    return face.area > 0 && face.area >= lowest && face.area <= highest ? face.share : 0.0;
  });
  return std::min(share, 1.0);
}

// sqrt(sum a (u - mean)^2 / sum a) of u = 1/2 log A, a the triangle's share of the source's area. doublings:
// of every triangle, log2 A, where it is measured.
double deviation_of_scale(const std::vector<FaceDistortion>& faces, const std::vector<double>& doublings) {
  const int count = static_cast<int>(faces.size());
  const auto weight_of = [&](int f) { return faces[f].area > 0 ? faces[f].share : 0.0; };
  const double weight = parallel_sum(count, weight_of);
  if (!(weight > 0)) return 0;
  const double mean = parallel_sum(count, [&](int f) { return weight_of(f) * doublings[f]; }) / weight;
  const double squares = parallel_sum(
      count, [&](int f) { return weight_of(f) * (doublings[f] - mean) * (doublings[f] - mean); });
  return 0.5 * std::numbers::ln2 * std::sqrt(squares / weight);
}

// Bins of log2 A, a quarter wide, from -8 to 8.
Distortion::Histogram empty_histogram() {
  Distortion::Histogram histogram;
  for (int k = -32; k <= 32; ++k) histogram.edges.push_back(0.25 * k);
  histogram.counts.assign(64, 0);
  return histogram;
}

int histogram_bin(double doublings) {
  return static_cast<int>(std::floor(std::clamp(4 * doublings, -32.0, 31.0))) + 32;
}

// A power of two near the size of the mesh: in this unit no squared area overflows.
double length_unit(const Surface& surface) {
  const int* const corner = surface.triangles.data();
  const auto off = [&](int v) { return (surface.V.row(v) - surface.V.row(corner[0])).cwiseAbs().maxCoeff(); };
  const double largest =
      surface.unreferenced_vertices == 0
          ? parallel_max(surface.vertex_count(), off)
          : parallel_max(static_cast<int>(surface.triangles.size()), [&](int h) { return off(corner[h]); });
  return largest > 0 ? std::exp2(std::ilogb(largest)) : 1;
}

// By how much rounding may move every position along the space.
std::vector<double> tangential_roundings(const Embedding& embedding, const ExactPositions& positions) {
  std::vector<double> result(embedding.source_vertex.size());
  parallel_ranges(static_cast<int>(result.size()), [&](int begin, int end) {
    for (int v = begin; v < end; ++v)
      result[v] = positions.has_offsets(v)
                      ? positions.rounding(v)
                      : embedding.space().tangential_rounding(embedding.positions.row(v));
  });
  return result;
}

// Its corners, and the lengths of the sides between the corners 0 and 1, 1 and 2, 2 and 0.
using Sides = std::array<double, 3>;
using SourceCorners = std::array<Vector3, 3>;

Sides sides_of(const SourceCorners& p) {
  return {(p[0] - p[1]).norm(), (p[1] - p[2]).norm(), (p[2] - p[0]).norm()};
}

struct ImageTriangle {
  Sides arcs;
  double area = 0;
};

template <int k>
ImageTriangle image_triangle(Curvature<k> curvature, const Embedding& embedding,
                             const ExactPositions& positions, const std::array<int, 3>& v) {
  if (positions.has_offsets())
    return {{positions.distance(v[0], v[1]), positions.distance(v[1], v[2]), positions.distance(v[2], v[0])},
            positions.area(v[0], v[1], v[2])};
  const Points& X = embedding.positions;
  const Vector3 a = X.row(v[0]), b = X.row(v[1]), c = X.row(v[2]);
  const auto arc = [&](const Vector3& p, const Vector3& q) {
    return std::sqrt(std::max(curvature.distance(p, q).squared, 0.0));
  };
  return {{arc(a, b), arc(b, c), arc(c, a)}, area_of(curvature, a, b, c)};
}

// Scaled by a power of two where their squares would underflow.
Sides in_range(Sides lengths) {
  const double longest = *std::max_element(lengths.begin(), lengths.end());
  if (longest > 0 && longest < 1e-100)
    for (double& length : lengths) length = std::ldexp(length, -std::ilogb(longest));
  return lengths;
}

// What is known of a triangle without the others.
struct TriangleMeasures {
  double source_area = 0, image_area = 0;

  // Are both more than rounding explains?
  bool is_measured = false;

  // The ratio of singular values; 0 if there is none.
  double angle = 0;
};

// rounding: by how much it may move a corner of the image.
TriangleMeasures measures_of(const SourceCorners& source, const ImageTriangle& image, double rounding) {
  TriangleMeasures result = {triangle_area(source[0], source[1], source[2]), image.area};
  const Sides lengths = sides_of(source);
  const double longest = *std::max_element(lengths.begin(), lengths.end()),
               longest_arc = *std::max_element(image.arcs.begin(), image.arcs.end());
  result.is_measured = result.source_area > area_rounding * longest * longest &&
                       result.image_area > position_rounding * rounding * longest_arc;
  if (!result.is_measured) return result;
  const Sides arcs = in_range(image.arcs);
  const auto e = lay_out(lengths[0], lengths[1], lengths[2]), g = lay_out(arcs[0], arcs[1], arcs[2]);
  if (!e || !g) return result;
  const double angle = ratio_of_singular_values(*e, *g);
  if (std::isfinite(angle)) result.angle = angle;
  return result;
}

std::vector<TriangleMeasures> measures_of_triangles(const Surface& surface, const Embedding& embedding) {
  const double per_unit = 1 / length_unit(surface);
  const ExactPositions positions(embedding);
  const std::vector<double> rounding = tangential_roundings(embedding, positions);
  const auto corner = [&](int v) -> Vector3 { return surface.V.row(embedding.source_vertex[v]) * per_unit; };
  std::vector<TriangleMeasures> result(surface.triangle_count());
  visit_curvature(embedding.space(), [&](auto curvature) {
    parallel_ranges(surface.triangle_count(), [&](int begin, int end) {
      for (int f = begin; f < end; ++f) {
        const std::array<int, 3> v = {embedding.triangles(f, 0), embedding.triangles(f, 1),
                                      embedding.triangles(f, 2)};
        result[f] = measures_of({corner(v[0]), corner(v[1]), corner(v[2])},
                                image_triangle(curvature, embedding, positions, v),
                                std::max({rounding[v[0]], rounding[v[1]], rounding[v[2]]}));
      }
    });
  });
  return result;
}

// total: of all triangles.
FaceDistortion face_distortion(const TriangleMeasures& triangle, const TriangleMeasures& total) {
  FaceDistortion result;
  result.share = total.source_area > 0 ? triangle.source_area / total.source_area : 0;
  if (!triangle.is_measured) return result;
  const double ratio = (triangle.image_area / total.image_area) / (triangle.source_area / total.source_area);
  if (!(ratio > 0) || !std::isfinite(ratio)) return result;
  result.area = ratio;
  result.angle = triangle.angle;
  return result;
}

}  // namespace

std::vector<FaceDistortion> measure_triangles(const Surface& surface, const Embedding& embedding) {
  const std::vector<TriangleMeasures> triangles = measures_of_triangles(surface, embedding);
  const int m = static_cast<int>(triangles.size());
  TriangleMeasures total;
  total.source_area = parallel_sum(m, [&](int f) { return triangles[f].source_area; });
  // A map that is turned over in places still has shares.
  total.image_area = parallel_sum(m, [&](int f) { return std::max(triangles[f].image_area, 0.0); });
  std::vector<FaceDistortion> of_face(m);
  parallel_ranges(m, [&](int begin, int end) {
    for (int f = begin; f < end; ++f) of_face[f] = face_distortion(triangles[f], total);
  });
  return of_face;
}

Distortion measure_distortion(const Surface& surface, const Embedding& embedding) {
  const std::vector<FaceDistortion> of_face = measure_triangles(surface, embedding);
  const int m = static_cast<int>(of_face.size());
  std::vector<double> doublings(m, 0.0);  // log2 A
  parallel_ranges(m, [&](int begin, int end) {
    for (int f = begin; f < end; ++f)
      if (of_face[f].area > 0) doublings[f] = std::log2(of_face[f].area);
  });
  Distortion result;
  result.histogram = empty_histogram();
  const auto measure_areas = [&] {
    std::vector<double> areas;
    areas.reserve(of_face.size());
    for (int f = 0; f < m; ++f) {
      const double area = of_face[f].area;
      if (!(area > 0)) continue;
      areas.push_back(std::max(area, 1 / area));
      ++result.histogram.counts[histogram_bin(doublings[f])];
    }
    result.measured_faces = static_cast<int>(areas.size());
    result.area = statistics(areas);
  };
  parallel_for(2, [&](int task) {
    if (task == 0)
      measure_areas();
    else
      result.angle = angle_statistics(of_face);
  });
  result.within_4 = share_between(0.25, 4, of_face);
  result.below_64 = share_between(0, std::nextafter(1.0 / 64, 0.0), of_face);
  result.sigma = deviation_of_scale(of_face, doublings);
  return result;
}

}  // namespace orbitutte
