// SPDX-License-Identifier: MIT
// Values at the vertices of a surface, and their files: thickness, curvature, activity, labels of regions ...
#pragma once

#include <Eigen/Core>
#include <array>
#include <string>
#include <string_view>
#include <vector>

namespace orbitutte {

/// What a value stands for where values are labels.
struct ValueLabel {
  int key = 0;
  std::string name;

  /// Red, green, blue and alpha (opacity), 0 .. 1.
  std::array<double, 4> colour = {0, 0, 0, 1};
};

/// Some maps of a surface, each with a value at every vertex.
struct VertexData {
  /// Vertices x maps.
  Eigen::MatrixXd values;

  /// The name of each map; or none at all.
  std::vector<std::string> names;

  /// If the values are labels: the table of their keys. A value that is not in it, such as -1 from an .annot
  /// file, is of no label. Empty if the values are measures.
  std::vector<ValueLabel> labels;

  /// Are the values whole numbers by the type that the file has? Only an .npy tells, and is written so again.
  bool is_whole = false;
};

enum class VertexDataFormat { curv, annot, shape_gifti, func_gifti, label_gifti, text, csv, npy };

/// The format that a path's ending names (any case), or the one before `.gz`: FreeSurfer's .curv, .thickness,
/// .sulc, .area, .volume, .avg_curv and .jacobian_white; .annot; .shape.gii, .func.gii, .label.gii, and .gii
/// alone, which is written as .shape.gii; .txt, .csv, .npy. Throws ArgumentError naming the endings known.
VertexDataFormat vertex_data_format(const std::string& path);

/// The ending that names the format, in lower case: ".shape.gii" of "lh.SHAPE.gii.gz". Throws ArgumentError
/// as vertex_data_format does.
std::string vertex_data_ending(const std::string& path);

/// Does the path's ending name such a format?
bool is_vertex_data_path(const std::string& path);

/// The values in the text or bytes of a file.
///
/// - curv: FreeSurfer's files of one single-precision number a vertex, and older ones of hundredths.
/// - annot: FreeSurfer's annotations with a colour table of version 2. Values are the table's indices; -1
///   where the table has no such colour.
/// - gifti: every array but points and triangles, of any number type, byte order, index order and encoding
///   but external files; each column is a map. The file's table is taken if the arrays are labels.
/// - text, csv: a line of numbers for each vertex, separated by blanks or commas. Empty lines and what
///   follows a `#` are ignored. A first line that does not begin with a number names the maps.
/// - npy: NumPy's arrays of one or two dimensions, of whole and floating numbers of any size from 4 bytes
/// (whole
///   ones: 1 byte), both byte orders and both index orders.
///
/// Throws MeshError naming array, line, vertex or byte if the data are empty, cut short or make no sense.
VertexData parse_vertex_data(std::string_view bytes, VertexDataFormat format);

/// The text or bytes of a file. GIfTI and FreeSurfer keep single precision, .label.gii and .annot whole
/// numbers; text, csv and npy are exact. Labels, and values that are whole by their type, are whole numbers
/// in an npy, too. Tables of labels are kept by .label.gii and .annot, names by GIfTI and csv. Throws
/// MeshError naming map, vertex or label if the format cannot hold the data: .curv and .annot have one map,
/// and .annot tells labels by their colours alone.
std::string serialize_vertex_data(const VertexData& data, VertexDataFormat format);

/// Reads a file in the format that the path's ending names; one that ends in `.gz` is decompressed first.
/// Error messages begin with the path. Throws FileError, ArgumentError and MeshError.
VertexData read_vertex_data(const std::string& path);

/// Writes a file in the format that the path's ending names, compressed if that is followed by `.gz`. The
/// file appears whole or not at all. Throws FileError, ArgumentError and MeshError.
void write_vertex_data(const std::string& path, const VertexData& data);

}  // namespace orbitutte
