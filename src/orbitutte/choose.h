// SPDX-License-Identifier: MIT
// The spherical orbifold and the cones that distort a surface least: one map to 222 or *222 gives the scale
// of the maps to all others (cones/scale_field.h), and the best of these are embedded.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "orbitutte/cones/cone_wishes.h"
#include "orbitutte/cones/objective.h"
#include "orbitutte/embed.h"

namespace orbitutte {

/// Stands for a vertex that is to be chosen.
inline constexpr int best_vertex = -1;

/// What is to be chosen, and by what.
struct ChooseOptions {
  Objective objective = Objective::sigma;

  /// If not given, it is chosen, too: any orbifold with marks and a finite group that the surface embeds
  /// into. Targets with more cones, or of other spaces, are for the caller to name: cone_wishes.h finds cones
  /// of fitted angles, which distort areas far less.
  std::optional<Target> target;

  /// The marked vertices, in the order of the symbol, best_vertex for those that are to be chosen. None: as
  /// many as the target needs, all of them chosen.
  std::vector<int> cones;

  EmbedOptions embed;
};

/// A row of the table: the best cones for one orbifold.
struct Choice {
  Target target;
  std::vector<int> cones;

  /// By the closed form; not known on projective planes and for the pillow 2222.
  std::optional<ScaleSummary> predicted;

  /// Of the embedding, and whether it is certified; not known of rows that were not embedded.
  std::optional<Distortion> solved;
  bool is_certified = false;

  /// Where the mesh cannot be embedded like that: why.
  std::string refusal;
};

/// The best choice for each spherical family that the options leave, the best first; one of them is embedded.
/// Rows that cannot become the best are not searched to the end.
struct BestEmbedding {
  Objective objective = Objective::sigma;
  std::vector<Choice> choices;

  /// The row that `result` is the embedding of: the first that is certified, and no worse than what the
  /// closed form says of the rows below it. If none is certified, the first that could be embedded.
  int taken = 0;
  EmbedResult result;

  const Choice& choice() const { return choices[taken]; }
};

/// Chooses and embeds. EmbedResult::warnings says if a better choice was not certified. Throws as embed does;
/// MeshError if no orbifold takes such cones.
BestEmbedding embed_best(const std::shared_ptr<const Surface>& surface, const ChooseOptions& options = {});

/// The vertices that the search begins with: the extremities that its first map marks, and then the farthest
/// from those before. Throws MeshError unless the surface is a sphere, a disk or a projective plane.
Candidates cone_candidates(const Surface& surface);

/// What is asked of cones of fitted angles, and the cones that find_cones finds for it.
struct FittedChoice {
  ConeWishes wishes;
  FittedCones cones;
};

/// Embeds into the target that fitted cones make; signature: `cones` or `*cones`. Where the map is not
/// certified, or with other weights than those that were wanted, or far from conformal though places are free
/// (E/2A above 1.1), cones of milder angles are sought, at other places as far as these are free: first of
/// at most 1.6 times the flat angle, then with small angles that spare their triangles whatever sigma
/// becomes, and, where none of that is certified, of at most 1.4, 1.2, 0.99 and 0.5 times the flat angle. The
/// first choice without such a fault is taken, or else the first with the least, and EmbedResult::warnings
/// says so. With `are_orders` nothing else is tried. Throws as embed does.
EmbedResult embed_fitted(const Surface& surface, const std::string& signature, const FittedChoice& choice,
                         const EmbedOptions& options = {});

/// The table, each symbol once, the first `solved` rows of it embedded. Where nothing is predicted, all are
/// embedded.
std::vector<Choice> choose(std::shared_ptr<const Surface> surface, const ChooseOptions& options = {},
                           int solved = 3);

}  // namespace orbitutte
