// SPDX-License-Identifier: MIT
#include "orbitutte/orbifold/symmetry_group.h"

#include <fmt/format.h>

namespace orbitutte {
namespace {

constexpr double orthogonality_tolerance = 1e-9;
constexpr double identity_tolerance = 1e-6;  // elements nearer to each other than this are equal

void check_orthogonal(const Matrix3& matrix) {
  const double defect = (matrix.transpose() * matrix - Matrix3::Identity()).cwiseAbs().maxCoeff();
  if (!(defect <= orthogonality_tolerance))  // true for NaN, too
    throw ArgumentError(
        fmt::format("a generator of the symmetry group is not orthogonal (off by {:.2g})", defect));
}

/// The orthogonal matrix nearest to an almost orthogonal one: one step of Newton's iteration for the polar
/// factor, X (3 I - X'X) / 2, which squares the error.
Matrix3 orthogonalized(const Matrix3& matrix) {
  return 0.5 * matrix * (3 * Matrix3::Identity() - matrix.transpose() * matrix);
}

/// A linear function of the entries that changes by no more than the matrix does (Frobenius norm), since the
/// norm of its coefficients is below 1. The coefficients satisfy no relation that would give many elements of
/// a group the same value.
double index_key(const Matrix3& matrix) {
  static const Matrix3 coefficients =
      (Matrix3() << 0.3141, -0.2236, 0.4358, 0.1732, 0.3605, -0.2828, -0.4123, 0.1414, 0.2645).finished();
  return coefficients.cwiseProduct(matrix).sum();
}

}  // namespace

SymmetryGroup::SymmetryGroup(const std::vector<Matrix3>& generators, int max_order) {
  for (const Matrix3& generator : generators) check_orthogonal(generator);
  insert(Matrix3::Identity());
  // Products with the generators reach every element, since in a finite group inverses are powers.
  for (int g = 0; g < order(); ++g) {
    for (const Matrix3& generator : generators) {
      const Matrix3 product = orthogonalized(elements_[g] * generator);
      if (find(product) >= 0) continue;
      if (order() >= max_order)
        throw ArgumentError(fmt::format(
            "the generators have more than {} products: they belong to no finite group of that size",
            max_order));
      insert(product);
    }
  }
}

void SymmetryGroup::insert(const Matrix3& element) {
  index_.emplace(index_key(element), order());
  elements_.push_back(element);
}

int SymmetryGroup::find(const Matrix3& matrix) const {
  const double key = index_key(matrix);
  const auto end = index_.end();
  int nearest = -1;
  double distance = identity_tolerance;
  for (auto it = index_.lower_bound(key - identity_tolerance);
       it != end && it->first <= key + identity_tolerance; ++it) {
    const double d = (elements_[it->second] - matrix).norm();
    if (d > distance) continue;
    nearest = it->second;
    distance = d;
  }
  return nearest;
}

std::vector<int> SymmetryGroup::right_products(const Matrix3& element) const {
  std::vector<int> products(elements_.size());
  for (int g = 0; g < order(); ++g) {
    products[g] = find(elements_[g] * element);
    if (products[g] < 0) throw ArgumentError("a transform does not belong to the symmetry group");
  }
  return products;
}

}  // namespace orbitutte
