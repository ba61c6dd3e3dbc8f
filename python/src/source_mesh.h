// SPDX-License-Identifier: MIT
// The mesh that is embedded, as the caller gave it.
#pragma once

#include <mutex>
#include <string>
#include <variant>
#include <vector>

#include "orbitutte/mesh/connectivity.h"
#include "orbitutte/mesh/polygon_mesh.h"
#include "orbitutte/orbifold/embedding.h"

namespace orbitutte::python {

class SourceMesh {
 public:
  explicit SourceMesh(Mesh mesh) : input_(std::move(mesh)) {}

  /// Keeps triangles where that is all there is.
  explicit SourceMesh(PolygonMesh mesh);

  const std::variant<Mesh, PolygonMesh>& input() const { return input_; }
  const std::vector<std::string>& warnings() const { return warnings_; }  ///< of the file's reader
  const Points& positions() const;
  int face_count() const;
  PolygonMesh polygons() const;  ///< a copy

  /// The mesh in triangles: polygons are divided, for which they must be sound. Throws MeshError.
  const Mesh& triangles() const;

  /// Of the faces that were given. Throws MeshError.
  Connectivity connectivity() const;

  /// The embedding of this mesh, from a file, with its polygons divided as those of the mesh are. Throws
  /// MeshError naming the first face that is not the mesh's.
  Embedding belonging(Embedding embedding) const;

 private:
  std::vector<std::string> warnings_;
  std::variant<Mesh, PolygonMesh> input_;
  mutable std::once_flag divided_;
  mutable Mesh divided_mesh_;  // of polygons, once somebody asked for it
};

}  // namespace orbitutte::python
