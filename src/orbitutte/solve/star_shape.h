// SPDX-License-Identifier: MIT
// How much the map distorts the triangles around one vertex, and where the vertex lies best: the sum of s1/s2
// over them, minimised by Newton's method.
#pragma once

#include <array>
#include <vector>

#include "orbitutte/types.h"

namespace orbitutte {

/// A star at one moment: its triangles v, a, b in the tangent plane at v, and in the source.
struct StarShape {
  Eigen::Matrix<double, 3, 2> axes;  // of the tangent plane, counterclockwise from outside; on a mirror the
                                     // first lies along it
  bool on_mirror = false;
  double radius = 0;  // the longest edge at v
  struct Triangle {
    Vector3 a, b;                  // from p_v
    double value;                  // det[p_v a b]
    Vector3 gradient;              // of the determinant by p_v
    double height, base;           // in the source
    bool is_flat;                  // there
    std::array<double, 3> source;  // squared lengths of (v, a), (v, b), (a, b)
    // Where the altitude from v meets (a, b) in the source, as a part of the way from a to b; base/(2
    // height); and height/(2 base) times the squared length of the image of (a, b), which the star's vertex
    // does not move.
    double foot, weight, fixed_energy;
  };
  std::vector<Triangle> triangles;
};

/// Says what a triangle is in the source: its edges from v to a and to b. Its image must be there already.
void set_source(const Vector3& va, const Vector3& vb, StarShape::Triangle& triangle);

/// The sum of the ratios s1/s2 of singular values over the star, were its vertex moved by a tangent step;
/// infinite unless all triangles are positive then. A triangle that is flat in the source counts with a
/// barrier, -0.01 log(2 A/radius^2): no map distorts it less for being wider, but it must be positive. A sum
/// that reaches the bound is not finished.
double distortion(const StarShape& shape, const Vector3& step, double bound);

/// The sum's derivatives by the star's vertex, along the axes.
struct DistortionDerivatives {
  Eigen::Vector2d gradient = Eigen::Vector2d::Zero();
  Eigen::Matrix2d hessian = Eigen::Matrix2d::Zero();
};

DistortionDerivatives derivatives_of_distortion(const StarShape& shape, const Vector3& step);

/// A step along the axes, and the distortion before it and after.
struct SmoothedStar {
  Eigen::Vector2d step;
  double before, distortion;
};

/// Where the distortion is least near the vertex, along the first axis if it lies on a mirror; the step is 0
/// where the distortion is infinite.
SmoothedStar least_distortion(const StarShape& shape);

}  // namespace orbitutte
