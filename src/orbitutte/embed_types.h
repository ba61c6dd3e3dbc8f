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
  /// A file of lines `i j w` (read_weights), which replaces `weights` if the path is not empty.
  std::string weights_file;
  /// Which of all cuts through the cones is taken. It changes no length.
  CutOptions cut;
  /// The linear solver.
  LaplacianOptions laplacian;
  /// How boundary vertices are spread along the sides of a fixed polygon.
  Spread spread = Spread::arc_length;
  /// For targets without marks, and for quotients of maps to others.
  QuotientOptions quotient;
  /// The optimiser stops if the gradient and the last step are smaller (LbfgsOptions::tolerance).
  double tolerance = 1e-9;
  int max_iterations = 2000;
  /// 0: as many as the machine has. Results do not depend on it.
  int threads = 0;
  ProgressCallback progress;
};

/// What a quotient was made from, and which of all Möbius maps it was followed by.
struct QuotientRecord {
  /// The orbifold that the solved map is onto.
  std::string signature;
  /// Its marked vertices.
  std::vector<int> cones;
  Centre centre = Centre::none;
  /// Where vertices were asked to lie.
  std::vector<PolygonCorner> points;
};

/// The embedding, and everything that is known of it.
struct EmbedResult {
  Embedding embedding;
  EdgeWeights weights;

  /// The kind that was to be taken, if no map with it was certified and `weights` are of another.
  std::optional<WeightKind> requested_weights;
  /// Where the optimiser ended. Its positions are those of the input vertices.
  Minimum minimum;
  /// If the map is a quotient: then `minimum` tells how the map that it was made from was found, but for
  /// positions and energy, which are the quotient's own.
  std::optional<QuotientRecord> quotient;
  /// Input vertices that were moved off the minimum, so that thin triangles are positively oriented;
  /// ascending.
  std::vector<int> moved_vertices;
  /// If no map can be bijective: the faces that must become arcs or points, since the mesh is not 3-connected
  /// there; ascending. Empty if these are ears only, which are rounded outward.
  std::vector<int> collapsing_faces;
  /// The certificate of the input's triangles.
  Certificate certificate;
  /// The certificate of the triangulation that has the weights. Only present if that triangulation is not
  /// the input's, and the input's certificate says that the map is not bijective.
  std::optional<Certificate> intrinsic_certificate;
  Distortion distortion;
  /// What the coarseness of the mesh costs (distortion_floor.h); embed does not measure it.
  std::optional<Distortion> floor;
  Topology topology = Topology::sphere;
  int unreferenced_vertices = 0;
  int zero_area_faces = 0;
  Backend backend = Backend::eigen;
  int threads = 1;
  Timings timings;
  /// One sentence each.
  std::vector<std::string> warnings;
};

}  // namespace orbitutte
