// SPDX-License-Identifier: MIT
// Edge weights of the discrete Dirichlet energy (section 4), on the uncut mesh.
#pragma once

#include <string>

#include "orbitutte/mesh/connectivity.h"

namespace orbitutte {

enum class WeightKind {
  cotan,    ///< w_ij = (cot a + cot b)/2 over the angles opposite to the edge; those not positive become
            ///< `clamp`
  uniform,  ///< w_ij = 1
  file      ///< given by the caller
};

/// "cotan", "uniform" or "file".
std::string name(WeightKind kind);

struct WeightOptions {
  WeightKind kind = WeightKind::cotan;
  double clamp = 0.01;  ///< of cotangent weights, > 0: the paper's value
};

struct EdgeWeights {
  WeightKind kind = WeightKind::cotan;
  double clamp = 0.01;
  Eigen::VectorXd w;      ///< one weight per undirected edge, in the order of Connectivity::edges
  int clamped_edges = 0;  ///< cotangent weights that were not positive
  int zero_edges =
      0;  ///< weights of a file that are exactly zero: accepted, though the theory asks for w > 0
};

/// Weights on the uncut mesh, so that no cut can change them. Zero-area triangles have no cotangents and add
/// nothing. Throws ArgumentError for a clamp that is not positive and finite, and for WeightKind::file.
EdgeWeights edge_weights(const Mesh& mesh, const Connectivity& connectivity, const WeightOptions& options);

/// Reads lines `i j w`, each undirected edge of the mesh once, in any order; further columns are ignored.
/// Throws FileError, and MeshError naming the line and the edge: no edge of the mesh, given twice, missing, a
/// weight that is negative or not finite.
EdgeWeights read_weights(const std::string& path, const Connectivity& connectivity);

}  // namespace orbitutte
