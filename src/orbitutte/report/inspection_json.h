// SPDX-License-Identifier: MIT
// What `orbitutte info --json` and `orbitutte types --json` print.
#pragma once

#include <string>
#include <vector>

#include "orbitutte/inspect/inspection.h"
#include "orbitutte/inspect/weak_places.h"

namespace orbitutte {

/// The families that a mesh can be embedded into ("532", "22N", ...): those of its topology.
std::vector<std::string> families_for(const Inspection& inspection);

/// The places where a mesh is not 3-connected; none if the mesh has defects, since they are not looked for
/// then.
std::vector<WeakPlace> weak_places_if_sound(const PolygonMesh& mesh, const Inspection& inspection);

/// Topology, quality, defects and weak places of a mesh, and what it embeds into, as JSON
/// (docs/file-formats.md). `path`: the file that the mesh was read from.
std::string inspection_json(const std::string& path, const PolygonMesh& mesh, const Inspection& inspection,
                            const std::vector<WeakPlace>& places);

/// All families, as JSON: a list of objects with `family`, `group_order`, `input` and `marked_vertices` (also
/// under its older name, `marked_points`).
std::string families_json();

}  // namespace orbitutte
