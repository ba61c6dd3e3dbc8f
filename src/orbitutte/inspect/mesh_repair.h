// SPDX-License-Identifier: MIT
// Makes of a mesh with defects one that can be embedded, as far as that is possible without a guess about
// its shape. Non-manifold vertices and edges are cut apart as in A. Guéziec, G. Taubin, F. Lazarus, W. Horn,
// "Cutting and stitching: converting sets of polygons to manifold surfaces", 2001; holes are filled by the
// triangulation of least area (G. Barequet, M. Sharir, "Filling gaps in the boundary of a polyhedron", 1995).
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "orbitutte/mesh/polygon_mesh.h"
#include "orbitutte/names.h"

namespace orbitutte {

/// In the order in which they are done.
enum class RepairStep {
  /// Faces that name missing vertices, have positions that are not finite, or name a vertex twice.
  drop_bad_faces,
  /// Vertices at the same point, or within a tolerance, become one.
  weld,
  /// All but the first of faces with the same vertices.
  drop_duplicates,
  /// Triangles without area but rounding errors.
  drop_flat_faces,
  /// Faces that meet at a vertex or an edge, but do not form one fan there, are cut apart.
  split_non_manifold,
  /// Faces are turned so that neighbours agree, and closed surfaces so that they enclose a positive volume.
  orient,
  /// Only the component with the largest area is kept.
  keep_largest,
  /// Boundary curves are closed by triangles.
  fill_holes,
  /// Edges inside that join two vertices of the boundary get a vertex in their middle: what they cut off, an
  /// ear or more, need not become an arc.
  split_ears
};

/// Its names.
template <>
struct NameTable<RepairStep> {
  static constexpr NamedValue<RepairStep> rows[] = {{RepairStep::drop_bad_faces, "drop_bad_faces"},
                                                    {RepairStep::weld, "weld"},
                                                    {RepairStep::drop_duplicates, "drop_duplicates"},
                                                    {RepairStep::drop_flat_faces, "drop_flat_faces"},
                                                    {RepairStep::split_non_manifold, "split_non_manifold"},
                                                    {RepairStep::orient, "orient"},
                                                    {RepairStep::keep_largest, "keep_largest"},
                                                    {RepairStep::fill_holes, "fill_holes"},
                                                    {RepairStep::split_ears, "split_ears"}};
};

struct MeshRepairOptions {
  /// Those that are left out. Flat faces are kept by default: the certificate can live with them, and to drop
  /// them opens holes.
  std::vector<RepairStep> without = {RepairStep::drop_flat_faces};

  /// How far vertices that are welded may lie apart, in the mesh's unit; 0: at the same point.
  double weld_tolerance = 0;

  /// Boundary curves of at most so many edges are filled; if nothing is said, all but the longest.
  std::optional<int> largest_hole;
};

/// What a step did.
struct RepairRecord {
  RepairStep step;

  /// Of faces, vertices, components, curves or edges.
  long long count = 0;

  /// One sentence, "3 faces with the same vertices as an earlier one were dropped, the first face 17".
  std::string message;
};

struct RepairedMesh {
  PolygonMesh mesh;

  /// n: the vertex of the input that each vertex is or is a copy of; -1 for new ones.
  std::vector<int> source_vertex;

  /// The vertex that each of the input has become, of copies the first; -1 if it was dropped.
  std::vector<int> vertex_of;

  /// The steps that changed something, in order.
  std::vector<RepairRecord> records;
};

/// What a report says of a repair.
struct RepairSummary {
  std::vector<RepairRecord> records;

  /// For each added vertex, the vertex of the input that it is a copy of; -1 for new ones.
  std::vector<int> added;
};

/// A repaired mesh in which vertices keep their numbers.
struct RepairInPlace {
  /// The vertices of the input, in order, whether or not faces need them, and then the added ones.
  PolygonMesh mesh;

  /// What became of each vertex of the input: itself, the one that it was welded to, or -1 if it was dropped.
  std::vector<int> image;
  RepairSummary summary;
};

/// Order is kept: vertices and faces that stay are in the order of the input, copies and new ones follow.
/// Vertices that no face uses are dropped. What remains to be said of the result, `inspect` says. O(n log n),
/// and cubic in the edges of a hole of up to 200; larger ones are filled around a new vertex in their middle.
/// Throws ArgumentError if a tolerance is negative or not finite.
RepairedMesh repair_mesh(const PolygonMesh& mesh, const MeshRepairOptions& options = {});

/// The same repair. Vertices that no face needs lie where one that is needed does.
RepairInPlace repair_in_place(const PolygonMesh& mesh, const MeshRepairOptions& options = {});

}  // namespace orbitutte
