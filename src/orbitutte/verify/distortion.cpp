// SPDX-License-Identifier: MIT
#include "orbitutte/verify/distortion.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

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

// The largest coordinate of an edge: areas in its square overflow nowhere.
double length_unit(const Surface& surface) {
  const double unit = parallel_max(static_cast<int>(surface.triangles.size()), [&](int h) {
    const int from = halfedge_origin(surface.triangles, h), to = halfedge_target(surface.triangles, h);
    return (surface.V.row(to) - surface.V.row(from)).cwiseAbs().maxCoeff();
  });
  return unit > 0 ? unit : 1;
}

struct FaceAreas {
  double source = 0, image = 0;
};

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

// What is measured of the image of a triangle: the lengths of the sides between its corners 0 and 1, 1 and 2,
// 2 and 0, and the rounding of the worst corner.
struct ImageMeasures {
  std::array<double, 3> arcs;
  double rounding = 0;
};

// v: its corners. rounding: of every cut vertex.
ImageMeasures measure_image(const std::array<int, 3>& v, const ExactPositions& positions,
                            const std::vector<double>& rounding) {
  return {{positions.distance(v[0], v[1]), positions.distance(v[1], v[2]), positions.distance(v[2], v[0])},
          std::max({rounding[v[0]], rounding[v[1]], rounding[v[2]]})};
}

// Scaled by a power of two where their squares would underflow.
std::array<double, 3> in_range(std::array<double, 3> lengths) {
  const double longest = *std::max_element(lengths.begin(), lengths.end());
  if (longest > 0 && longest < 1e-100)
    for (double& length : lengths) length = std::ldexp(length, -std::ilogb(longest));
  return lengths;
}

FaceDistortion face_distortion(const std::array<Vector3, 3>& source, const ImageMeasures& image,
                               const FaceAreas& area, const FaceAreas& total) {
  FaceDistortion result;
  result.share = total.source > 0 ? area.source / total.source : 0;
  const auto length = [&](int i, int j) { return (source[i] - source[j]).norm(); };
  const std::array<double, 3> lengths = {length(0, 1), length(1, 2), length(2, 0)};
  const double longest = std::max({lengths[0], lengths[1], lengths[2]}),
               longest_arc = *std::max_element(image.arcs.begin(), image.arcs.end());
  if (!(area.source > area_rounding * longest * longest) ||
      !(area.image > position_rounding * image.rounding * longest_arc))
    return result;
  const std::array<double, 3> arcs = in_range(image.arcs);
  const double ratio = (area.image / total.image) / (area.source / total.source);
  if (!(ratio > 0) || !std::isfinite(ratio)) return result;
  result.area = ratio;
  const auto e = lay_out(lengths[0], lengths[1], lengths[2]), g = lay_out(arcs[0], arcs[1], arcs[2]);
  if (!e || !g) return result;
  const double angle = ratio_of_singular_values(*e, *g);
  if (std::isfinite(angle)) result.angle = angle;
  return result;
}

}  // namespace

std::vector<FaceDistortion> measure_triangles(const Surface& surface, const Embedding& embedding) {
  const int m = surface.triangle_count();
  const double unit = length_unit(surface);
  const ExactPositions positions(embedding);
  const auto source = [&](int f) {
    const auto corner = [&](int k) {
      return surface.V.row(embedding.source_vertex[embedding.triangles(f, k)]) / unit;
    };
    return std::array<Vector3, 3>{corner(0), corner(1), corner(2)};
  };
  std::vector<FaceAreas> area(m);
  FaceAreas total;
  total.source = parallel_sum(m, [&](int f) {
    const auto p = source(f);
    return area[f].source = triangle_area(p[0], p[1], p[2]);
  });
  total.image = parallel_sum(m, [&](int f) {
    const auto v = embedding.triangles.row(f);
    area[f].image = positions.area(v[0], v[1], v[2]);
    return std::max(area[f].image, 0.0);  // a map that is turned over in places still has shares
  });
  const std::vector<double> rounding = tangential_roundings(embedding, positions);
  std::vector<FaceDistortion> of_face(m);
  parallel_ranges(m, [&](int begin, int end) {
    for (int f = begin; f < end; ++f) {
      const std::array<int, 3> v = {embedding.triangles(f, 0), embedding.triangles(f, 1),
                                    embedding.triangles(f, 2)};
      of_face[f] = face_distortion(source(f), measure_image(v, positions, rounding), area[f], total);
    }
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
