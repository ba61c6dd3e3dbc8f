// SPDX-License-Identifier: MIT
// GIfTI, "Geometry Format under the Neuroimaging Informatics Technology Initiative", version 1.0: an XML
// document of arrays. Surfaces are two of them, points and triangles; data of vertices are others.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace orbitutte {

/// A DataArray.
struct GiftiArray {
  /// "NIFTI_INTENT_POINTSET", ...
  std::string intent;

  /// What its metadata call it; may be empty.
  std::string name;

  /// rows x columns numbers, row by row, whatever their order in the file. An array with one dimension has
  /// one column.
  int rows = 0, columns = 1;
  std::vector<double> values;

  /// Does the file state a transform other than the identity for these positions?
  bool has_transform = false;
};

/// A label of the file's table.
struct GiftiLabel {
  int key = 0;
  std::string text;
};

struct GiftiFile {
  std::vector<GiftiArray> arrays;
  std::vector<GiftiLabel> labels;
};

/// The arrays in the file's order: of any number type, byte order and index order, encoded as text, base64 or
/// compressed base64. Throws MeshError naming the line of XML that is no XML, or the array at fault; arrays
/// in external files are refused.
GiftiFile read_gifti_file(std::string_view bytes);

}  // namespace orbitutte
