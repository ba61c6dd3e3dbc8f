// SPDX-License-Identifier: MIT
// The positions of a glued map while single vertices move: in doubles, or with more digits where it shrinks.
#pragma once

#include <memory>
#include <vector>

#include "orbitutte/cut/cut.h"
#include "orbitutte/geometry/precise.h"
#include "orbitutte/orbifold/seam_group.h"
#include "orbitutte/solve/boundary_conditions.h"
#include "orbitutte/solve/elements.h"

namespace orbitutte {

/// How the vertices of a map are glued, seen from one another.
struct Gluing {
  const CutMesh& cut;
  const BoundaryConditions& boundary;
  const Elements& elements;
};

/// The positions of the input vertices, in doubles. What is read are differences, which keep their digits
/// however near two vertices are to each other.
class MovablePositions {
 public:
  /// positions: n x 3. Both must outlive it.
  MovablePositions(Gluing gluing, Points& positions) : gluing_(gluing), positions_(positions) {}
  virtual ~MovablePositions() = default;
  MovablePositions(const MovablePositions&) = delete;
  MovablePositions& operator=(const MovablePositions&) = delete;

  /// elements[element] * p_u - p_v.
  virtual Vector3 difference(int v, int u, int element) const;

  /// The tangential part of the sum of factors[k] * (elements[e_k] * p_k - p_v) over the neighbours of v,
  /// with all digits that there are.
  virtual Vector3 pull(int v, const std::vector<Neighbour>& neighbours,
                       const std::vector<double>& factors) const;

  /// The same of the harmonic map: factors w d/sn d, with the weights and lengths of the edges; `error` of
  /// d/sn d is allowed.
  virtual Vector3 harmonic_pull(int v, const std::vector<Neighbour>& neighbours, double error) const;

  /// Until this has been called for the last of them, differences and pulls may be asked for by one thread
  /// only.
  virtual void prepare_elements(int) const {}

  /// p_v in doubles.
  Vector3 rounded(int v) const { return positions_.row(v); }

  /// Has the vertex more digits than doubles?
  virtual bool is_refined(int) const { return false; }

  /// Adds a step, and takes the vertex back to its room (onto its mirror) and to the space.
  virtual void move(int v, const Vector3& step);

  /// Puts v where elements[element] * p_u is, and adds a step, as a move does; with more digits, if there are
  /// any, so that v lies as near to u as the step says.
  virtual void put(int v, int u, int element, const Vector3& step);

  /// Adds a step, and nothing else.
  virtual void shift(int v, const Vector3& step);

  /// Is the face of the cut mesh positively oriented, exactly as its corners will be stored, and visibly so?
  virtual bool is_positive(int face) const;

  /// How many moves and shifts there were that have not been taken back.
  std::size_t moves() const { return journal_.size(); }

  /// Takes all but the first so many back.
  virtual void take_back(std::size_t moves);

 protected:
  const Gluing& gluing() const { return gluing_; }
  const Points& positions() const { return positions_; }
  void set_rounded(int v, const Vector3& p) { positions_.row(v) = p; }

  /// Notes where a vertex is before it moves.
  void remember(int v) { journal_.emplace_back(v, positions_.row(v)); }

 private:
  Gluing gluing_;
  Points& positions_;
  /// Where vertices were before their moves.
  std::vector<std::pair<int, Vector3>> journal_;
};

/// The same, with more digits for the vertices that are refined. The map must lie in the canonical frame of
/// its target, unless its tile is free.
template <typename Real>
class PrecisePositions final : public MovablePositions {
 public:
  /// Throws ArgumentError if what the vertices are glued by are no elements of the target's group.
  PrecisePositions(Gluing gluing, Points& positions, const Target& target);

  Vector3 difference(int v, int u, int element) const override;
  Vector3 pull(int v, const std::vector<Neighbour>& neighbours,
               const std::vector<double>& factors) const override;
  Vector3 harmonic_pull(int v, const std::vector<Neighbour>& neighbours, double error) const override;
  void prepare_elements(int last) const override { element(last); }
  bool is_refined(int v) const override { return slot_[v] >= 0; }
  void move(int v, const Vector3& step) override;
  void put(int v, int u, int element, const Vector3& step) override;
  void shift(int v, const Vector3& step) override;
  bool is_positive(int face) const override;
  void take_back(std::size_t moves) override;

  /// Gives a vertex more digits where it is: where it is held, on its mirror, in its space.
  void refine(int v);

  /// The same at a point near to where it is.
  void refine_to(int v, const Vector3Of<Real>& point);

  /// Positions of all cut vertices (n_cut x 3), those of refined ones rounded once, and the offsets of every
  /// copy of a refined vertex, down to a small part of its shortest edge. shortest_edge: n; infinite if
  /// doubles resolve that edge.
  Points spread(const std::vector<double>& shortest_edge, std::vector<Offset>& offsets) const;

 private:
  using Vector = Vector3Of<Real>;
  using Matrix = Matrix3Of<Real>;

  /// Where a refined vertex was before a move.
  struct Entry {
    std::size_t move;
    int vertex;
    Vector position;
  };

  Vector precise(int v) const;
  Vector3 tangential(const Vector& here, const Vector& sum) const;
  Vector feasible(int v, Vector p) const;
  Vector cut_position(int cut_vertex) const;
  const Matrix& element(int k) const;
  void remember_digits(int v);
  void store(int v, const Vector& p);

  PreciseGroup<Real> group_;
  /// n: an index into digits_, or -1.
  std::vector<int> slot_;
  std::vector<Vector> digits_;
  std::vector<Entry> journal_;
  mutable std::vector<Matrix> elements_;
  /// BoundaryConditions::transforms and mirrors.
  std::vector<Matrix> transforms_, mirrors_;
};

}  // namespace orbitutte
