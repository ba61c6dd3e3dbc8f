// SPDX-License-Identifier: MIT
// GIfTI, "Geometry Format under the Neuroimaging Informatics Technology Initiative", version 1.0: an XML
// document of arrays. Surfaces are two of them, points and triangles; data of vertices are others.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "orbitutte/io/vertex_data.h"

namespace orbitutte {

/// Intents of arrays.
constexpr std::string_view gifti_points = "NIFTI_INTENT_POINTSET", gifti_triangles = "NIFTI_INTENT_TRIANGLE",
                           gifti_labels = "NIFTI_INTENT_LABEL", gifti_shape = "NIFTI_INTENT_SHAPE",
                           gifti_other = "NIFTI_INTENT_NONE";

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

struct GiftiFile {
  std::vector<GiftiArray> arrays;
  /// The table of labels.
  std::vector<ValueLabel> labels;
};

/// The arrays in the file's order: of any number type, byte order and index order, encoded as text, base64 or
/// compressed base64. Throws MeshError naming the line of XML that is no XML, or the array at fault; arrays
/// in external files are refused.
GiftiFile read_gifti_file(std::string_view bytes);

/// The text of a GIfTI file with these arrays, as compressed base64: triangles and labels as int32, which
/// they have to fit into, everything else in single precision.
std::string write_gifti_file(const GiftiFile& file);

}  // namespace orbitutte
