// SPDX-License-Identifier: MIT
// The files of a map between two surfaces: images of vertices, the common refinement on both, a morph.
#pragma once

#include <string>

#include "orbitutte/map/overlay.h"
#include "orbitutte/map/vertex_map.h"

namespace orbitutte {

/// Writes `a_to_b.txt` or the like: a line `face w0 w1 w2` for every vertex. The file appears whole or not at
/// all. Throws FileError.
void write_vertex_map(const std::string& path, const VertexMap& map);

/// The overlay as a mesh: its faces on positions in space (positions_on), one row for each of its vertices.
/// Written once with the positions on A and once with those on B, both files have the same faces.
/// The path's ending names the format, as write_mesh has it. Throws FileError and ArgumentError.
void write_overlay(const std::string& path, const Overlay& overlay, const Points& positions);

/// A surface that turns into another: triangles with positions in the beginning and in the end (n x 3 each).
struct Morph {
  Triangles triangles;
  Points from, to;
};

/// Of the overlay, from A to B: positions as positions_on has them.
Morph morph_of(const Overlay& overlay, const Points& on_a, const Points& on_b);

/// The positions in between, linear in t: `from` for t = 0, `to` for t = 1.
Points morph_positions(const Morph& morph, double t);

/// A GLB whose mesh has `to` as its morph target, and an animation that goes there and back within some
/// seconds. Throws FileError, and ArgumentError if the mesh is too large for the format.
void write_morph(const std::string& path, const Morph& morph);

}  // namespace orbitutte
