// SPDX-License-Identifier: MIT
// Maps between two surfaces by way of one target: both are embedded into it with corresponding vertices at
// its marks, and what lies at the same point of the target corresponds. If both embeddings are certified,
// the map from one surface to the other is one to one.
#pragma once

#include <string>
#include <vector>

#include "orbitutte/embed_types.h"
#include "orbitutte/io/landmark_file.h"

namespace orbitutte {

/// What decides the shape of the tile that both surfaces are mapped onto.
enum class TileShape {
  /// Both surfaces: the sum of the energies is least.
  shared,
  /// The number of landmarks alone.
  regular
};

/// Its names.
template <>
struct NameTable<TileShape> {
  static constexpr NamedValue<TileShape> rows[] = {{TileShape::shared, "shared"},
                                                   {TileShape::regular, "regular"}};
};

/// How to map.
struct MapOptions {
  /// How each surface is embedded; its options of cuts and of quotients count for nothing here. The tolerance
  /// is a fine one, since limbs that shrink show what is left of it in full size on the other surface; tiles
  /// of free shape in the hyperbolic plane take 1e-9 if it is finer.
  EmbedOptions embed = with_fine_tolerance();

  /// Which of the cuts through the landmarks are taken. They change nothing about the map.
  CutOptions cut_a, cut_b;

  TileShape tile = TileShape::shared;

  /// The order in which the cuts lead through the landmarks (indices); if it is empty, the shortest on A. On
  /// a disk, of the landmarks inside.
  std::vector<int> tour;

  static EmbedOptions with_fine_tolerance() {
    EmbedOptions options;
    options.tolerance = 1e-13;
    return options;
  }
};

/// Where the shape of the tile came from, and how sure the isotopy class is. On a sphere with four landmarks
/// or more, maps with the same landmarks may differ by twists around some of these.
struct MapClass {
  /// The tile that was taken in the end.
  TileShape tile = TileShape::shared;

  /// Of both surfaces' own conformal tiles: how far they are apart, and how far in the class that is next;
  /// zero where there is but one class, infinity where others were not looked at.
  double distance = 0, next_distance = 0;

  /// By how many half twists of neighbouring landmarks the cut of B was found to differ from that of A.
  int half_twists = 0;
};

/// Two embeddings into one target. Cone i of one (Embedding::cones) and cone i of the other are partners.
/// Both lie in one frame but for Embedding::placement, and the gluings of either are products of the other's.
struct SurfaceMap {
  EmbedResult a, b;

  /// In the order in which they were given.
  std::vector<Landmark> landmarks;
  MapClass map_class;
  Timings timings;

  /// About the map; those about each embedding are with it. One sentence each.
  std::vector<std::string> warnings;

  const Target& target() const { return a.embedding.target; }
  bool is_bijective() const { return a.certificate.bijective && b.certificate.bijective; }
};

/// The map of surface A to surface B that takes every landmark to its partner.
///
/// On spheres the target has order 2 at every landmark: three make 222, four 2222 in the plane, and more a
/// hyperbolic orbifold. On disks, landmarks on the boundary become corners and those inside cones. Without
/// landmarks two spheres are mapped to the whole sphere, and turned so that their scales fit best, which is
/// a guess.
///
/// Throws MeshError naming the landmark if it is no vertex, is used twice, or lies inside one surface and on
/// the boundary of the other, if the boundaries meet their landmarks in another order, if there are fewer
/// than the topology needs, or if the surfaces have different topologies; ArgumentError; Cancelled.
SurfaceMap map_between(const Surface& a, const Surface& b, const std::vector<Landmark>& landmarks,
                       const MapOptions& options = {});

}  // namespace orbitutte
