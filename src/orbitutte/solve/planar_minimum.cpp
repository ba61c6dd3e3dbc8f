// SPDX-License-Identifier: MIT
#include "orbitutte/solve/planar_minimum.h"

namespace orbitutte {
namespace {

// What gluings do to displacements.
GluedEdges linear_parts(const GluedEdges& glued) {
  GluedEdges result = glued;
  for (Matrix3& transform : result.transforms) transform = linear_part(transform);
  return result;
}

// Any positions that are feasible: vertices on a mirror at one end of it, those inside where they are not
// held.
Points feasible_positions(const BoundaryConditions& boundary) {
  Points positions = boundary.held;
  for (Eigen::Index v = 0; v < positions.rows(); ++v)
    if (boundary.basis(static_cast<int>(v)).cols() > 0) positions.row(v) = Eigen::RowVector3d(0, 0, 1);
  for (const Seam& seam : boundary.seams) {
    if (seam.left != seam.right) continue;
    const int end = seam.left.front();  // a corner, which is held
    for (const int v : seam.left)
      if (v < positions.rows() && boundary.basis(v).cols() == 1) positions.row(v) = boundary.held.row(end);
  }
  return positions;
}

// The energy, and its gradient grad_i E = 2 sum over j of w_ij (p_i - g_ij p_j), projected onto the room of
// each vertex.
double evaluate(const GluedEdges& glued, const EdgeWeights& weights, const BoundaryConditions& boundary,
                const Points& positions, Points& gradient) {
  double energy = 0;
  gradient = Points::Zero(positions.rows(), 3);
  for (std::size_t e = 0; e < glued.edges.size(); ++e) {
    const auto [i, j, t] = glued.edges[e];
    const Matrix3& g = glued.transforms[t];
    const double w = weights.w[static_cast<Eigen::Index>(e)];
    const Vector3 difference = positions.row(i).transpose() - g * positions.row(j).transpose();
    energy += w * difference.squaredNorm();
    gradient.row(i) += 2 * w * difference;
    gradient.row(j) -= 2 * w * linear_part(g).transpose() * difference;
  }
  std::vector<Matrix3> projectors;
  for (const Basis& room : boundary.bases) projectors.emplace_back(room * room.transpose());
  for (Eigen::Index v = 0; v < gradient.rows(); ++v)
    gradient.row(v) = projectors[boundary.basis_of[v]] * Vector3(gradient.row(v));
  return energy;
}

}  // namespace

PlanarMinimum planar_minimum(const CutMesh& cut, const GluedEdges& glued, const EdgeWeights& weights,
                             const BoundaryConditions& boundary, const LaplacianSetup& setup) {
  const GluedEdges linear = linear_parts(glued);
  const LaplacianSolver laplacian(cut, linear, weights, boundary, setup);
  PlanarMinimum minimum = {feasible_positions(boundary)};
  Points gradient;
  for (int step = 0; step < 2; ++step) {
    evaluate(glued, weights, boundary, minimum.positions, gradient);
    minimum.positions -= laplacian.precondition(gradient);
  }
  minimum.energy = evaluate(glued, weights, boundary, minimum.positions, gradient);
  minimum.gradient_norm = gradient.cwiseAbs().maxCoeff();
  return minimum;
}

}  // namespace orbitutte
