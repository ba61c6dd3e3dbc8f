// SPDX-License-Identifier: MIT
// The search for the vertices at which a target's marks distort least, by the closed form of the scale.
#pragma once

#include <functional>
#include <vector>

#include "orbitutte/cones/objective.h"
#include "orbitutte/cones/scale_field.h"

namespace orbitutte {

/// The lower, the better.
struct Score {
  /// Do doubles not resolve the smallest triangles? What they resolve comes first.
  bool is_lost = false;
  double value = 0;

  bool operator<(const Score& other) const {
    return is_lost != other.is_lost ? other.is_lost : value < other.value;
  }

  /// By more than one part in a thousand?
  bool is_clearly_below(const Score& other) const { return Score{is_lost, value / 0.999} < other; }
};

Score score_of(const ScaleSummary& summary, Objective objective);

/// The vertices that faces use.
Candidates all_places(const Surface& surface);

/// Of each kind about `count`, the given ones first: each next one is the farthest in space from those before
/// (T. F. Gonzalez, 1985).
Candidates spread_candidates(const Surface& surface, const Candidates& first, int count);

/// What the search may change.
struct Freedom {
  /// Vertices that stay marked.
  std::vector<int> kept;

  /// May a kept vertex get the order of another mark?
  bool orders_move = false;
};

/// The vertices at one, two, four ... 32 edges from a vertex: a ring each, ascending.
std::vector<std::vector<int>> doubling_rings(const Neighbors& neighbors, int vertex);

/// Coordinate descent over the vertices of the marks.
class ConeSearch {
 public:
  /// Refers to the field, the surface and its neighbours.
  ConeSearch(ScaleField& field, const Surface& surface, const Neighbors& neighbors, Objective objective);

  /// Before a vertex is tried, sigma by another field, of fewer samples, is looked at: nothing is tried that
  /// makes it larger by more than this share. Refers to the field. For Objective::sigma alone.
  void look_first_at(ScaleField& field, double margin) { first_look_ = {&field, margin, 0}; }

  Score score(const MarkedTarget& choice);

  /// Replaces one vertex at a time by the best of the candidates, and exchanges the vertices of two marks, as
  /// long as that helps.
  Score descend(MarkedTarget& choice, const Candidates& candidates, const Freedom& freedom);

  /// Moves one vertex at a time by one, two, four ... 32 rings of neighbours, as long as that helps.
  Score polish(MarkedTarget& choice, const Freedom& freedom);

  /// May these vertices carry the marks? All differ, and no edge joins two that come to lie at opposite
  /// points.
  bool is_possible(const MarkedTarget& choice) const;

 private:
  struct FirstLook {
    ScaleField* field = nullptr;
    double margin = 0;

    /// sigma of the best choice so far, by the field.
    double sigma = 0;
  };

  /// Takes note of the best choice so far.
  void look_at_best(const MarkedTarget& choice);
  bool is_promising(const MarkedTarget& choice, const Score& best) const;

  /// Takes the vertex for the mark if the score becomes lower.
  bool try_vertex(MarkedTarget& choice, int mark, int vertex, Score& best);
  bool try_exchanges(MarkedTarget& choice, const Freedom& freedom, Score& best);
  bool try_candidates(MarkedTarget& choice, int mark, const std::vector<int>& candidates, Score& best);

  /// The vertices at one, two, four ... 32 rings from one, up to eight of each, that may carry its mark.
  std::vector<int> rings_around(int vertex) const;

  ScaleField& field_;
  const Neighbors& neighbors_;
  Objective objective_;
  FirstLook first_look_;
  std::vector<char> is_outer_;
};

}  // namespace orbitutte
