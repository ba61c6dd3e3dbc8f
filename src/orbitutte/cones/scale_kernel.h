// SPDX-License-Identifier: MIT
// How the scale of a conformal map depends on where the curvature of its target lies: by one factorisation of
// the surface's Laplacian.
#pragma once

#include <memory>
#include <vector>

#include "orbitutte/linear/laplacian_matrix.h"
#include "orbitutte/mesh/edge_weights.h"
#include "orbitutte/mesh/surface.h"

namespace orbitutte {

/// The scale exp(-u) of lengths that gives a surface another curvature, whole curvatures of vertices being
///     K_v = 2 pi - (the angles at v), on the boundary pi - (the angles at v):
///     L u = K - a M - sum over cones of kappa_v delta_v,
/// with the Laplacian L of the weights, the shares M of the vertices in the surface's area, the curvature
/// kappa_v of each cone, and the rest a, spread evenly (BFF: R. Sawhney, K. Crane, "Boundary first
/// flattening", ACM TOG 37 (2018), its (3)). All curvatures together are 2 pi chi, so
///     u = u_0 - sum of kappa_v c_v,  L u_0 = K - 2 pi chi M,  L c_v = delta_v - M,
/// all of mean zero. sigma^2, the variance of u, needs products of these functions alone, and the products of
/// one c_v with all others are a single vector, its potential L^-1 M c_v.
class ScaleKernel {
 public:
  /// Factorises. Refers to the surface. Throws MeshError naming a vertex that no positive weight ties to the
  /// others.
  ScaleKernel(const Surface& surface, const EdgeWeights& weights, Backend backend);
  ~ScaleKernel();

  const Surface& surface() const { return surface_; }

  /// 2 pi chi.
  double total_curvature() const { return curvature_.sum(); }

  /// What the angles around a vertex add up to where it is no cone: 2 pi, on the boundary pi.
  double flat_angle(int vertex) const { return flat_angle_[vertex]; }

  /// flat_angle less the angles around a vertex.
  double curvature(int vertex) const { return curvature_[vertex]; }

  /// n x c: of each vertex, the mean of c_v c_w over the surface for all vertices w.
  Eigen::MatrixXd potentials(const std::vector<int>& vertices) const;

  /// n: the mean of u_0 c_w for all vertices w.
  const Eigen::VectorXd& even_potential() const { return even_potential_; }

  /// Of each cone, about the part of the target's area that the triangles around it get: that of the vertex,
  /// exp(-2u) M_v. The curvatures are those of the cones.
  Eigen::VectorXd target_shares(const std::vector<int>& cones, const Eigen::VectorXd& curvatures) const;

  /// The mean of u_0^2: sigma^2 without cones.
  double even_variance() const { return even_variance_; }

 private:
  /// L^-1 of the columns, each of sum zero, up to constants that make the results' means zero.
  Eigen::MatrixXd solve(const Eigen::MatrixXd& columns) const;

  void measure();

  const Surface& surface_;
  std::vector<double> flat_angle_;

  /// n: K, and M, whose sum is one.
  Eigen::VectorXd curvature_, share_;

  Unknowns unknowns_;
  std::unique_ptr<SparseFactor> factor_;
  Eigen::VectorXd even_potential_;
  double even_variance_ = 0;
};

}  // namespace orbitutte
