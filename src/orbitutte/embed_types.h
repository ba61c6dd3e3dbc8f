// SPDX-License-Identifier: MIT
// Options and results of embed: what programs include to name them, without the solver.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "orbitutte/mesh/edge_weights.h"
#include "orbitutte/minimum.h"
#include "orbitutte/options.h"
#include "orbitutte/orbifold/embedding.h"
#include "orbitutte/progress.h"
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

  /// The kind that was to be taken, if no map with it was certified and `weights` are of another.
  std::optional<WeightKind> requested_weights;
  Minimum minimum;  ///< how the optimiser fared; its positions are those of the input vertices
  /// Input vertices that were moved off the minimum, so that thin triangles are positively oriented;
  /// ascending.
  std::vector<int> moved_vertices;
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

}  // namespace orbitutte
