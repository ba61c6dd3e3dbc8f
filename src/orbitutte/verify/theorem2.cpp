// SPDX-License-Identifier: MIT
// N. Aigerman, S. Z. Kovalsky, Y. Lipman, "Spherical Orbifold Tutte Embeddings" (2017), theorem 2; after L.
// Lovasz, "Steinitz representations of polyhedra and the Colin de Verdiere number", Journal of Combinatorial
// Theory B 82 (2001).
#include "orbitutte/verify/theorem2.h"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <new>
#include <numbers>

#include "orbitutte/orbifold/representations.h"
#include "orbitutte/verify/cover.h"

namespace orbitutte {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;
using std::numbers::pi;

constexpr double first_shift = 0.5, shift_ratio = 0.25, least_shift = 1e-6, residual_margin = 10;
constexpr double least_scale = 1e-12;  // in units of the sum of a vertex's off-diagonal entries
constexpr double no_entry = 1e-13;     // smaller entries of rho(g) are rounded zeros

double over_sine(double d) { return d == 0 ? 1 : d / std::sin(d); }
double times_cotangent(double d) { return d == 0 ? 1 : d / std::tan(d); }

// -W_ij: w d / sin d.
double coupling(const CoverEdge& e) { return e.weight * over_sine(e.length); }
// The edge's contribution to W_ii and W_jj: w d cot d.
double diagonal_part(const CoverEdge& e) { return e.weight * times_cotangent(e.length); }

template <typename Term>
VectorXd sum_at_vertices(const Cover& cover, const Term& term) {
  VectorXd sum = VectorXd::Zero(cover.positions.rows());
  for (const CoverEdge& e : cover.edges) {
    sum[e.i] += term(e);
    sum[e.j] += term(e);
  }
  return sum;
}

// E / (2 A), which is 1 for conformal maps.
double energy_over_area(const Cover& cover) {
  double energy = 0;
  for (const CoverEdge& e : cover.edges) energy += e.weight * e.length * e.length;
  return energy / (2 * cover.area.sum());
}

// The diagonal of D, one value per vertex.
VectorXd vertex_scale(const Cover& cover) {
  return energy_over_area(cover) * cover.area + least_scale * sum_at_vertices(cover, coupling);
}

// The rows of W times the coordinates, at one vertex of every orbit. At a stationary map they are rounding
// errors.
Points coordinate_residuals(const Cover& cover, const SymmetryGroup& group) {
  Points r = Points::Zero(cover.positions.rows(), 3);
  const Points& X = cover.positions;
  for (const CoverEdge& e : cover.edges) {
    const Isometry& g = group.elements()[e.g];
    r.row(e.i) += diagonal_part(e) * X.row(e.i) - coupling(e) * (g * Vector3(X.row(e.j))).transpose();
    r.row(e.j) += diagonal_part(e) * X.row(e.j) -
                  coupling(e) * (g.inverse_matrix() * X.row(e.i).transpose()).transpose();
  }
  return r;
}

// The group's own action on space.
Representation space(const SymmetryGroup& group) {
  Representation result;
  result.dimension = 3;
  for (const Isometry& g : group.elements()) result.matrices.emplace_back(g.matrix());
  return result;
}

// |D^-1/2 W X| in the Frobenius norm, over the |G| sheets. If a vertex has a stabilizer, the sum over its
// edges in the cover is the part of the sum over its edges here that the stabilizer fixes.
double residual_norm(const Cover& cover, const SymmetryGroup& group, const VectorXd& scale) {
  const Points r = coordinate_residuals(cover, group);
  const Representation natural = space(group);
  double square = 0;
  for (Eigen::Index i = 0; i < r.rows(); ++i) {
    if (scale[i] == 0) continue;  // the vertex has no edges
    const std::vector<int>& stabilizer = cover.stabilizers[i];
    const double norm =
        stabilizer.empty() ? r.row(i).norm() : (r.row(i) * fixed_vectors(natural, stabilizer)).norm();
    square += norm * norm / scale[i];
  }
  return std::sqrt(group.order() * square);
}

// X'DX over the |G| sheets, where X are the coordinates of all vertices.
Matrix3 coordinate_gram(const Cover& cover, const SymmetryGroup& group, const VectorXd& scale) {
  const Matrix3 here = cover.positions.transpose() * scale.asDiagonal() * cover.positions;
  Matrix3 sum = Matrix3::Zero();
  for (const Isometry& g : group.elements()) sum += g.matrix() * here * g.matrix().transpose();  // of (gX)
  return sum;
}

// A bound: three eigenvalues lie within it of zero.
double kernel_residual(const Cover& cover, const SymmetryGroup& group, const VectorXd& scale) {
  const Eigen::SelfAdjointEigenSolver<Matrix3> gram(coordinate_gram(cover, group, scale));
  return residual_norm(cover, group, scale) / std::sqrt(gram.eigenvalues()[0]);
}

// The unknowns of one representation. Those of vertex i begin at start[i]; they are coordinates in basis[i].
struct CoverUnknowns {
  std::vector<int> start;       // n + 1
  std::vector<MatrixXd> basis;  // n; empty for the standard basis of the whole space

  int of(int i) const { return start[i + 1] - start[i]; }
  int count() const { return start.back(); }
};

CoverUnknowns unknowns_of(const Cover& cover, const Representation& rho, const VectorXd& scale) {
  const int n = static_cast<int>(cover.positions.rows());
  CoverUnknowns result = {std::vector<int>(n + 1, 0), std::vector<MatrixXd>(n)};
  for (int i = 0; i < n; ++i) {
    int free = scale[i] == 0 ? 0 : rho.dimension;
    if (free > 0 && !cover.stabilizers[i].empty()) {
      result.basis[i] = fixed_vectors(rho, cover.stabilizers[i]);
      free = static_cast<int>(result.basis[i].cols());
    }
    result.start[i + 1] = result.start[i] + free;
  }
  return result;
}

// The block of W in the rows of i's unknowns and the columns of j's.
MatrixXd block(const CoverEdge& e, const Representation& rho, const CoverUnknowns& unknowns) {
  const MatrixXd &left = unknowns.basis[e.i], &right = unknowns.basis[e.j];
  MatrixXd result = -coupling(e) * rho.matrices[e.g];
  if (left.size() > 0) result = left.transpose() * result;
  if (right.size() > 0) result = result * right;
  return result;
}

using Entries = std::vector<Eigen::Triplet<double>>;

void add_lower(int row, int column, double value, Entries& entries) {
  entries.emplace_back(std::max(row, column), std::min(row, column), value);
}

// Away from the seams rho(1) = 1 does not couple the components of x.
void add_scalar_edge(const CoverEdge& e, const CoverUnknowns& unknowns, Entries& entries) {
  for (int k = 0; k < unknowns.of(e.i); ++k)
    add_lower(unknowns.start[e.i] + k, unknowns.start[e.j] + k, -coupling(e), entries);
}

void add_edge(const CoverEdge& e, const Representation& rho, const CoverUnknowns& unknowns,
              Entries& entries) {
  if (unknowns.of(e.i) == 0 || unknowns.of(e.j) == 0) return;
  if (e.g == 0 && unknowns.basis[e.i].size() == 0 && unknowns.basis[e.j].size() == 0) {
    add_scalar_edge(e, unknowns, entries);
    return;
  }
  const MatrixXd B = block(e, rho, unknowns);
  for (int r = 0; r < B.rows(); ++r)
    for (int c = 0; c < B.cols(); ++c)
      if (std::abs(B(r, c)) > no_entry * coupling(e))
        add_lower(unknowns.start[e.i] + r, unknowns.start[e.j] + c, B(r, c), entries);
}

// Gives every unknown the value of its vertex.
VectorXd by_unknown(const VectorXd& by_vertex, const CoverUnknowns& unknowns) {
  VectorXd result(unknowns.count());
  for (Eigen::Index i = 0; i < by_vertex.size(); ++i)
    result.segment(unknowns.start[i], unknowns.of(static_cast<int>(i))).setConstant(by_vertex[i]);
  return result;
}

// The lower triangle of the part of W that belongs to rho.
SymmetricMatrix assemble(const Cover& cover, const Representation& rho, const CoverUnknowns& unknowns) {
  Entries entries;
  entries.reserve(unknowns.count() + cover.edges.size() * rho.dimension);
  const VectorXd diagonal = by_unknown(sum_at_vertices(cover, diagonal_part), unknowns);
  for (int k = 0; k < unknowns.count(); ++k) entries.emplace_back(k, k, diagonal[k]);
  for (const CoverEdge& e : cover.edges) add_edge(e, rho, unknowns, entries);
  SymmetricMatrix lower(unknowns.count(), unknowns.count());
  lower.setFromTriplets(entries.begin(), entries.end());
  return lower;
}

// Counts at smaller and smaller shifts, until no more eigenvalues lie between -shift and shift than
// coordinates belong there.
void count_inertia(InertiaCounter& counter, double least, RepresentationInertia& part) {
  for (double shift = first_shift; shift >= least; shift *= shift_ratio) {
    part.shift = shift;
    part.negative = counter.eigenvalues_below(-shift);
    part.kernel = counter.eigenvalues_below(shift) - part.negative;
    if (part.kernel <= part.coordinates) return;
  }
}

// The data that all representations share.
struct Problem {
  const Cover& cover;
  const SymmetryGroup& group;
  VectorXd scale;  // n
  double least_shift;
  InertiaMethod method;
};

std::unique_ptr<InertiaCounter> counter_of(const Representation& rho, const CoverUnknowns& unknowns,
                                           const Problem& problem) {
  return inertia_counter(assemble(problem.cover, rho, unknowns), by_unknown(problem.scale, unknowns),
                         problem.method);
}

RepresentationInertia inertia_of(const Representation& rho, const Problem& problem) {
  const CoverUnknowns unknowns = unknowns_of(problem.cover, rho, problem.scale);
  RepresentationInertia part;
  part.dimension = rho.dimension;
  part.multiplicity = rho.multiplicity;
  part.unknowns = unknowns.count();
  part.coordinates = occurrences_in_space(rho, problem.group);
  if (part.unknowns == 0) return part;
  count_inertia(*counter_of(rho, unknowns, problem), problem.least_shift, part);
  return part;
}

void count_all(const Problem& problem, Theorem2& result) {
  for (const Representation& rho : irreducible_representations(problem.group)) {
    const RepresentationInertia part = inertia_of(rho, problem);
    result.negative += part.multiplicity * part.negative;
    result.kernel += part.multiplicity * part.kernel;
    result.representations.push_back(part);
  }
}

// A kernel that is too large counts as a finding only if the shift could become as small as rounding permits.
bool conclusive(const RepresentationInertia& part, const Problem& problem) {
  if (part.kernel == part.coordinates) return part.shift > 0 || part.unknowns == 0;
  return part.kernel > part.coordinates && problem.least_shift == least_shift;
}

void judge(const Problem& problem, Theorem2& result) {
  result.status = Theorem2::Status::measured;
  for (const RepresentationInertia& part : result.representations) {
    if (conclusive(part, problem)) continue;
    result.status = Theorem2::Status::inconclusive;
    result.detail = fmt::format(
        "no shift separates the kernel from the rest of the spectrum; the coordinates are in the kernel to "
        "{:.1e}",
        result.kernel_residual);
  }
}

double longest_edge(const Cover& cover) {
  double longest = 0;
  for (const CoverEdge& e : cover.edges) longest = std::max(longest, e.length);
  return longest;
}

Check count_check(std::string name, long value, long expected) {
  Check check = {
      std::move(name), value == expected, static_cast<double>(value), static_cast<double>(expected), {}};
  if (!check.passed) check.detail = fmt::format("there are {}, not {}", value, expected);
  return check;
}

}  // namespace

std::vector<Check> Theorem2::checks() const {
  Check edges = {"theorem2_edges", max_edge_length < pi / 2, max_edge_length, pi / 2, {}};
  if (!edges.passed) edges.detail = fmt::format("an edge is {:.6g} long, not below pi/2", max_edge_length);
  std::vector<Check> result = {edges};
  if (status != Status::measured) return result;
  result.push_back(count_check("theorem2_inertia", negative, 1));
  result.push_back(count_check("theorem2_kernel", kernel, 3));
  return result;
}

bool Theorem2::holds() const {
  const std::vector<Check> all = checks();
  return status == Status::measured &&
         std::all_of(all.begin(), all.end(), [](const Check& check) { return check.passed; });
}

namespace {

Theorem2 check_cover(const Cover& cover, const SymmetryGroup& group, const Theorem2Options& options) {
  Theorem2 result;
  result.method = options.method;
  result.max_edge_length = longest_edge(cover);
  if (group.order() > options.max_group_order) {
    result.detail = fmt::format("the group has {} elements; up to {} are taken apart", group.order(),
                                options.max_group_order);
    return result;
  }
  const VectorXd scale = vertex_scale(cover);
  result.kernel_residual = kernel_residual(cover, group, scale);
  const double least = std::max(least_shift, residual_margin * result.kernel_residual);
  const Problem problem = {cover, group, scale, least, options.method};
  try {
    count_all(problem, result);
    judge(problem, result);
  } catch (const InertiaNotFound& failure) {
    result.detail = failure.what();
  } catch (const std::bad_alloc&) {
    result.detail = "memory ran out";
  }
  return result;
}

}  // namespace

std::string reason_without_theorem2(const Target& target) {
  if (target.group_order > 0) return {};
  if (target.space.is_closed())
    return "the theorem is checked for orbifolds that have a symbol, not for cones of given angles";
  return fmt::format("the theorem speaks of finite groups of the sphere, and {} has none", target.signature);
}

Theorem2 check_theorem2(const Surface& surface, const EdgeWeights& weights, const Embedding& embedding,
                        const Theorem2Options& options) {
  if (const std::string reason = reason_without_theorem2(embedding.target); !reason.empty()) {
    Theorem2 result;
    result.method = options.method;
    result.detail = reason;
    return result;
  }
  const SymmetryGroup group = group_of(embedding);
  return check_cover(cover_of(surface, weights, embedding, group), group, options);
}

long cover_eigenvalues_below(const Surface& surface, const EdgeWeights& weights, const Embedding& embedding,
                             double shift, const Theorem2Options& options) {
  const SymmetryGroup group = group_of(embedding);
  const Cover cover = cover_of(surface, weights, embedding, group);
  const Problem problem = {cover, group, vertex_scale(cover), least_shift, options.method};
  long below = 0;
  for (const Representation& rho : irreducible_representations(group)) {
    const CoverUnknowns unknowns = unknowns_of(cover, rho, problem.scale);
    if (unknowns.count() > 0)
      below += rho.multiplicity * counter_of(rho, unknowns, problem)->eigenvalues_below(shift);
  }
  return below;
}

}  // namespace orbitutte
