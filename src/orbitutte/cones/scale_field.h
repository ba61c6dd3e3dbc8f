// SPDX-License-Identifier: MIT
// The scale of conformal maps of one surface onto spherical and flat orbifolds, whichever cones they have: in
// closed form, from one map to 222 or *222.
#pragma once

#include <map>
#include <memory>
#include <optional>
#include <tuple>
#include <vector>

#include "orbitutte/cones/chart.h"
#include "orbitutte/cones/cone_metric.h"
#include "orbitutte/cones/objective.h"
#include "orbitutte/mesh/groups.h"
#include "orbitutte/mesh/surface.h"
#include "orbitutte/verify/distortion.h"

namespace orbitutte {

/// A map whose scale is known: to 222 or *222, what was measured of its triangles (measure_triangles), and an
/// order of them in which neighbours in space mostly follow each other (order_in_space).
struct KnownMap {
  const Surface& surface;
  const Embedding& embedding;
  const std::vector<FaceDistortion>& faces;
  const std::vector<int>& order;
};

/// The triangles along a curve that fills space (G. M. Morton, 1966).
std::vector<int> order_in_space(const Surface& surface);

/// A place where the scale is known.
struct ScaleSample {
  /// The middle of a triangle.
  ChartPoint point;

  /// The share of the surface that it stands for; 0 where only the range of the scale counts.
  double weight = 0;

  /// log of lengths |n dd - d dn| of the chart's point n : d over lengths on the surface, whose area is one.
  double log_scale = 0;

  /// log of the triangle's length on the surface, the root of its area.
  double log_length = 0;
};

/// About `count` samples spread evenly over the area, or all triangles if there are not more, and then one
/// beside each of these vertices. Triangles that could not be measured are left out.
std::vector<ScaleSample> scale_samples(const KnownMap& map, int count, const std::vector<int>& vertices);

/// A choice: the target's marks at vertices of the surface.
struct MarkedTarget {
  Target target;
  std::vector<int> cones;
};

/// Does the closed form know the target's maps? It does for every orbifold of the sphere and disk with a
/// finite group, and for the flat ones with three cones. The pillow 2222 has a shape of its own.
bool has_closed_form(const Target& target);

/// A surface, and of every vertex the half-edges that begin there: one for each triangle.
struct VertexStars {
  explicit VertexStars(const Surface& surface);

  const Surface& surface;
  Groups halfedges;
};

/// The scale at samples for any choice of cones. A disk is half of its double: a corner is one cone of the
/// double, a cone inside two of them, at mirror images.
class ScaleField {
 public:
  /// Refers to the chart, and to the stars of its surface.
  ScaleField(const OrbifoldChart& chart, const VertexStars& stars, std::vector<ScaleSample> samples);

  /// Of the same surface at other samples. What is known of metrics with cones is known to both.
  ScaleField(const ScaleField& other, std::vector<ScaleSample> samples);

  /// u at every sample. Throws ArgumentError unless has_closed_form.
  std::vector<double> log_scale(const MarkedTarget& choice);

  ScaleSummary summary(const MarkedTarget& choice);

  /// sigma alone, and with it what else needs no exponential functions: the range and the least length.
  double sigma(const MarkedTarget& choice);
  ScaleSummary spread(const MarkedTarget& choice);

  /// Of sigma. 0 for three cones and N*. Maps to NN and *NN may slide along their axis, and the elements at
  /// both cones hold them: twice the part of the Dirichlet energy by which these exceed the area, a tenth at
  /// most. Measured: sigma is mostly less than predicted, by up to that. On thin limbs, whose other elements
  /// count for more, it may be off by more.
  double relative_error(const MarkedTarget& choice);

  const std::vector<ScaleSample>& samples() const { return samples_; }

 private:
  /// A cone of the surface or its double.
  struct Place {
    int vertex = -1;
    bool is_mirrored = false;
    double angle = 0;

    auto key() const { return std::pair(vertex, is_mirrored); }
  };

  /// Where a map to NN or *NN comes to rest along its axis.
  struct AxisBalance {
    /// log of the scale of z -> z^a.
    double log_scale = 0;

    /// The Dirichlet energy of the elements at both cones, less the area of their images.
    double excess = 0;
  };

  /// log of the bracket with every sample.
  using Column = std::vector<Complex>;

  static std::vector<Place> places(const MarkedTarget& choice);
  const Column& column(const Place& place);
  const ChartPoint& point(const Place& place);
  Complex log_bracket(const Place& a, const Place& b);
  void add_three_cones(const std::vector<Place>& cones, std::vector<double>& u);
  void add_two_cones(const MarkedTarget& choice, const std::vector<Place>& cones, std::vector<double>& u);
  void add_flat_cones(const std::vector<Place>& cones, std::vector<double>& u);
  ScaleSummary spread_of(const std::vector<double>& u) const;
  double mean_over_samples(const std::vector<double>& u) const;
  double variance_over_samples(const std::vector<double>& u) const;
  double area_over_samples(const std::vector<double>& u) const;
  const AxisBalance& balance_along_axis(const std::vector<Place>& cones);
  double excess_at(const Place& cone, const Place& other);

  const OrbifoldChart& chart_;
  const VertexStars& stars_;
  std::vector<ScaleSample> samples_;
  /// Near the chart's own cones they are computed with many digits, so each only once.
  std::map<std::pair<int, bool>, ChartPoint> points_;

  std::map<std::pair<int, bool>, Column> columns_;

  /// Of two vertices and the angle of both.
  std::map<std::tuple<int, int, double>, AxisBalance> balances_;
  using Metrics = std::map<std::array<double, 3>, ConeMetric>;
  std::shared_ptr<Metrics> metrics_ = std::make_shared<Metrics>();
};

}  // namespace orbitutte
