// SPDX-License-Identifier: MIT
// The gluing of the cut mesh's boundary (equations (3), (4) and (7)), as one unknown per input vertex.
#pragma once

#include <unordered_map>
#include <vector>

#include "orbitutte/cut/cut.h"
#include "orbitutte/orbifold/embedding.h"
#include "orbitutte/orbifold/tile.h"

namespace orbitutte {

/// The first two of BoundaryConditions::bases: all of space, and no room at all.
constexpr int in_space = 0, held_in_place = 1;

/// Every cut vertex is a symmetry's image of one input vertex: position(v) = transform(v) *
/// position(source(v)), so the cut is a choice of gauge and the unknowns do not know where it runs. Input
/// vertex v is cut vertex v.
struct BoundaryConditions {
  Space space;
  std::vector<std::vector<int>>
      sides;  ///< of the tile: the cut vertices from each corner to the next, both included
  std::vector<Seam> seams;
  std::vector<ConeCopies> cones;
  /// Distinct; the first is the identity.
  std::vector<Isometry> transforms;
  /// n_cut: an index into transforms.
  std::vector<int> transform_of;
  /// Distinct; 0: that of the space (Space::room), 1: held in place (3 x 0), others: those of mirrors.
  std::vector<Room> bases;
  /// Of every basis: the reflection that keeps it; the identity for 0 and 1.
  std::vector<Isometry> mirrors;
  /// n: an index into bases.
  std::vector<int> basis_of;
  /// Where the vertices of basis 1 are held.
  std::unordered_map<int, Vector3> held;

  const Isometry& transform(int cut_vertex) const { return transforms[transform_of[cut_vertex]]; }
  const Room& basis(int vertex) const { return bases[basis_of[vertex]]; }
  int vertex_count() const { return static_cast<int>(basis_of.size()); }

  /// Where a vertex is held; zero if it is not.
  Vector3 held_at(int vertex) const {
    const auto at = held.find(vertex);
    return at == held.end() ? Vector3(Vector3::Zero()) : at->second;
  }

  /// The point nearest to p that the conditions allow for an input vertex: where it is held, on its mirror,
  /// in the space.
  Vector3 feasible(int vertex, Vector3 p) const;

  /// Moves positions of input vertices (n x 3) to the nearest that the conditions allow: to where they are
  /// held, onto the mirrors, onto the space.
  void make_feasible(Points& positions) const;

  /// Positions of all cut vertices from those of the input vertices.
  Points spread(const Points& positions, const std::vector<int>& source_vertex) const;
};

/// The place of an isometry among distinct ones (to 1e-9), appended where it is new.
int index_among(std::vector<Isometry>& distinct, const Isometry& isometry);

/// Seams, cones and unknowns for a cut mesh whose boundary meets its marks as the tile's corners do. Vertices
/// that no face uses are held at the north pole.
BoundaryConditions glue(const CutMesh& cut, const Tile& tile, const Target& target);

}  // namespace orbitutte
