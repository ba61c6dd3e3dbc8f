// SPDX-License-Identifier: MIT
#include "orbitutte/solve/boundary_conditions.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <stdexcept>
#include <unordered_map>

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

std::vector<ConeCopies> cones_of(const CutMesh& cut, const Orbifold& orbifold) {
  std::vector<ConeCopies> cones;
  for (std::size_t k = 0; k < orbifold.marks.size(); ++k)
    cones.push_back({cut.marks[k], orbifold.marks[k].order, orbifold.marks[k].kind, {}});
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
    conditions.held.row(corner) = tile.sides[k].start;
  }
}

// The transform of the copies of held corners: the product of gluings is not unique there, and none is needed
// but one that takes the input vertex's position to the copy's. It is that of the seam through which the copy
// is met.
void spread_transforms(const std::vector<Seam>& seams, int input_vertices, BoundaryConditions& conditions) {
  for (const Seam& seam : seams) {
    if (seam.left == seam.right) continue;
    for (std::size_t k = 0; k < seam.left.size(); ++k) {
      const int l = seam.left[k], r = seam.right[k];
      if (r >= input_vertices && l < input_vertices) {
        conditions.transform_of[r] = index_among(conditions.transforms, inverse_isometry(seam.transform));
      } else if (l >= input_vertices && r < input_vertices) {
        conditions.transform_of[l] = index_among(conditions.transforms, seam.transform);
      }
    }
  }
}

// All of space, or of the plane.
Basis room_inside(Geometry geometry) {
  return Matrix3::Identity().leftCols(geometry == Geometry::spherical ? 3 : 2);
}

// What a reflection leaves in place: the plane I - 2 n n' does, or the direction of a line of the plane.
Basis room_on_mirror(const Matrix3& reflection, Geometry geometry) {
  const Matrix3 twice_projector = Matrix3::Identity() - linear_part(reflection);  // 2 n n'
  Eigen::Index axis = 0;
  twice_projector.diagonal().maxCoeff(&axis);
  const Vector3 normal = twice_projector.col(axis).normalized();
  if (geometry == Geometry::euclidean) return Vector3(-normal.y(), normal.x(), 0);
  Basis basis(3, 2);
  basis.col(0) = normal.unitOrthogonal();
  basis.col(1) = normal.cross(basis.col(0));
  return basis;
}

void keep_on_mirrors(Geometry geometry, int input_vertices, BoundaryConditions& conditions) {
  for (const Seam& seam : conditions.seams) {
    if (seam.left != seam.right) continue;
    conditions.bases.push_back(room_on_mirror(seam.transform, geometry));
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
    conditions.held.row(static_cast<Eigen::Index>(v)) = Vector3::UnitZ();
  }
}

// Side k of the tile takes the vertices of the boundary from its corner to the next one.
std::vector<std::vector<int>> boundary_sides(const CutMesh& cut, const Tile& tile) {
  std::vector<std::size_t> corners;
  for (std::size_t k = 0; k < cut.boundary.size(); ++k) {
    if (corners.size() == tile.sides.size()) break;
    const int mark = tile.sides[corners.size()].mark;
    if (cut.source_vertex[cut.boundary[k]] == cut.marks[mark]) corners.push_back(k);
  }
  if (corners.size() != tile.sides.size() || corners.front() != 0)
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

int index_among(std::vector<Matrix3>& distinct, const Matrix3& matrix) {
  for (std::size_t k = 0; k < distinct.size(); ++k)
    if ((distinct[k] - matrix).cwiseAbs().maxCoeff() < 1e-9) return static_cast<int>(k);
  distinct.push_back(matrix);
  return static_cast<int>(distinct.size()) - 1;
}

Points BoundaryConditions::spread(const Points& positions, const std::vector<int>& source_vertex) const {
  Points result(static_cast<Eigen::Index>(source_vertex.size()), 3);
  result.topRows(positions.rows()) = positions;
  for (Eigen::Index v = positions.rows(); v < result.rows(); ++v)
    result.row(v) = positions.row(source_vertex[v]) * transform(static_cast<int>(v)).transpose();
  return result;
}

BoundaryConditions glue(const CutMesh& cut, const Tile& tile, const Orbifold& orbifold) {
  int input_vertices = 0;
  while (input_vertices < cut.vertex_count() && cut.source_vertex[input_vertices] == input_vertices)
    ++input_vertices;
  BoundaryConditions conditions;
  conditions.sides = boundary_sides(cut, tile);
  conditions.seams = seams_of(conditions.sides, tile);
  conditions.cones = cones_of(cut, orbifold);
  conditions.transforms = {Matrix3::Identity()};
  conditions.transform_of.assign(cut.vertex_count(), 0);
  conditions.bases = {room_inside(tile.geometry()), Basis(3, 0)};
  conditions.basis_of.assign(input_vertices, in_space);
  conditions.held = Points::Zero(input_vertices, 3);
  hold_corners(tile, input_vertices, conditions);
  spread_transforms(conditions.seams, input_vertices, conditions);
  keep_on_mirrors(tile.geometry(), input_vertices, conditions);
  hold_unreferenced(cut, conditions);
  return conditions;
}

}  // namespace orbitutte
