// SPDX-License-Identifier: MIT
// From a mesh and marked vertices to a certified spherical orbifold Tutte embedding: the whole method on one
// page.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "orbitutte/cut/cut.h"
#include "orbitutte/orbifold/embedding.h"
#include "orbitutte/orbifold/signature.h"
#include "orbitutte/progress.h"
#include "orbitutte/solve/boundary_arcs.h"
#include "orbitutte/solve/lbfgs.h"
#include "orbitutte/verify/certificate.h"
#include "orbitutte/verify/distortion.h"
#include "orbitutte/weights/weights.h"

namespace orbitutte {

/// How to embed.
struct EmbedOptions {
  WeightOptions weights;
  std::string weights_file;            ///< lines `i j w` (read_weights); when not empty, instead of `weights`
  CutOptions cut;                      ///< which of all cuts; it changes no length (N* turns about its axis)
  LaplacianOptions laplacian;          ///< the linear solver
  Spread spread = Spread::arc_length;  ///< of boundary vertices along the sides of a fixed polygon
  double tolerance = 1e-9;             ///< LbfgsOptions::tolerance
  int max_iterations = 2000;
  int threads = 0;  ///< 0: as many as the machine has; results do not depend on it
  ProgressCallback progress;
};

/// The embedding, and all that is known of it.
struct EmbedResult {
  Embedding embedding;
  EdgeWeights weights;
  Minimum minimum;          ///< how the optimiser fared; its positions are those of the input vertices
  Certificate certificate;  ///< of the input's triangles
  /// Of the triangulation that has the weights, where it is not the input's and that is not bijective.
  std::optional<Certificate> intrinsic_certificate;
  Distortion distortion;
  Topology topology = Topology::sphere;
  int unreferenced_vertices = 0;
  int zero_area_faces = 0;
  Backend backend = Backend::eigen;
  int threads = 1;
  Timings timings;
  std::vector<std::string> warnings;  ///< one sentence each
};

/// Embeds a mesh into an orbifold, its marked vertices (0-based, in the order of Target::marks) at the
/// cones and corners. Minimises the energy (2) over the gluings of appendix A by algorithm 1, as corrected in
/// docs/deviations.md, and judges the result. Not converging and not being bijective are results, not errors:
/// see minimum.termination and certificate.bijective, which is true only for converged maps. Throws MeshError
/// naming the defect and the vertex, edge or face; ArgumentError; Cancelled; std::bad_alloc.
EmbedResult embed(const Mesh& mesh, const Target& orbifold, const std::vector<int>& marked_vertices,
                  const EmbedOptions& options = {});

/// The same for a mesh with faces of any number of corners, embedded with the edges of its faces and none
/// else: the polygons become convex. Cotangents are those of triangulate(mesh), whose triangles are also the
/// faces of the result beside its polygons, and the distortion is theirs. Throws ArgumentError for other
/// weights than cotangents, uniform ones and a file.
EmbedResult embed(const PolygonMesh& mesh, const Target& orbifold, const std::vector<int>& marked_vertices,
                  const EmbedOptions& options = {});

/// For many embeddings of one mesh: keeps what depends neither on the cones nor on their orders, and those
/// factors of the last embedding that fit the next. Results are those of the function above.
class EmbeddingSolver {
 public:
  /// Keeps a copy of the mesh.
  explicit EmbeddingSolver(Mesh mesh, EmbedOptions options = {});

  /// Keeps what it needs of the mesh, which it validates at once. Throws as embed does.
  explicit EmbeddingSolver(const PolygonMesh& mesh, EmbedOptions options = {});
  ~EmbeddingSolver();
  EmbeddingSolver(EmbeddingSolver&&) noexcept;

  /// As the function above. Stages that find their work done take no time in the result's timings.
  EmbedResult embed(const Target& orbifold, const std::vector<int>& marked_vertices);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// Well separated extremities for the marks of the orbifold, inside a disk or on its boundary as each has to
/// be. Throws MeshError where the mesh is not what the orbifold needs.
std::vector<int> choose_marked_vertices(const Mesh& mesh, const Target& orbifold);
std::vector<int> choose_marked_vertices(const PolygonMesh& mesh, const Target& orbifold);

}  // namespace orbitutte
