// SPDX-License-Identifier: MIT
#include "orbitutte/cones/scale_kernel.h"

#include <Eigen/Geometry>
#include <array>
#include <cmath>
#include <numbers>

#include "orbitutte/linear/dissection.h"
#include "orbitutte/mesh/intrinsic_triangulation.h"

namespace orbitutte {
namespace {

using std::numbers::pi;

// A solve takes so many columns at once: enough to be quick, few enough to be small.
constexpr int columns_at_once = 8;

// The angles of a triangle in space. Their sum is pi even if it has no area.
std::array<double, 3> angles_of_triangle(const Points& V, const Eigen::RowVector3i& corners) {
  std::array<double, 3> result = {0, 0, pi};
  for (int i = 0; i < 2; ++i) {
    const Vector3 p = V.row(corners[i]), u = V.row(corners[(i + 1) % 3]).transpose() - p,
                  v = V.row(corners[(i + 2) % 3]).transpose() - p;
    result[i] = std::atan2(u.cross(v).norm(), u.dot(v));
    result[2] -= result[i];
  }
  return result;
}

const std::vector<std::array<int, 2>>& edges_with_weights(const Surface& surface,
                                                          const EdgeWeights& weights) {
  return weights.triangulation ? weights.triangulation->connectivity.edges : surface.connectivity.edges;
}

// One unknown for each vertex that a face uses, but for the first such vertex, which is held at zero.
std::vector<int> unknown_counts(const Triangles& F, int vertex_count) {
  std::vector<int> count(vertex_count, 0);
  for (const int v : F.reshaped()) count[v] = 1;
  count[F(0, 0)] = 0;
  return count;
}

}  // namespace

ScaleKernel::ScaleKernel(const Surface& surface, const EdgeWeights& weights, Backend backend)
    : surface_(surface) {
  measure();
  const Neighbors near = vertex_neighbors(edges_with_weights(surface, weights), surface.vertex_count());
  unknowns_ = number_unknowns(dissect(near).order, unknown_counts(surface.triangles, surface.vertex_count()));
  factor_ = factorize_laplacian(
      assemble(unknowns_, near, weights.w, [](int, int) -> Block { return Block::Ones(1, 1); }), unknowns_,
      backend);
  const Eigen::VectorXd even = solve(curvature_ - curvature_.sum() * share_);
  even_variance_ = even.cwiseAbs2().dot(share_);
  even_potential_ = solve(even.cwiseProduct(share_));
}

ScaleKernel::~ScaleKernel() = default;

void ScaleKernel::measure() {
  const Triangles& F = surface_.triangles;
  const int n = surface_.vertex_count();
  curvature_.setZero(n);
  share_ = surface_.vertex_areas();
  flat_angle_.assign(n, 0);
  for (const int v : F.reshaped()) flat_angle_[v] = 2 * pi;
  const std::vector<char> on_boundary = surface_.boundary_vertices();
  for (int v = 0; v < n; ++v)
    if (on_boundary[v]) flat_angle_[v] = pi;
  for (int v = 0; v < n; ++v) curvature_[v] = flat_angle_[v];
  for (Eigen::Index f = 0; f < F.rows(); ++f) {
    const std::array<double, 3> angles = angles_of_triangle(surface_.V, F.row(f));
    for (int i = 0; i < 3; ++i) curvature_[F(f, i)] -= angles[i];
  }
  share_ /= share_.sum();
}

Eigen::MatrixXd ScaleKernel::solve(const Eigen::MatrixXd& columns) const {
  Eigen::MatrixXd packed(unknowns_.total, columns.cols());
  for (const int v : unknowns_.order) packed.row(unknowns_.first[v]) = columns.row(v);
  packed = factor_->solve(packed);
  Eigen::MatrixXd result = Eigen::MatrixXd::Zero(columns.rows(), columns.cols());
  for (const int v : unknowns_.order) result.row(v) = packed.row(unknowns_.first[v]);
  const Eigen::RowVectorXd means = share_.transpose() * result;
  result.rowwise() -= means;
  return result;
}

Eigen::MatrixXd ScaleKernel::potentials(const std::vector<int>& vertices) const {
  const int count = static_cast<int>(vertices.size());
  Eigen::MatrixXd result(surface_.vertex_count(), count);
  for (int begin = 0; begin < count; begin += columns_at_once) {
    const int columns = std::min(columns_at_once, count - begin);
    Eigen::MatrixXd moved = (-share_).replicate(1, columns);
    for (int c = 0; c < columns; ++c) moved(vertices[begin + c], c) += 1;
    moved = solve(moved);
    result.middleCols(begin, columns) = solve(share_.asDiagonal() * moved);
  }
  return result;
}

Eigen::VectorXd ScaleKernel::target_shares(const std::vector<int>& cones,
                                           const Eigen::VectorXd& curvatures) const {
  Eigen::VectorXd right = curvature_ - (curvature_.sum() - curvatures.sum()) * share_;
  for (std::size_t k = 0; k < cones.size(); ++k) right[cones[k]] -= curvatures[static_cast<Eigen::Index>(k)];
  const Eigen::ArrayXd u = solve(right).array();
  const Eigen::VectorXd areas = share_.array() * (2 * (u.minCoeff() - u)).exp();
  return areas(cones) / areas.sum();
}

}  // namespace orbitutte
