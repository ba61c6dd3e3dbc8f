// SPDX-License-Identifier: MIT
// W. P. Thurston, "Shapes of polyhedra and triangulations of the sphere", Geometry and Topology Monographs 1
// (1998): the area as a Hermitian form on the shapes of cone surfaces.
#include "orbitutte/solve/conformal_map.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <complex>
#include <utility>

#include "orbitutte/orbifold/cone_target.h"
#include "orbitutte/orbifold/free_tile.h"
#include "orbitutte/orbifold/polygon.h"
#include "orbitutte/parallel.h"

namespace orbitutte {

// Members of ConformalShapes::State have types that are not this file's own.

// The harmonic map onto the tile of one shape.
struct ShapeMap {
  BoundaryConditions boundary;
  GluedEdges glued;
  Points positions;
};

// The forms on the maps of a basis of shapes.
template <typename Matrix>
struct Forms {
  Matrix area, energy;

  // Of the energy around great cones; only if there are such.
  Matrix energy_at_great_cones;
};

namespace {

using PlaneNumber = std::complex<double>;
using HermitianForm = Eigen::MatrixXcd;

PlaneNumber in_plane(const Vector3& p) { return {p.x(), p.y()}; }

double largest_entry_of(const Points& vectors) {
  return parallel_max(static_cast<int>(vectors.rows()),
                      [&](int v) { return vectors.row(v).cwiseAbs().maxCoeff(); });
}

// Newton's method for a quadratic energy. The factor is in single precision: each step gains some six digits.
void make_harmonic(const DirichletEnergy& energy, const LaplacianSolver& laplacian, Points& positions) {
  constexpr int most_steps = 5;
  constexpr double tolerance = 1e-11;
  double first = 0;
  for (int step = 0; step < most_steps; ++step) {
    const Points gradient = energy.evaluate(positions).gradient;
    const double largest = largest_entry_of(gradient);
    if (step == 0) first = largest;
    if (largest <= tolerance * first) return;
    Points step_down = laplacian.precondition(gradient);
    energy.make_feasible(step_down);  // but for single precision, it is
    positions -= step_down;
  }
}

ShapeMap map_of_shape(const GluingProblem& problem, const LaplacianSolver& laplacian,
                      const Eigen::VectorXcd& shape) {
  ShapeMap map;
  map.positions = positions_of_marks(problem.cut, shape);
  const Tile tile = tile_through(problem.target, problem.cut, map.positions);
  map.boundary = glue(problem.cut, tile, problem.target);
  map.glued = glued_along(problem, map.boundary);
  map.boundary.make_feasible(map.positions);
  make_harmonic(DirichletEnergy(map.glued, problem.weights, map.boundary), laplacian, map.positions);
  return map;
}

// p_i - g p_j along an edge.
PlaneNumber difference_along(const ShapeMap& map, int edge) {
  const auto [i, j, t] = map.glued.edges[edge];
  const Vector3 p = map.positions.row(i), q = map.positions.row(j);
  return in_plane(p - (t == 0 ? q : map.glued.transforms[t] * q));
}

// The sum of w conj(d_j) d_k over the edges, d_j the difference along the edge in map j. The same bits
// whatever the number of threads.
HermitianForm energy_form(const std::vector<ShapeMap>& maps, const Eigen::VectorXd& w) {
  constexpr int length = 8192;
  const int edges = static_cast<int>(w.size()), ranges = (edges + length - 1) / length;
  const auto count = static_cast<Eigen::Index>(maps.size());
  std::vector<HermitianForm> partial(ranges, HermitianForm::Zero(count, count));
  parallel_for(ranges, [&](int r) {
    Eigen::VectorXcd d(count);
    for (int e = r * length; e < std::min(edges, (r + 1) * length); ++e) {
      if (w[e] == 0) continue;
      for (Eigen::Index j = 0; j < count; ++j) d[j] = difference_along(maps[j], e);
      partial[r].noalias() += w[e] * d.conjugate() * d.transpose();
    }
  });
  HermitianForm sum = HermitianForm::Zero(count, count);
  for (const HermitianForm& some : partial) sum += some;
  return sum;
}

// Where the boundary of the cut mesh lies in each map, a row for each of its vertices.
Eigen::MatrixXcd boundary_in_maps(const CutMesh& cut, const std::vector<ShapeMap>& maps) {
  Eigen::MatrixXcd z(cut.boundary.size(), maps.size());
  for (Eigen::Index k = 0; k < z.rows(); ++k) {
    const int v = cut.boundary[k];
    for (Eigen::Index j = 0; j < z.cols(); ++j) {
      const Vector3 source = maps[j].positions.row(cut.source_vertex[v]);
      z(k, j) = in_plane(maps[j].boundary.transform(v) * source);
    }
  }
  return z;
}

// Of the signed area, half the imaginary part of the sum of conj(z_k) z_(k + 1) around the boundary.
HermitianForm area_form(const CutMesh& cut, const std::vector<ShapeMap>& maps) {
  const Eigen::MatrixXcd z = boundary_in_maps(cut, maps);
  Eigen::MatrixXcd next(z.rows(), z.cols());
  next << z.bottomRows(z.rows() - 1), z.topRows(1);
  const Eigen::MatrixXcd products = z.adjoint() * next;
  return (products - products.adjoint()) / PlaneNumber(0, 4);
}

// How many eigenvalues approach that of conformal maps. On a disk, whose double has every cone twice, the
// forms are real.
int conformal_eigenvalues(const Target& target) {
  const bool is_disk = target.topology == Topology::disk;
  int count = 1;
  for (const Mark& mark : target.marks)
    count += (is_disk && mark.kind == ConeKind::rotation ? 2 : 1) * turns_in_excess(mark);
  return count;
}

// The weights of edges that touch a cone of more than one turn, or a neighbour of one; of all others zero.
Eigen::VectorXd weights_at_great_cones(const GluingProblem& problem, const GluedEdges& glued) {
  std::vector<char> is_near(problem.surface.vertex_count(), 0);
  for (std::size_t k = 0; k < problem.target.marks.size(); ++k)
    if (turns_in_excess(problem.target.marks[k]) > 0) is_near[problem.cut.marks[k]] = 1;
  const std::vector<char> is_great = is_near;
  for (const auto& [i, j, t] : glued.edges)
    if (is_great[i] || is_great[j]) is_near[i] = is_near[j] = 1;
  Eigen::VectorXd w = problem.weights.w;
  for (std::size_t e = 0; e < glued.edges.size(); ++e)
    if (!is_near[glued.edges[e].i] && !is_near[glued.edges[e].j]) w[static_cast<Eigen::Index>(e)] = 0;
  return w;
}

// The v with the largest eigenvalues of A v = m S v, so many, the last the largest.
template <typename Matrix>
Matrix leading_vectors(const Matrix& A, const Matrix& S, int count) {
  const Eigen::GeneralizedSelfAdjointEigenSolver<Matrix> solver(A, S);
  return solver.eigenvectors().rightCols(std::min<Eigen::Index>(count, A.cols()));
}

// The combination of least energy for its area.
template <typename Matrix>
Eigen::VectorXcd best_combination(const Forms<Matrix>& forms, int conformal) {
  const Matrix leading = leading_vectors(forms.area, forms.energy, conformal);
  if (leading.cols() == 1) return leading.col(0).template cast<PlaneNumber>();
  const Matrix area = leading.adjoint() * forms.area * leading;
  Matrix energy = leading.adjoint() * forms.energy_at_great_cones * leading;
  energy.diagonal().array() += 1e-12 * std::abs(energy.trace());
  return (leading * leading_vectors(area, energy, 1)).template cast<PlaneNumber>();
}

Forms<Eigen::MatrixXd> real_parts(const Forms<HermitianForm>& forms) {
  return {forms.area.real(), forms.energy.real(), forms.energy_at_great_cones.real()};
}

// Of the surfaces' forms in one basis, each in the coordinates c' = change c.
template <typename Matrix>
Forms<Matrix> sum_of_forms(const std::vector<Forms<Matrix>>& forms, const std::vector<Matrix>& changes) {
  Forms<Matrix> sum;
  const auto add = [](const Matrix& form, const Matrix& change, Matrix& to) {
    if (form.size() == 0) return;
    const Matrix changed = change.adjoint() * form * change;
    to = to.size() == 0 ? changed : Matrix(to + changed);
  };
  for (std::size_t s = 0; s < forms.size(); ++s) {
    add(forms[s].area, changes[s], sum.area);
    add(forms[s].energy, changes[s], sum.energy);
    add(forms[s].energy_at_great_cones, changes[s], sum.energy_at_great_cones);
  }
  return sum;
}

// Of shapes, one a column, in the basis: real where shapes may not be turned.
HermitianForm coordinates_in(const TileShapes& shapes, const Eigen::MatrixXcd& columns) {
  HermitianForm products = shapes.basis.adjoint() * columns;
  if (shapes.may_be_turned) return products;
  return products.real().cast<PlaneNumber>();
}

}  // namespace

struct ConformalShapes::State {
  const GluingProblem& problem;
  TileShapes shapes;
  std::vector<ShapeMap> maps;
  Forms<HermitianForm> forms;
};

ConformalShapes::ConformalShapes(const GluingProblem& problem, const LaplacianSolver& laplacian)
    : state_(std::make_unique<State>(State{problem, tile_shapes(problem.target, problem.cut), {}, {}})) {
  std::vector<ShapeMap>& maps = state_->maps;
  for (Eigen::Index j = 0; j < state_->shapes.basis.cols(); ++j)
    maps.push_back(map_of_shape(problem, laplacian, state_->shapes.basis.col(j)));
  state_->forms = {area_form(problem.cut, maps), energy_form(maps, problem.weights.w), {}};
  if (conformal_eigenvalues(problem.target) > 1)
    state_->forms.energy_at_great_cones =
        energy_form(maps, weights_at_great_cones(problem, maps.front().glued));
}

ConformalShapes::~ConformalShapes() = default;
ConformalShapes::ConformalShapes(ConformalShapes&&) noexcept = default;

Eigen::VectorXcd ConformalShapes::own_shape() const {
  return shared_shape({this}, {Eigen::MatrixXcd::Identity(shapes().basis.rows(), shapes().basis.rows())});
}

const TileShapes& ConformalShapes::shapes() const { return state_->shapes; }

Eigen::VectorXcd ConformalShapes::scaled(const Eigen::VectorXcd& shape) const {
  const Eigen::VectorXcd coefficients = coordinates_in(shapes(), shape);
  const double area = coefficients.dot(state_->forms.area * coefficients).real();
  return std::sqrt(target_area(state_->problem.target) / area) * shape;
}

// The origin of the shape stays where it is: a sum of maps moves with the sum of its marks.
Points ConformalShapes::map_onto(const Eigen::VectorXcd& shape) const {
  const std::vector<ShapeMap>& maps = state_->maps;
  const auto marks = static_cast<double>(shape.size());
  const PlaneNumber middle = shape.sum() / marks;
  const Eigen::VectorXcd coefficients = coordinates_in(shapes(), (shape.array() - middle).matrix());
  Points positions(maps.front().positions.rows(), 3);
  parallel_ranges(static_cast<int>(positions.rows()), [&](int begin, int end) {
    for (int v = begin; v < end; ++v) {
      PlaneNumber sum = middle;
      for (std::size_t j = 0; j < maps.size(); ++j)
        sum += coefficients[static_cast<Eigen::Index>(j)] * in_plane(maps[j].positions.row(v));
      positions.row(v) << sum.real(), sum.imag(), 1;
    }
  });
  for (std::size_t k = 0; k < state_->problem.cut.marks.size(); ++k) {
    const PlaneNumber mark = shape[static_cast<Eigen::Index>(k)];
    positions.row(state_->problem.cut.marks[k]) << mark.real(), mark.imag(), 1;
  }
  return positions;
}

Eigen::VectorXcd shared_shape(const std::vector<const ConformalShapes*>& surfaces,
                              const std::vector<Eigen::MatrixXcd>& changes) {
  const TileShapes& shapes = surfaces.front()->shapes();
  const GluingProblem& problem = surfaces.front()->state_->problem;
  std::vector<Forms<HermitianForm>> forms;
  std::vector<HermitianForm> in_basis;
  for (std::size_t s = 0; s < surfaces.size(); ++s) {
    forms.push_back(surfaces[s]->state_->forms);
    in_basis.push_back(coordinates_in(surfaces[s]->shapes(), changes[s] * shapes.basis));
  }
  const Forms<HermitianForm> sum = sum_of_forms(forms, in_basis);
  const int conformal = conformal_eigenvalues(problem.target);
  const Eigen::VectorXcd best =
      shapes.may_be_turned ? best_combination(sum, conformal) : best_combination(real_parts(sum), conformal);
  return surfaces.front()->scaled(shapes.basis * best);
}

Points conformal_map(const GluingProblem& problem, const LaplacianSolver& laplacian) {
  const ConformalShapes shapes(problem, laplacian);
  Eigen::VectorXcd shape = shapes.own_shape();
  shape.array() -= PlaneNumber(shape[0]);
  return shapes.map_onto(shape);
}

}  // namespace orbitutte
