// SPDX-License-Identifier: MIT
// One reader and one writer per format of values at vertices. vertex_data.h says what they accept. To add a
// format, add its functions here and a row to the table in vertex_data.cpp.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "orbitutte/io/vertex_data.h"

namespace orbitutte {

// Throw MeshError naming array, line, vertex or byte.
VertexData read_curv(std::string_view bytes);
VertexData read_annot(std::string_view bytes);
VertexData read_gifti_data(std::string_view bytes);
VertexData read_text_data(std::string_view text);
VertexData read_npy(std::string_view bytes);

std::string write_curv(const VertexData& data);
std::string write_annot(const VertexData& data);
std::string write_shape_gifti(const VertexData& data);
std::string write_func_gifti(const VertexData& data);
std::string write_label_gifti(const VertexData& data);
std::string write_text_data(const VertexData& data);
std::string write_csv(const VertexData& data);
std::string write_npy(const VertexData& data);

/// The value as a label's key. Throws MeshError naming map and vertex if it is no whole number that an int
/// can hold.
int label_key(const VertexData& data, Eigen::Index vertex, Eigen::Index map);

/// Gives the maps their names, or none if all are empty.
void set_map_names(VertexData& data, std::vector<std::string> names);

}  // namespace orbitutte
