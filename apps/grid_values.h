// SPDX-License-Identifier: MIT
// Files of values at the vertices of a surface and at the points of a grid.
#pragma once

#include <string>

#include "orbitutte/io/vertex_data.h"
#include "orbitutte/resample/grid.h"
#include "orbitutte/resample/sparse_table.h"

namespace orbitutte::cli {

struct GridValues : VertexData {
  /// Are they labels: by their table, or since the file has whole numbers?
  bool is_label = false;
};

/// Values at so many vertices: `values` of an .npz, or any format of values at vertices. Throws FileError,
/// MeshError and ArgumentError; the latter if there are not as many.
GridValues read_surface_values(const std::string& path, int vertices);

/// Values at the points of a grid: an .npy or .npz whose array has the grid's shape, or one value for each
/// point, and further numbers of each behind; a PNG of the image's size, 0 .. 1; or a format of values at
/// vertices.
GridValues read_grid_values(const std::string& path, const Grid& grid);

/// What is written.
struct ResampledOutput {
  const Grid& grid;

  /// Empty where values are no product with a table.
  const SparseTable& table;

  /// Of conservative tables.
  const Eigen::VectorXd& cell_areas;

  /// None if only the table is wanted.
  const GridValues& values;

  /// The margin of images.
  int margin = 0;
};

/// .npz: the table (indptr, indices, weights), the grid (points, areas, triangles, surface_areas) and values;
/// .npy in the grid's shape; .png of images; or a format of values at vertices.
void write_grid_values(const std::string& path, const ResampledOutput& output);

/// .npz: the table and values; or a format of values at vertices.
void write_surface_values(const std::string& path, const ResampledOutput& output);

}  // namespace orbitutte::cli
