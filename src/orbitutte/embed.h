// SPDX-License-Identifier: MIT
// From a surface and marked vertices to a certified orbifold Tutte embedding: the whole method on one page.
#pragma once

#include <memory>
#include <vector>

#include "orbitutte/embed_types.h"
#include "orbitutte/inspect/recognition.h"
#include "orbitutte/orbifold/signature.h"

namespace orbitutte {

/// Embeds a surface (make_surface) into an orbifold. `cones` are the marked vertices (0-based, in the order
/// of Target::marks), which come to lie at its cones and corners. Minimises the energy (2) over the gluings
/// of appendix A by algorithm 1, as corrected in docs/deviations.md, and judges the result. Not converging
/// and not being bijective are results, not errors: see minimum.termination and certificate.bijective, which
/// is true only for converged maps. Throws MeshError naming the vertex, edge or face; ArgumentError;
/// Cancelled; std::bad_alloc.
///
/// Polygons with more than three corners are embedded with their own edges only, and become convex.
/// Cotangents and distortion are those of their triangles (Embedding::triangles). Throws ArgumentError for
/// kinds of weights that polygons do not have (weight_kind).
EmbedResult embed(const Surface& surface, const Target& target, const std::vector<int>& cones,
                  const EmbedOptions& options = {});

/// The same for a mesh; also throws as make_surface does. The mesh is copied, which
/// make_surface(std::move(mesh)) avoids.
EmbedResult embed(const Mesh& mesh, const Target& target, const std::vector<int>& cones,
                  const EmbedOptions& options = {});
EmbedResult embed(const PolygonMesh& mesh, const Target& target, const std::vector<int>& cones,
                  const EmbedOptions& options = {});

/// The quotient of a map by its group, as QuotientOptions::is_wanted gives it: `map` is the embedding of the
/// surface onto NN, *NN, N*, 222 or *222. Throws ArgumentError for other targets, and as embed does.
EmbedResult quotient_of(const Surface& surface, const EmbedResult& map, const EmbedOptions& options = {});

/// For many embeddings of one surface: keeps what depends neither on the cones nor on their orders, and
/// those factors of the last embedding that fit the next one. The results are those of the functions above.
class EmbeddingSolver {
 public:
  /// Shares the surface. Throws ArgumentError for kinds of weights that the surface cannot have.
  explicit EmbeddingSolver(std::shared_ptr<const Surface> surface, EmbedOptions options = {});

  /// Keeps the surface, or the surface of the mesh. Also throws as make_surface does.
  explicit EmbeddingSolver(Surface surface, EmbedOptions options = {});
  explicit EmbeddingSolver(Mesh mesh, const EmbedOptions& options = {});
  explicit EmbeddingSolver(PolygonMesh mesh, const EmbedOptions& options = {});
  ~EmbeddingSolver();
  EmbeddingSolver(EmbeddingSolver&&) noexcept;

  /// As the functions above. A stage whose work is already done takes no time in the result's timings.
  EmbedResult embed(const Target& target, const std::vector<int>& cones);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// Cones at well separated extremities, one for each mark of the target; on a disk, inside or on the
/// boundary as the mark requires. Throws MeshError if the surface does not have the topology that the target
/// needs.
std::vector<int> choose_cones(const Surface& surface, const Target& target);

/// The same for a mesh; also throws as make_surface does.
std::vector<int> choose_cones(const Mesh& mesh, const Target& target);
std::vector<int> choose_cones(const PolygonMesh& mesh, const Target& target);

}  // namespace orbitutte
