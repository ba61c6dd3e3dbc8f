// SPDX-License-Identifier: MIT
// One reader and one writer per mesh format. mesh_io.h says what they accept. To add a format, add its
// functions here and a row to the table in mesh_io.cpp.
#pragma once

#include <string>
#include <string_view>

#include "orbitutte/mesh/polygon_mesh.h"

namespace orbitutte {

// Throw MeshError naming the line, element or byte at fault.
PolygonMesh read_obj(std::string_view text);
PolygonMesh read_off(std::string_view text);
PolygonMesh read_ply(std::string_view bytes);
PolygonMesh read_stl(std::string_view bytes);
PolygonMesh read_gifti(std::string_view bytes);
PolygonMesh read_freesurfer(std::string_view bytes);
PolygonMesh read_vtk(std::string_view bytes);
PolygonMesh read_vtp(std::string_view bytes);
PolygonMesh read_gltf(std::string_view bytes);

std::string write_obj(const Mesh& mesh);
std::string write_off(const Mesh& mesh);
std::string write_ply(const Mesh& mesh);
/// Throws MeshError if a face names a vertex that does not exist.
std::string write_stl(const Mesh& mesh);
std::string write_gifti(const Mesh& mesh);
std::string write_freesurfer(const Mesh& mesh);
std::string write_vtk(const Mesh& mesh);
std::string write_vtp(const Mesh& mesh);
/// Both throw MeshError if the mesh is empty or a position is not finite.
std::string write_gltf(const Mesh& mesh);
std::string write_glb(const Mesh& mesh);

// The same of meshes some of whose faces have more than three corners, where the format has such faces.
std::string write_obj_polygons(const PolygonMesh& mesh);
std::string write_off_polygons(const PolygonMesh& mesh);
std::string write_ply_polygons(const PolygonMesh& mesh);
std::string write_vtk_polygons(const PolygonMesh& mesh);
std::string write_vtp_polygons(const PolygonMesh& mesh);

/// An empty text with room for a line of each vertex and face. Room that is not needed is never touched, so
/// it takes no memory.
std::string room_for_text(const Mesh& mesh);

/// The count as an int. Throws MeshError naming the things if it does not fit.
int checked_count(std::size_t count, std::string_view things);

/// Ends the face whose corners have been appended. Throws MeshError if an int cannot count the corners.
void end_face(PolygonMesh& mesh);

/// The points of the coordinates x y z x y z ... Throws MeshError if an int cannot count them.
Points to_points(const std::vector<double>& coordinates);

}  // namespace orbitutte
