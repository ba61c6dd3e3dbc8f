// SPDX-License-Identifier: MIT
// The map from one surface to another as other programs want it: images of vertices and of any points, and
// what they carry over.
#pragma once

#include <string>
#include <vector>

#include "orbitutte/map/overlay.h"
#include "orbitutte/map/point_map.h"
#include "orbitutte/orbifold/embedding.h"

namespace orbitutte {

/// The images of vertices of one surface on another. A row for every input vertex; -1 and NaN if no face uses
/// the vertex.
struct VertexMap {
  /// Triangles of the other surface (rows of Embedding::triangles, which are its faces if these are
  /// triangles) and three barycentric coordinates, not negative, with the sum 1. SurfacePoints::copy is
  /// empty.
  SurfacePoints images;

  /// Input vertices of the other surface at the corners of that triangle (k x 3); -1 for none.
  Triangles corners;

  int count() const { return images.count(); }
};

/// Where the vertices of `from` lie on `to`, exactly as the overlay has them: a vertex on an edge or on a
/// vertex has coordinates that are 0. Marked vertices have the marked vertices of the same row of
/// Embedding::cones as images, with the coordinate 1. The embeddings are as `overlay` wants them, and it
/// throws as that does. O(1) steps a vertex.
VertexMap images_of_vertices(const Embedding& from, const Embedding& to);

/// The same of the vertices of A on B, and of those of B on A, as an overlay of both has them. Nothing is
/// walked again.
struct VertexMaps {
  VertexMap a_to_b, b_to_a;
};
VertexMaps vertex_maps(const Overlay& overlay, const Embedding& a, const Embedding& b);

/// Where any points of `from` lie on `to`. points.copy must be empty. Throws as images_of_vertices and
/// map_points do. Points of mirrors stay on them, up to the rounding of their coordinates.
SurfacePoints images_of_points(const Embedding& from, const Embedding& to, const SurfacePoints& points);

/// The image of a polyline: of the geodesic pieces between points that follow each other, with all edges of
/// `to` that they cross. Two points that follow each other must lie in one triangle of `from`, its boundary
/// included. Throws as images_of_points does, and ArgumentError naming the first point that does not.
SurfacePoints image_of_polyline(const Embedding& from, const Embedding& to, const SurfacePoints& points);

/// An entry of a sparse matrix.
struct MatrixEntry {
  int row = 0;
  int column = 0;
  double value = 0;
};

/// The matrix that takes values at the vertices of the other surface (columns) to values at the vertices of
/// this one (rows): the weights of the map, ascending by row and column, without zeros. Rows sum to one; that
/// of a vertex without image is empty.
std::vector<MatrixEntry> transfer_matrix(const VertexMap& map);

/// Values (n x c, a row for every vertex of the other surface) at the images of vertices, linear on every
/// triangle. NaN for a vertex without image. Throws ArgumentError if a vertex of the map has no row.
Eigen::MatrixXd transfer(const VertexMap& map, const Eigen::MatrixXd& values);

/// The label of the corner with the largest weight, the first of these; -1 for a vertex without image.
std::vector<int> transfer_labels(const VertexMap& map, const std::vector<int>& labels);

/// The points as lines `face w0 w1 w2`, with all digits; `-1 nan nan nan` for none.
std::string point_lines(const SurfacePoints& points);

}  // namespace orbitutte
