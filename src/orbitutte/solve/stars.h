// SPDX-License-Identifier: MIT
// The triangles around a vertex of a glued map.
#pragma once

#include <map>
#include <set>
#include <utility>
#include <vector>

#include "orbitutte/cut/cut.h"
#include "orbitutte/solve/boundary_conditions.h"
#include "orbitutte/solve/ears.h"
#include "orbitutte/solve/elements.h"

namespace orbitutte {

/// A triangle seen from one of its vertices v: v, a, b counterclockwise, with a at elements[element_a] * p_a
/// and b likewise.
struct StarTriangle {
  int face = -1;
  int a = -1, b = -1;
  int element_a = 0, element_b = 0;
};

/// The star of every input vertex, across all seams, without the faces that become arcs.
class Stars {
 public:
  /// Puts the elements that it needs into `elements`. Cut mesh and boundary conditions must outlive it.
  Stars(const CutMesh& cut, const BoundaryConditions& boundary, const std::vector<Ear>& ears,
        Elements& elements);

  std::vector<StarTriangle> around(int vertex) const;

  /// The vertices, and those around them.
  std::set<int> with_neighbours(const std::set<int>& vertices) const;

  /// Does the triangle become an arc?
  bool leaves_out(int triangle) const { return is_flat_[triangle] != 0; }

 private:
  int element_between(int from, int to) const;

  const CutMesh& cut_;
  const BoundaryConditions& boundary_;
  /// Those that are left out.
  std::vector<char> is_flat_;
  /// Those that begin at copies of vertex v.
  std::vector<int> start_, halfedges_;
  /// By BoundaryConditions::transform_of of both ends.
  std::map<std::pair<int, int>, int> element_of_;
};

}  // namespace orbitutte
