// SPDX-License-Identifier: MIT
// J. D. Dixon, "Computing irreducible representations of groups", Mathematics of Computation 24 (1970).
#include "orbitutte/orbifold/representations.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <random>
#include <stdexcept>

namespace orbitutte {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double same = 1e-8;  // tolerance for traces, entries, and eigenvalues in units of the largest

/// products[h][g] is the index of g h.
std::vector<std::vector<int>> multiplication_table(const SymmetryGroup& group) {
  std::vector<std::vector<int>> products;
  products.reserve(group.elements().size());
  for (const Isometry& h : group.elements()) products.push_back(group.right_products(h));
  return products;
}

/// A(g, g k) = a(k) with random a(k) = a(1/k). The matrix is symmetric and commutes with every translation
/// f(g) -> f(h g).
MatrixXd random_commuting_matrix(const std::vector<std::vector<int>>& products) {
  const int order = static_cast<int>(products.size());
  std::mt19937 random(1);
  std::normal_distribution<double> normal;
  MatrixXd A = MatrixXd::Zero(order, order);
  for (int k = 0; k < order; ++k) {
    const double a = normal(random);
    for (int g = 0; g < order; ++g) A(g, products[k][g]) = a;
  }
  return A + A.transpose().eval();
}

/// Q' P_g Q for every g, where Q spans an invariant space and P_g takes the basis vector of h to that of g h.
Representation restricted(const std::vector<std::vector<int>>& products, const MatrixXd& Q) {
  Representation result;
  result.dimension = static_cast<int>(Q.cols());
  const int order = static_cast<int>(products.size());
  for (int g = 0; g < order; ++g) {
    MatrixXd moved(order, Q.cols());
    for (int h = 0; h < order; ++h) moved.row(products[h][g]) = Q.row(h);
    result.matrices.emplace_back(Q.transpose() * moved);
  }
  return result;
}

/// Do both have the same traces? Then they differ only by the choice of a basis.
bool equivalent(const Representation& a, const Representation& b) {
  if (a.dimension != b.dimension) return false;
  for (std::size_t g = 0; g < a.matrices.size(); ++g)
    if (std::abs(a.matrices[g].trace() - b.matrices[g].trace()) > same) return false;
  return true;
}

/// The end of the run of equal eigenvalues that begins at `first`. Eigenvalues ascend.
Eigen::Index end_of_eigenspace(const VectorXd& eigenvalues, Eigen::Index first) {
  const double bound = eigenvalues[first] + same * eigenvalues.cwiseAbs().maxCoeff();
  Eigen::Index end = first;
  while (end < eigenvalues.size() && eigenvalues[end] <= bound) ++end;
  return end;
}

void add(Representation representation, std::vector<Representation>& kinds) {
  for (Representation& kind : kinds) {
    if (!equivalent(kind, representation)) continue;
    ++kind.multiplicity;
    return;
  }
  kinds.push_back(std::move(representation));
}

/// The largest entry of matrices[g] matrices[h] - matrices[g h].
double homomorphism_defect(const Representation& representation,
                           const std::vector<std::vector<int>>& products) {
  const std::vector<MatrixXd>& rho = representation.matrices;
  double defect = 0;
  for (std::size_t h = 0; h < products.size(); ++h)
    for (std::size_t g = 0; g < products.size(); ++g)
      defect = std::max(defect, (rho[g] * rho[h] - rho[products[h][g]]).cwiseAbs().maxCoeff());
  return defect;
}

/// Is the mean square of the traces dimension / multiplicity? For irreducible representations over the real
/// numbers both are dim End_G, which is 1, 2 or 4.
bool irreducible(const Representation& representation) {
  double square = 0;
  for (const MatrixXd& M : representation.matrices) square += M.trace() * M.trace();
  square /= static_cast<double>(representation.matrices.size());
  return std::abs(square * representation.multiplicity - representation.dimension) < same;
}

void require_decomposition(const std::vector<Representation>& kinds,
                           const std::vector<std::vector<int>>& products) {
  for (const Representation& kind : kinds)
    if (!irreducible(kind) || homomorphism_defect(kind, products) > same)
      throw std::logic_error("the regular representation was not taken apart");
}

}  // namespace

std::vector<Representation> irreducible_representations(const SymmetryGroup& group) {
  const std::vector<std::vector<int>> products = multiplication_table(group);
  const Eigen::SelfAdjointEigenSolver<MatrixXd> eigen(random_commuting_matrix(products));
  std::vector<Representation> kinds;
  for (Eigen::Index first = 0, end = 0; first < group.order(); first = end) {
    end = end_of_eigenspace(eigen.eigenvalues(), first);
    add(restricted(products, eigen.eigenvectors().middleCols(first, end - first)), kinds);
  }
  require_decomposition(kinds, products);
  std::stable_sort(kinds.begin(), kinds.end(), [](const Representation& a, const Representation& b) {
    return a.dimension < b.dimension;
  });
  return kinds;
}

int occurrences_in_space(const Representation& representation, const SymmetryGroup& group) {
  double sum = 0;
  for (int g = 0; g < group.order(); ++g)
    sum += representation.matrices[g].trace() * group.elements()[g].matrix().trace();
  return static_cast<int>(std::lround(sum / group.order()));
}

Eigen::MatrixXd fixed_vectors(const Representation& representation, const std::vector<int>& elements) {
  const int d = representation.dimension;
  // x is fixed if the sum of |rho(g) x - x|^2 = 2 x'(1 - rho(g)) x is zero.
  MatrixXd A = MatrixXd::Zero(d, d);
  for (const int g : elements)
    A += 2 * MatrixXd::Identity(d, d) - representation.matrices[g] - representation.matrices[g].transpose();
  const Eigen::SelfAdjointEigenSolver<MatrixXd> eigen(A);
  Eigen::Index fixed = 0;
  while (fixed < d && eigen.eigenvalues()[fixed] < same) ++fixed;
  return eigen.eigenvectors().leftCols(fixed);
}

}  // namespace orbitutte
