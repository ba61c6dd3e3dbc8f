// SPDX-License-Identifier: MIT
// What embed computes before it knows the tile, and keeps from one embedding of a mesh to the next.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "orbitutte/embed.h"
#include "orbitutte/inspect/recognition.h"

namespace orbitutte {

/// What embed is asked for.
struct EmbedRequest {
  const Mesh& mesh;
  const Orbifold& orbifold;
  const std::vector<int>& marked_vertices;
  const EmbedOptions& options;
};

/// What is known of a mesh before its cones are, and its last cut.
struct Preparation {
  std::optional<Triangulation> polygons;  ///< that the triangles make up; none where all faces are triangles
  std::vector<std::string> warnings;      ///< about the polygons
  std::optional<SoundSurface> surface;
  std::optional<EdgeWeights> weights;
  std::vector<int> kept_faces;  ///< with which these were computed
  /// The marked vertices of `cut`, and how many lie inside.
  std::optional<std::pair<std::vector<int>, int>> cut_through;
  CutMesh cut;
  std::shared_ptr<LaplacianReuse> laplacians = reusable_laplacians(Kept::order);
};

/// The triangles that stand for polygons; what is known of the polygons goes into `prepared`. Throws
/// MeshError, and ArgumentError where the options ask for weights that polygons do not have.
Mesh prepare(const PolygonMesh& mesh, const EmbedOptions& options, Preparation& prepared);

/// Throws MeshError if the mesh does not have the topology that the orbifold needs.
void require_topology(const Mesh& mesh, const SoundSurface& surface, const Orbifold& orbifold);

/// Recognises the surface; throws MeshError if it is not the one that the orbifold needs, or an edge joins
/// marked vertices that have to lie at opposite points.
void find_surface(const EmbedRequest& request, Preparation& prepared);

/// The weights (section 4), those of a metric that is flat at the cones.
EdgeWeights find_weights(const EmbedRequest& request, Preparation& prepared);

/// Cuts the mesh through its marked vertices (section 4.1), and finds the elimination order of its Laplacian
/// at the same time.
void find_cut(const EmbedRequest& request, const EdgeWeights& weights, Preparation& prepared);

/// Faces on vertices of the mesh or of its cut: the triangles, or the polygons that they make up.
class InputFaces {
 public:
  InputFaces(const Preparation& prepared, const Faces& triangles, const std::vector<char>& turned = {})
      : polygons_(prepared.polygons ? prepared.polygons->polygons(triangles, turned) : Polygons()),
        view_(prepared.polygons ? FaceView(polygons_) : FaceView(triangles)) {}
  InputFaces(const InputFaces&) = delete;
  InputFaces& operator=(const InputFaces&) = delete;

  const Polygons& polygons() const { return polygons_; }
  const FaceView& view() const { return view_; }

 private:
  Polygons polygons_;
  FaceView view_;
};

}  // namespace orbitutte
