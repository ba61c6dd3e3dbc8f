// SPDX-License-Identifier: MIT
#include "orbitutte/solve/boundary_conditions.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <stdexcept>
#include <unordered_map>

#include "orbitutte/parallel.h"

namespace orbitutte {
namespace {

std::vector<Seam> seams_of(const std::vector<std::vector<int>>& sides, const Tile& tile) {
  std::vector<Seam> seams;
  for (int k = 0; k < static_cast<int>(sides.size()); ++k) {
    const int partner = tile.sides[k].partner;
    if (partner < k) continue;
    Seam seam = {sides[k], sides[partner], tile.sides[k].transform};
    if (tile.sides[k].partner_reverses()) std::reverse(seam.right.begin(), seam.right.end());
    seams.push_back(std::move(seam));
  }
  return seams;
}

std::vector<ConeCopies> cones_of(const CutMesh& cut, const Target& target) {
  std::vector<ConeCopies> cones;
  for (std::size_t k = 0; k < target.marks.size(); ++k) cones.push_back({cut.marks[k], target.marks[k], {}});
  for (int v : cut.boundary) {
    for (ConeCopies& cone : cones)
      if (cut.source_vertex[v] == cone.vertex) cone.copies.push_back(v);
  }
  for (ConeCopies& cone : cones) std::sort(cone.copies.begin(), cone.copies.end());
  return cones;
}

// Holds the corners of the tile where they belong.
void hold_corners(const Tile& tile, int input_vertices, BoundaryConditions& conditions) {
  for (std::size_t k = 0; k < tile.sides.size(); ++k) {
    const int corner = conditions.sides[k].front();
    if (corner >= input_vertices || tile.sides[k].slides) continue;  // copies go where their source goes
    conditions.basis_of[corner] = held_in_place;
    conditions.held[corner] = tile.sides[k].start;
  }
}

// The transforms of copies, from seam to seam in the order in which the boundary meets the left banks: a copy
// where a cut branches is met on the left after it was met on the right. At held corners the product of
// gluings is not unique, and none is needed but one that takes the input vertex's position to the copy's: it
// is that of the seam through which the copy is met first.
void spread_transforms(const std::vector<Seam>& seams, int input_vertices, BoundaryConditions& conditions) {
  std::vector<char> is_known(conditions.transform_of.size(), 0);
  std::fill(is_known.begin(), is_known.begin() + input_vertices, 1);
  const auto set = [&](int v, const Isometry& transform) {
    conditions.transform_of[v] = index_among(conditions.transforms, transform);
    is_known[v] = 1;
  };
  for (const Seam& seam : seams) {
    if (seam.is_mirror()) continue;
    for (std::size_t k = 0; k < seam.left.size(); ++k) {
      const int l = seam.left[k], r = seam.right[k];
      if (is_known[l] && !is_known[r]) {
        set(r, seam.transform.inverse() * conditions.transform(l));
      } else if (is_known[r] && !is_known[l]) {
        set(l, seam.transform * conditions.transform(r));
      }
    }
  }
}

void keep_on_mirrors(int input_vertices, BoundaryConditions& conditions) {
  for (const Seam& seam : conditions.seams) {
    if (!seam.is_mirror()) continue;
    conditions.mirrors.push_back(seam.transform);
    conditions.bases.push_back(conditions.space.room_on(seam.transform));
    for (const int v : seam.left) {
      if (v >= input_vertices) continue;  // a copy, at the end of the cut
      if (conditions.basis_of[v] != held_in_place)
        conditions.basis_of[v] = static_cast<int>(conditions.bases.size()) - 1;
    }
  }
}

void hold_unreferenced(const CutMesh& cut, BoundaryConditions& conditions) {
  std::vector<char> used(conditions.basis_of.size(), 0);
  for (const int v : cut.F.reshaped()) used[cut.source_vertex[v]] = 1;
  for (std::size_t v = 0; v < used.size(); ++v) {
    if (used[v]) continue;
    conditions.basis_of[v] = held_in_place;
    conditions.held[static_cast<int>(v)] = Vector3::UnitZ();
  }
}

// Where the boundary of the cut mesh meets the tile's corners: where a tree says, or, one after the other, at
// the marks.
std::vector<std::size_t> corners_met(const CutMesh& cut, const Tile& tile) {
  std::vector<std::size_t> corners;
  for (const CutSide& side : cut.sides) corners.push_back(static_cast<std::size_t>(side.begin));
  if (!corners.empty()) return corners;
  for (std::size_t k = 0; k < cut.boundary.size(); ++k) {
    if (corners.size() == tile.sides.size()) break;
    const int mark = tile.sides[corners.size()].mark;
    if (cut.source_vertex[cut.boundary[k]] == cut.marks[mark]) corners.push_back(k);
  }
  return corners;
}

// Side k of the tile takes the vertices of the boundary from its corner to the next one.
std::vector<std::vector<int>> boundary_sides(const CutMesh& cut, const Tile& tile) {
  const std::vector<std::size_t> corners = corners_met(cut, tile);
  if (corners.size() != tile.sides.size() || (!corners.empty() && corners.front() != 0))
    throw std::logic_error(
        "the boundary of the cut mesh does not meet the marked vertices as the tile's corners do");
  std::vector<std::vector<int>> sides(corners.size());
  for (std::size_t k = 0; k < corners.size(); ++k) {
    const std::size_t end = k + 1 < corners.size() ? corners[k + 1] : cut.boundary.size();
    sides[k].assign(cut.boundary.begin() + corners[k], cut.boundary.begin() + end);
    sides[k].push_back(cut.boundary[end % cut.boundary.size()]);
  }
  return sides;
}

}  // namespace

int index_among(std::vector<Isometry>& distinct, const Isometry& isometry) {
  for (std::size_t k = 0; k < distinct.size(); ++k)
    if (distinct[k].difference(isometry) < 1e-9) return static_cast<int>(k);
  distinct.push_back(isometry);
  return static_cast<int>(distinct.size()) - 1;
}

Vector3 BoundaryConditions::feasible(int vertex, Vector3 p) const {
  const int b = basis_of[vertex];
  if (b == held_in_place) return held_at(vertex);
  if (b != in_space) p += mirrors[b] * p;  // twice the middle between a point and its mirror image
  return space.retract(p);
}

void BoundaryConditions::make_feasible(Points& positions) const {
  parallel_ranges(static_cast<int>(positions.rows()), [&](int begin, int end) {
    for (int v = begin; v < end; ++v) positions.row(v) = feasible(v, positions.row(v));
  });
}

Points BoundaryConditions::spread(const Points& positions, const std::vector<int>& source_vertex) const {
  Points result(static_cast<Eigen::Index>(source_vertex.size()), 3);
  result.topRows(positions.rows()) = positions;
  for (Eigen::Index v = positions.rows(); v < result.rows(); ++v)
    result.row(v) = transform(static_cast<int>(v)) * positions.row(source_vertex[v]).transpose();
  return result;
}

BoundaryConditions glue(const CutMesh& cut, const Tile& tile, const Target& target) {
  int input_vertices = 0;
  while (input_vertices < cut.vertex_count() && cut.source_vertex[input_vertices] == input_vertices)
    ++input_vertices;
  BoundaryConditions conditions;
  conditions.space = tile.space();
  conditions.sides = boundary_sides(cut, tile);
  conditions.seams = seams_of(conditions.sides, tile);
  conditions.cones = cones_of(cut, target);
  conditions.transforms = {Isometry()};
  conditions.transform_of.assign(cut.vertex_count(), 0);
  conditions.bases = {tile.space().room(), Room(3, 0)};
  conditions.mirrors = {Isometry(), Isometry()};
  conditions.basis_of.assign(input_vertices, in_space);
  hold_corners(tile, input_vertices, conditions);
  spread_transforms(conditions.seams, input_vertices, conditions);
  keep_on_mirrors(input_vertices, conditions);
  hold_unreferenced(cut, conditions);
  return conditions;
}

}  // namespace orbitutte
