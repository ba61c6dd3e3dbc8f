// SPDX-License-Identifier: MIT
#include "orbitutte/orbifold/symmetry_group.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <queue>

#include "orbitutte/orbifold/tile.h"

namespace orbitutte {
namespace {

constexpr double isometry_tolerance = 1e-9;

void check_isometry(Space space, const Matrix3& matrix) {
  const double defect = space.isometry_defect(matrix);
  if (!(defect <= isometry_tolerance))
    throw ArgumentError(
        fmt::format("a generator of the symmetry group is no isometry of the {} space (off by {:.2g})",
                    space.name(), defect));
}

// Elements that are nearer to each other than this are one. The rounding of products grows with their
// entries, which are large far out in the hyperbolic plane.
double identity_tolerance(const Matrix3& matrix) { return 1e-6 * std::max(1.0, matrix.norm()); }

/// A linear function of the entries that changes by no more than the matrix does (in the Frobenius norm),
/// since its coefficients have norm below 1. They have no relation that would give many elements of a group
/// the same value.
double index_key(const Matrix3& matrix) {
  static const Matrix3 coefficients =
      (Matrix3() << 0.3141, -0.2236, 0.4358, 0.1732, 0.3605, -0.2828, -0.4123, 0.1414, 0.2645).finished();
  return coefficients.cwiseProduct(matrix).sum();
}

}  // namespace

SymmetryGroup::SymmetryGroup(Space space, const std::vector<Isometry>& generators, int max_order) {
  for (const Isometry& generator : generators) check_isometry(space, generator.matrix());
  insert({});
  // Products with the generators reach every element: in a finite group inverses are powers.
  for (int g = 0; g < order(); ++g) {
    for (const Isometry& generator : generators) {
      const Isometry product = space.nearest_isometry(elements_[g].matrix() * generator.matrix());
      if (find(product) >= 0) continue;
      if (order() >= max_order)
        throw ArgumentError(fmt::format(
            "the generators have more than {} products: they belong to no finite group of that size",
            max_order));
      insert(product);
    }
  }
}

SymmetryGroup SymmetryGroup::nearest_elements(Space space, const std::vector<Isometry>& generators,
                                              const Vector3& centre, int count) {
  for (const Isometry& generator : generators) check_isometry(space, generator.matrix());
  SymmetryGroup seen, nearest;
  seen.insert({});
  // Ordered by the distance of their images of the centre, rounded so that equal ones stay in the order in
  // which they were found.
  using Found = std::pair<long long, int>;
  const auto found = [&](int element) {
    return Found(std::llround(1e9 * space.distance(centre, seen.elements_[element] * centre)), element);
  };
  std::priority_queue<Found, std::vector<Found>, std::greater<>> waiting;
  waiting.push(found(0));
  while (nearest.order() < count && !waiting.empty()) {
    const Isometry element = seen.elements_[waiting.top().second];
    waiting.pop();
    nearest.insert(element);
    for (const Isometry& generator : generators) {
      for (const Isometry& step : {generator, generator.inverse()}) {
        const Isometry product = space.nearest_isometry(element.matrix() * step.matrix());
        if (seen.find(product) >= 0) continue;
        seen.insert(product);
        waiting.push(found(seen.order() - 1));
      }
    }
  }
  return nearest;
}

void SymmetryGroup::insert(const Isometry& element) {
  index_.emplace(index_key(element.matrix()), order());
  elements_.push_back(element);
}

int SymmetryGroup::find(const Isometry& element) const {
  const double key = index_key(element.matrix()), tolerance = identity_tolerance(element.matrix());
  const auto end = index_.end();
  int nearest = -1;
  double distance = tolerance;
  for (auto it = index_.lower_bound(key - tolerance); it != end && it->first <= key + tolerance; ++it) {
    const double d = (elements_[it->second].matrix() - element.matrix()).norm();
    if (d > distance) continue;
    nearest = it->second;
    distance = d;
  }
  return nearest;
}

std::vector<int> SymmetryGroup::right_products(const Isometry& element) const {
  std::vector<int> products(elements_.size());
  for (int g = 0; g < order(); ++g) products[g] = find(elements_[g] * element);
  return products;
}

namespace {

std::vector<Isometry> generators_of(const Tile& tile) {
  std::vector<Isometry> generators;
  for (const TileSide& side : tile.sides)
    if (!side.held()) generators.push_back(side.transform);
  return generators;
}

// The group of the target in the frame of the embedding.
SymmetryGroup placed(const SymmetryGroup& group, const Isometry& placement) {
  return placement.is_identity() ? group : group.conjugated(placement);
}

}  // namespace

SymmetryGroup SymmetryGroup::conjugated(const Isometry& isometry) const {
  SymmetryGroup result;
  result.insert({});  // exactly
  for (int g = 1; g < order(); ++g) result.insert(isometry * elements_[g] * isometry.inverse());
  return result;
}

bool tiles_its_space(const Target& target) {
  return std::all_of(target.marks.begin(), target.marks.end(),
                     [](const Mark& mark) { return mark.order() > 0; });
}

namespace {

// The group of a tile that has the shape of the surface, in the canonical frame: that which the seams
// generate, or the identity alone.
SymmetryGroup group_of_seams(const Embedding& embedding, int count) {
  const Isometry& placement = embedding.placement;
  std::vector<Isometry> generators;
  if (tiles_its_space(embedding.target))
    for (const Seam& seam : embedding.seams)
      generators.push_back(placement.inverse() * seam.transform * placement);
  const Vector3 middle =
      embedding.space().retract(embedding.canonical_positions().colwise().mean().transpose());
  return SymmetryGroup::nearest_elements(embedding.space(), generators, middle, count);
}

}  // namespace

SymmetryGroup group_of(const Target& target) {
  if (target.group_order == 0)
    throw ArgumentError(
        fmt::format("the group of {} is infinite; ask for a number of its elements", target.signature));
  const Tile tile = basic_tile(target, first_arrangement(target));
  SymmetryGroup group(target.space, generators_of(tile), target.group_order);
  if (group.order() != target.group_order)  // a claim of a report that was read
    throw ArgumentError(fmt::format("the group of {} has {} elements, not {}", target.signature,
                                    group.order(), target.group_order));
  return group;
}

SymmetryGroup group_of(const Target& target, int count) {
  if (target.space.is_closed()) return group_of(target);
  const Tile tile = basic_tile(target, first_arrangement(target));
  return SymmetryGroup::nearest_elements(target.space, generators_of(tile), tile.centroid(), count);
}

SymmetryGroup group_of(const Embedding& embedding) {
  return placed(group_of(embedding.target), embedding.placement);
}

SymmetryGroup canonical_group_of(const Embedding& embedding, int count) {
  return embedding.target.has_free_tile ? group_of_seams(embedding, count)
                                        : group_of(embedding.target, count);
}

SymmetryGroup group_of(const Embedding& embedding, int count) {
  return placed(canonical_group_of(embedding, count), embedding.placement);
}

}  // namespace orbitutte
