// SPDX-License-Identifier: MIT
#include "orbitutte/inspect/coincidence.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <tuple>

namespace orbitutte {
namespace {

constexpr double near = 1e-6;  // of the boundary's size
// More vertices in one cell than a vertex has neighbours on the boundary: one of them is not a neighbour.
constexpr std::size_t enough_of_a_cell = 3;

using Cell = std::array<std::int64_t, 3>;

struct CellVertex {
  Cell cell;
  int vertex;
  auto key() const { return std::tie(cell, vertex); }
};

std::vector<int> finite_vertices(const Points& V, const std::vector<std::array<int, 2>>& edges) {
  std::vector<int> vertices;
  for (const auto& edge : edges)
    for (const int v : edge)
      if (V.row(v).allFinite()) vertices.push_back(v);
  std::sort(vertices.begin(), vertices.end());
  vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
  return vertices;
}

// The boundary's vertices in cells as wide as the distance that counts as near. Vertices that are near each
// other lie in the same cell or in cells that touch.
class Cells {
 public:
  Cells(const Points& V, const std::vector<int>& vertices) : V_(V) {
    Eigen::Array3d lowest = V.row(vertices.front()), highest = lowest;
    for (const int v : vertices) {
      lowest = lowest.min(V.row(v).array().transpose());
      highest = highest.max(V.row(v).array().transpose());
    }
    const double size = (highest - lowest).maxCoeff();
    width_ = size > 0 ? near * size : 1.0;
    for (const int v : vertices) {
      const Eigen::Array3d place = (V.row(v).array().transpose() - lowest) / width_;
      list_.push_back({{std::int64_t(place[0]), std::int64_t(place[1]), std::int64_t(place[2])}, v});
    }
    std::sort(list_.begin(), list_.end(),
              [](const CellVertex& a, const CellVertex& b) { return a.key() < b.key(); });
  }

  // visit(v, w) for vertices that may be near each other, each pair once.
  template <class Visit>
  void visit_pairs(const Visit& visit) const {
    for (std::size_t i = 0; i < list_.size(); ++i) {
      visit_cell(i, i + 1, list_[i].cell, visit);
      for (int k = 14; k < 27; ++k) {  // half of the cells around, 13 being the cell itself
        const Cell& c = list_[i].cell;
        const Cell beside = {c[0] + k / 9 - 1, c[1] + k / 3 % 3 - 1, c[2] + k % 3 - 1};
        visit_cell(i, first_of(beside), beside, visit);
      }
    }
  }

  double distance(int v, int w) const { return (V_.row(v) - V_.row(w)).stableNorm(); }
  bool are_near(int v, int w) const { return distance(v, w) <= 2 * width_; }

 private:
  std::size_t first_of(const Cell& cell) const {
    const auto at = std::lower_bound(list_.begin(), list_.end(), cell,
                                     [](const CellVertex& one, const Cell& c) { return one.cell < c; });
    return static_cast<std::size_t>(at - list_.begin());
  }

  template <class Visit>
  void visit_cell(std::size_t i, std::size_t begin, const Cell& cell, const Visit& visit) const {
    for (std::size_t j = begin; j < list_.size() && list_[j].cell == cell; ++j) {
      if (j == begin + enough_of_a_cell) break;
      visit(list_[i].vertex, list_[j].vertex);
    }
  }

  const Points& V_;
  double width_ = 1;
  std::vector<CellVertex> list_;
};

}  // namespace

std::optional<Coincidence> find_coincidence(const Points& V,
                                            const std::vector<std::array<int, 2>>& boundary) {
  const std::vector<int> vertices = finite_vertices(V, boundary);
  if (vertices.empty()) return std::nullopt;
  std::vector<std::array<int, 2>> joined;
  joined.reserve(boundary.size());
  for (const auto& [v, w] : boundary) joined.push_back({std::min(v, w), std::max(v, w)});
  std::sort(joined.begin(), joined.end());

  std::optional<Coincidence> first;
  const auto key = [](const Coincidence& c) { return std::tuple(c.distance > 0, c.vertex, c.other); };
  const Cells cells(V, vertices);
  cells.visit_pairs([&](int v, int w) {
    const Coincidence found = {std::min(v, w), std::max(v, w), cells.distance(v, w)};
    if (!cells.are_near(v, w) || (first && key(*first) < key(found))) return;
    if (!std::binary_search(joined.begin(), joined.end(), std::array{found.vertex, found.other}))
      first = found;
  });
  return first;
}

std::string welding_advice(const std::optional<Coincidence>& coincidence) {
  if (!coincidence) return {};
  const auto& [vertex, other, distance] = *coincidence;
  const std::string where =
      distance > 0 ? fmt::format("only {:.2g} apart", distance) : std::string("at the same point");
  return fmt::format("vertices {} and {} are {}: weld such vertices first", vertex, other, where);
}

std::string in_brackets(const std::string& sentence) {
  return sentence.empty() ? sentence : " (" + sentence + ")";
}

}  // namespace orbitutte
