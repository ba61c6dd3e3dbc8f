// SPDX-License-Identifier: MIT
// Arguments that several commands share.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "orbitutte/io/mesh_io.h"
#include "orbitutte/io/vertex_data.h"
#include "orbitutte/orbifold/embedding.h"
#include "orbitutte/report/report.h"
#include "orbitutte/weights/weights.h"

namespace orbitutte::cli {

/// Vertices separated by commas; best_vertex for each entry that is 'best'. Throws ArgumentError.
std::vector<int> parse_cones(const std::string& text);

/// Angles separated by commas, radians, or multiples of pi as in 1.6pi. Throws ArgumentError.
std::vector<double> parse_angles(const std::string& text);

/// What --cones leaves to the program, in one word.
enum class ConesWord { best, extremities, none };

/// 'best', its older name 'auto' or nothing at all; 'extremities'; or vertices.
ConesWord cones_word(const std::string& text);

/// The surface's cones by --orbifold and --cones; the options of a choice if that leaves something to the
/// program.
struct Wish {
  /// None if it is to be chosen.
  std::optional<Target> target;
  ConesWord word = ConesWord::none;

  /// In the order of the symbol; none if `word` says it.
  std::vector<int> cones;

  bool is_choice() const;
};

/// Throws ArgumentError.
Wish parse_wish(const std::string& orbifold, const std::string& cones);

/// Marks extremities if they are asked for: as many as the target needs, or as standard_target
/// does.
void mark_extremities(const Surface& surface, Wish& wish);

/// The mesh at a path, or on standard input, in the format that --format names if it is not empty. Throws
/// ArgumentError.
MeshInput mesh_input(const std::string& path, const std::string& format);

/// Reads the mesh of an embedding, and repairs it if that was done before it was embedded. Throws FileError,
/// and MeshError naming the first defect.
Surface read_embedded(const MeshInput& input, const Report& report);

/// The same, and divides the embedding's faces into the same triangles. Does not check that the embedding is
/// one of the mesh; functions that take both do.
Surface read_source(const MeshInput& input, const Report& report, Embedding& embedding);

/// write_vertex_data, where what the format of a path cannot hold is a fault of the command line: throws
/// ArgumentError.
void write_as_asked(const std::string& path, const VertexData& data);

}  // namespace orbitutte::cli
