// SPDX-License-Identifier: MIT
// Cutting a sphere, disk or projective plane along edge paths through the marked vertices (section 4.1).
#pragma once

#include <vector>

#include "orbitutte/cut/paths.h"
#include "orbitutte/mesh/surface.h"
#include "orbitutte/options.h"

namespace orbitutte {

/// A part of the boundary of a cut mesh, from a corner to the next. Corners are the marked vertices, the
/// vertices where the cut branches, and where it meets the boundary of the surface.
struct CutSide {
  /// Where it begins: an index into CutMesh::boundary.
  int begin = 0;
  /// The side on the other bank of the cut, which runs the other way; the side itself on the boundary of the
  /// surface.
  int partner = 0;
};

/// A mesh cut open into a disk. Cut vertices 0 .. n - 1 are the input vertices; the copies that the cut adds
/// follow.
struct CutMesh {
  /// m x 3: the input triangles in their order, on cut vertices. If the input has no orientation, some are
  /// turned over: f(0), f(2), f(1).
  Triangles F;
  /// m: is the triangle turned over? Empty if none is.
  std::vector<char> turned;
  /// n_cut: the input vertex of every cut vertex.
  std::vector<int> source_vertex;
  /// Cut vertices along the boundary's half-edges: counterclockwise, with the interior on the left.
  std::vector<int> boundary;
  /// Input vertices: the given marks, then the vertex where the cut of a disk ends.
  std::vector<int> marks;
  /// Indices into marks, in the order in which the boundary first meets them, beginning with mark 0.
  std::vector<int> arrangement;
  /// The parts of the boundary, if the cut is a tree: the first begins at boundary[0]. Otherwise none, and
  /// sides begin at marks alone.
  std::vector<CutSide> sides = {};

  int vertex_count() const { return static_cast<int>(source_vertex.size()); }

  /// The half-edge of the uncut mesh along a half-edge of F, in its direction unless the face is turned over.
  int source_halfedge(int h) const {
    return turned.empty() || turned[h / 3] == 0 ? h : h - h % 3 + (2 - h % 3);
  }
};

/// Cuts the surface so that every marked vertex lies on the boundary of a disk. The first `inner_marks` marks
/// lie inside the surface, the others on its boundary.
///
/// A sphere with two marks is cut along the shortest edge path between them; with three marks, along two
/// disjoint paths from one of them to the other two. A disk whose marks are on its boundary is left as it is.
/// A disk with a mark inside is cut along the shortest edge path from it to an unmarked vertex of the
/// boundary; the path meets the boundary only at its end. A projective plane with one mark is cut along a
/// one-sided loop through the mark, and its faces are turned so that those of the disk agree (see
/// one_sided_loop). Without marks, a sphere stays closed, and a disk is left as it is: its boundary begins at
/// its first vertex in more than one face, which takes the place of the end of a cut.
///
/// Throws MeshError if a mark is not a vertex of a face, is given twice or lies in the wrong place, if there
/// are too few or too many marks, or if a boundary meets its marks in another order than the given one, in
/// whichever direction.
CutMesh cut_to_disk(const Surface& surface, const std::vector<int>& marks, int inner_marks,
                    const CutOptions& options = {});

/// The same along a tree of edges, for any number of marks: no path can block another. Each mark in turn is
/// the nearest to the tree that was left, and is joined to it by a shortest path (H. Takahashi, A. Matsuyama,
/// "An approximate solution for the Steiner problem in graphs", Math. Japonica 24 (1980)). On a sphere the
/// tree begins at the first mark. On a disk the boundary belongs to it: then the boundary of the cut mesh
/// begins at the first mark on the boundary of the surface, or, if there is none, where the cut meets it.
CutMesh cut_along_tree(const Surface& surface, const std::vector<int>& marks, int inner_marks,
                       const CutOptions& options = {});

/// The same along a tour: from the first mark on the boundary, if there is one, through the marks inside in
/// their order, each joined to the one before by the shortest path that meets none of the others. Two
/// surfaces that are cut along a tour through corresponding marks have the same sides. If no mark of a disk
/// is on the boundary, the tour begins where the boundary is nearest to the first. Throws MeshError if the
/// tour shuts itself off.
CutMesh cut_along_tour(const Surface& surface, const std::vector<int>& marks, int inner_marks,
                       const CutOptions& options = {});

/// The edges with their lengths in space. Every length is increased by a tiny one, so that paths have few
/// edges even if edges have length zero. Paths may pass through any vertex: no vertex is a dead end.
EdgeGraph edge_length_graph(const Surface& surface);

}  // namespace orbitutte
