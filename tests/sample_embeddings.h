// SPDX-License-Identifier: MIT
// Small meshes with marked vertices for every family, and their embeddings.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "orbitutte/embed.h"
#include "orbitutte/geometry/space.h"
#include "planar_families.h"
#include "test_meshes.h"

namespace orbitutte::test {

/// All families of the sphere with marks, the free order N in {2, 3, 5, 12}.
inline std::vector<std::string> sample_signatures() {
  return {"532", "432",   "332",  "222",    "223",  "225",  "2,2,12", "22",   "33",
          "55",  "12,12", "*532", "*432",   "*332", "*222", "*223",   "*225", "*2,2,12",
          "*22", "*33",   "*55",  "*12,12", "3*2",  "2*2",  "2*3",    "2*5",  "2*12",
          "2*",  "3*",    "5*",   "12*",    "1x",   "2x",   "3x",     "5x",   "12x"};
}

/// An irregular sphere of 320 faces, a bent disk of 384, or a projective plane of 640, whichever the orbifold
/// needs.
inline Mesh sample_mesh_for(const Target& orbifold) {
  if (orbifold.topology == Topology::sphere) return perturbed(icosphere(2), 0.03, 7);
  if (orbifold.topology == Topology::projective_plane) return perturbed(projective_plane(3), 0.01, 7);
  Mesh mesh = round_disk(8);
  mesh.V.col(2) = 0.4 * mesh.V.col(0).array().square() - 0.2 * mesh.V.col(1).array();
  return perturbed(mesh, 0.015, 7);
}

struct SampleEmbedding {
  Mesh mesh;
  std::vector<int> marks;
  EmbedResult result;

  const Embedding& embedding() const { return result.embedding; }
};

/// The whole sphere and the hemisphere, whose maps are quotients and no minima.
inline std::vector<std::string> whole_signatures() { return {"1", "*"}; }

/// Those too, and those of the plane.
inline std::vector<std::string> all_sample_signatures() {
  std::vector<std::string> all = sample_signatures();
  for (const std::string& signature : planar_signatures()) all.push_back(signature);
  for (const std::string& signature : free_planar_signatures()) all.push_back(signature);
  for (const std::string& signature : whole_signatures()) all.push_back(signature);
  return all;
}

inline SampleEmbedding make_sample(const std::string& signature, const EmbedOptions& options) {
  const Target orbifold = parse_orbifold(signature);
  const Mesh mesh = sample_mesh_for(orbifold);
  const std::vector<int> marks = choose_cones(mesh, orbifold);
  return {mesh, marks, embed(mesh, orbifold, marks, options)};
}

/// With the paper's weights and otherwise default options, computed once.
inline const SampleEmbedding& sample_embedding(const std::string& signature) {
  static std::map<std::string, SampleEmbedding> samples;
  const auto at = samples.find(signature);
  if (at != samples.end()) return at->second;
  EmbedOptions options;
  options.weights.kind = WeightKind::cotan;
  options.threads = 1;
  return samples.emplace(signature, make_sample(signature, options)).first->second;
}

/// The length of every undirected edge of the uncut mesh, in the order of its Connectivity: what does not
/// depend on the cut, nor on where the map lies.
inline Eigen::VectorXd edge_lengths(const Mesh& mesh, const Embedding& embedding) {
  Triangles source = embedding.triangles;  // not the mesh's, where faces are turned over
  for (int& v : source.reshaped()) v = embedding.source_vertex[v];
  const Connectivity connectivity = connectivity_of(source, vertex_count(mesh));
  Eigen::VectorXd lengths(static_cast<Eigen::Index>(connectivity.edges.size()));
  for (int h = 0; h < static_cast<int>(embedding.triangles.size()); ++h)
    lengths[connectivity.edge_of[h]] =
        embedding.space().distance(embedding.positions.row(halfedge_origin(embedding.triangles, h)),
                                   embedding.positions.row(halfedge_target(embedding.triangles, h)));
  return lengths;
}

}  // namespace orbitutte::test
