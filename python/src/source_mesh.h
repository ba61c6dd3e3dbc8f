// SPDX-License-Identifier: MIT
// The mesh that is embedded, as the caller gave it.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "orbitutte/inspect/mesh_repair.h"
#include "orbitutte/mesh/polygon_mesh.h"
#include "orbitutte/mesh/surface.h"
#include "orbitutte/orbifold/embedding.h"

namespace orbitutte::python {

/// A mesh that may or may not be a surface. It never changes, so Python's arrays may refer to its memory.
class SourceMesh {
 public:
  explicit SourceMesh(Mesh mesh);
  explicit SourceMesh(PolygonMesh mesh);

  /// The mesh repaired, vertices keeping their numbers, and what became of each (RepairInPlace::image).
  std::pair<std::shared_ptr<SourceMesh>, std::vector<int>> repaired() const;

  /// What was done, if this is a mesh that was repaired.
  const std::optional<RepairSummary>& repair() const { return repair_; }

  /// What the reader of the file ignored.
  const std::vector<std::string>& warnings() const { return warnings_; }

  /// The vertices and faces as they were given. Either F or both corners and start are null.
  struct Arrays {
    const Points* V = nullptr;
    const Triangles* F = nullptr;
    const std::vector<int>* corners = nullptr;
    const std::vector<int>* start = nullptr;

    FaceView faces() const { return F ? FaceView(*F) : FaceView(*corners, *start); }
  };
  Arrays arrays() const;

  /// A copy.
  PolygonMesh polygons() const;

  /// Throws MeshError with the first defect.
  std::shared_ptr<const Surface> surface() const;

  /// An embedding of this mesh that was read from a file, with its polygons divided like those of the mesh.
  /// Throws MeshError naming the first face that is not the mesh's.
  Embedding belonging(Embedding embedding) const;

 private:
  using SharedSurface = std::shared_ptr<const Surface>;
  using Input = std::variant<SharedSurface, Mesh, PolygonMesh>;

  template <typename AnyMesh>
  static Input judged(AnyMesh mesh);
  static Input judged_triangles_or_polygons(PolygonMesh mesh);

  std::vector<std::string> warnings_;
  std::optional<RepairSummary> repair_;
  Input input_;
};

}  // namespace orbitutte::python
