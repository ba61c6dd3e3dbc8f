// SPDX-License-Identifier: MIT
// What the tests of solve/ start from: meshes cut and glued for every family.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "orbitutte/cut/cut.h"
#include "orbitutte/embed.h"
#include "orbitutte/solve/initial_embedding.h"
#include "planar_families.h"
#include "test_meshes.h"

namespace orbitutte::test {

/// Everything that stands before the optimiser, in the order of the paper.
struct SolveCase {
  std::string signature;
  Mesh mesh;
  Target orbifold;
  std::vector<int> marks;
  Connectivity connectivity;
  EdgeWeights weights;
  CutMesh cut;
  Tile tile;
  BoundaryConditions boundary;
  GluedEdges glued;
};

inline std::unique_ptr<SolveCase> solve_case(const std::string& signature, const CutOptions& options = {}) {
  auto result = std::make_unique<SolveCase>();
  result->signature = signature;
  result->orbifold = parse_orbifold(signature);
  const bool sphere = result->orbifold.topology == Topology::sphere;
  result->mesh = perturbed(sphere ? icosphere(2) : round_disk(7), 0.03, 7);
  result->marks = choose_cones(result->mesh, result->orbifold);
  result->connectivity = connectivity_of(result->mesh.F, vertex_count(result->mesh));
  result->weights = edge_weights(unjudged(result->mesh), {WeightKind::cotan});
  result->cut = cut_to_disk(unjudged(result->mesh), result->marks, result->orbifold.inner_marks, options);
  result->tile = basic_tile(result->orbifold, result->cut.arrangement);
  result->boundary = glue(result->cut, result->tile, result->orbifold);
  result->glued = glued_edges(result->cut, result->connectivity, result->boundary);
  return result;
}

/// One or two of each family of the sphere.
inline std::vector<std::string> signatures() {
  return {"532",  "432",  "332", "222", "225", "22",  "55",  "*532", "*432", "*332",
          "*222", "*225", "*22", "*55", "3*2", "2*2", "2*5", "2*",   "5*"};
}

/// Those, and the families of the plane.
inline std::vector<std::string> all_signatures() {
  std::vector<std::string> all = signatures();
  for (const std::string& signature : planar_signatures()) all.push_back(signature);
  return all;
}

/// Feasible positions, moved along feasible directions.
inline Points moved(const SolveCase& of, const Points& positions, double step, const Points& directions) {
  Points result;
  move_points(of.boundary.space, positions, directions, step, result);
  return result;
}

/// A feasible direction: a random vector in the room of every vertex.
inline Points random_feasible(const SolveCase& of, std::uint32_t seed) {
  std::mt19937 generator(seed);
  std::uniform_real_distribution<double> uniform(-1, 1);
  Points result(of.boundary.vertex_count(), 3);
  for (Eigen::Index v = 0; v < result.rows(); ++v) {
    const Vector3 random(uniform(generator), uniform(generator), uniform(generator));
    const Room& room = of.boundary.basis(static_cast<int>(v));
    result.row(v) = room * (room.transpose() * random);
  }
  return result;
}

}  // namespace orbitutte::test
