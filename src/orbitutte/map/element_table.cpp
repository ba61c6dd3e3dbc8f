// SPDX-License-Identifier: MIT
#include "orbitutte/map/element_table.h"

#include <algorithm>
#include <cmath>
#include <queue>
#include <set>
#include <tuple>

#include "orbitutte/geometry/precise_isometry.h"
#include "orbitutte/orbifold/exact_positions.h"
#include "orbitutte/orbifold/symmetry_group.h"
#include "orbitutte/verify/exact_group.h"

namespace orbitutte {
namespace {

double largest_entry_of(const Matrix3& matrix) { return std::max(1.0, matrix.cwiseAbs().maxCoeff()); }

// Are all digits of both the same that 320 bits have, but for rounding?
bool are_equal(const Matrix3Of<Precise>& a, const Matrix3Of<Precise>& b, double size) {
  const Precise tolerance = ldexp(Precise(size), -200);
  for (int i = 0; i < 9; ++i)
    if (abs(Precise(a.data()[i] - b.data()[i])) > tolerance) return false;
  return true;
}

Matrix3Of<DoubleDouble> fine_matrix(const Matrix3Of<Precise>& precise, const Matrix3& rough) {
  const Matrix3 rest = (precise - rough.cast<Precise>()).cast<double>();
  Matrix3Of<DoubleDouble> result;
  for (int i = 0; i < 9; ++i) result.data()[i] = DoubleDouble::sum(rough.data()[i], rest.data()[i]);
  return result;
}

}  // namespace

ElementTable::ElementTable(Space space) : space_(space) { add(Matrix3Of<MostPrecise>::Identity()); }

int ElementTable::add(const Matrix3Of<MostPrecise>& matrix) {
  const Matrix3Of<Precise> precise = matrix.cast<Precise>();
  const Matrix3 rough = matrix.cast<double>();
  const double size = largest_entry_of(rough);
  for (int g = 0; g < count(); ++g)
    if ((elements_[g].rough.matrix() - rough).cwiseAbs().maxCoeff() <= 1e-12 * size &&
        are_equal(elements_[g].precise, precise, size))
      return g;
  const Matrix3 inverse = precise_inverse(space_, matrix).cast<double>();
  elements_.push_back({Isometry(rough, inverse), fine_matrix(precise, rough), precise, matrix});
  return count() - 1;
}

int ElementTable::product(int first, int second) {
  if (first == identity) return second;
  if (second == identity) return first;
  const std::uint64_t key = static_cast<std::uint64_t>(first) << 32 | static_cast<std::uint32_t>(second);
  if (const auto at = products_.find(key); at != products_.end()) return at->second;
  const Matrix3Of<MostPrecise> matrix = exact(first) * exact(second);
  return products_[key] = add(matrix);
}

int ElementTable::inverse(int element) {
  if (element == identity) return identity;
  if (const auto at = inverses_.find(element); at != inverses_.end()) return at->second;
  const int result = add(precise_inverse(space_, exact(element)));
  inverses_[element] = result;
  inverses_[result] = element;
  return result;
}

// Each step of M (3 - M^-1 M)/2 doubles the digits (Space::nearest_isometry).
Matrix3Of<MostPrecise> exact_isometry(Space space, const Isometry& isometry) {
  constexpr int steps = 8;
  Matrix3Of<MostPrecise> result = isometry.matrix().cast<MostPrecise>();
  if (isometry.is_identity()) return result;
  for (int step = 0; step < steps; ++step) {
    const Matrix3Of<MostPrecise> rest = precise_inverse(space, result) * result;
    result = (result * (MostPrecise(3) * Matrix3Of<MostPrecise>::Identity() - rest) / MostPrecise(2)).eval();
  }
  return result;
}

SharedGroup::SharedGroup(const Embedding& a, const Embedding& b)
    : space_(a.space()), is_free_(a.target.has_free_tile), group_(a.target) {
  if (is_free_) take_generators(a.offsets.empty() && !b.offsets.empty() ? b : a);
}

void SharedGroup::take_generators(const Embedding& embedding) {
  const ExactPositions positions(embedding);
  const PreciseGroup<MostPrecise> group = exact_group(embedding, positions);
  const Matrix3Of<MostPrecise> out = exact_isometry(space_, embedding.placement),
                               back = precise_inverse(space_, out);
  for (const Seam& seam : embedding.seams) {
    const Matrix3Of<MostPrecise> element = back * group.element(seam.transform) * out,
                                 inverse = precise_inverse(space_, element);
    const Isometry rough(element.cast<double>(), inverse.cast<double>());
    generators_.push_back({rough, element});
    generators_.push_back({rough.inverse(), inverse});
  }
  list_words();
}

// Those that move (0, 0, 1) least first. Elements that agree to some digits are the same.
void SharedGroup::list_words() {
  constexpr std::size_t most_words = 20000;
  constexpr double largest_entry = 1e6;
  using Key = std::tuple<long long, long long, long long, bool>;
  const auto key_of = [](const Isometry& g) {
    const auto digits = [&](int i, int j) { return std::llround(1e6 * g.matrix()(i, j)); };
    return Key(digits(0, 2), digits(1, 2), digits(0, 0) + 3 * digits(1, 0), g.reverses_orientation());
  };
  const auto moves_less = [&](int x, int y) {
    return words_[x].rough.matrix().col(2).squaredNorm() > words_[y].rough.matrix().col(2).squaredNorm();
  };
  words_ = {{Isometry(), -1, -1}};
  std::set<Key> known = {key_of(Isometry())};
  std::priority_queue<int, std::vector<int>, decltype(moves_less)> waiting(moves_less);
  waiting.push(0);
  while (!waiting.empty() && words_.size() < most_words) {
    const int k = waiting.top();
    waiting.pop();
    for (std::size_t g = 0; g < generators_.size(); ++g) {
      const Isometry product = words_[k].rough * generators_[g].rough;
      if (!(largest_entry_of(product.matrix()) < largest_entry) || !known.insert(key_of(product)).second)
        continue;
      words_.push_back({product, k, static_cast<int>(g)});
      waiting.push(static_cast<int>(words_.size()) - 1);
    }
  }
}

Matrix3Of<MostPrecise> SharedGroup::product_of(int word) const {
  Matrix3Of<MostPrecise> result = Matrix3Of<MostPrecise>::Identity();
  for (int k = word; words_[k].parent >= 0; k = words_[k].parent)
    result = (generators_[words_[k].generator].precise * result).eval();
  return result;
}

std::vector<Isometry> SharedGroup::elements_near(const Embedding& embedding) const {
  constexpr int most_elements = 200;
  if (!is_free_) return canonical_group_of(embedding, most_elements).elements();
  std::vector<Isometry> result;
  for (const Word& word : words_) result.push_back(word.rough);
  return result;
}

Matrix3Of<MostPrecise> SharedGroup::element(const Isometry& isometry) const {
  constexpr double tolerance = 1e-5;
  if (!is_free_) return isometry.is_identity() ? exact_isometry(space_, isometry) : group_.element(isometry);
  const double size = largest_entry_of(isometry.matrix());
  int nearest = 0;
  for (int k = 1; k < static_cast<int>(words_.size()); ++k)
    if (words_[k].rough.difference(isometry) < words_[nearest].rough.difference(isometry)) nearest = k;
  if (!(words_[nearest].rough.difference(isometry) <= tolerance * size))
    throw ArgumentError(
        "the embeddings do not lie on the same tile: a gluing of one is no product of gluings of the other");
  return product_of(nearest);
}

}  // namespace orbitutte
