// SPDX-License-Identifier: MIT
// What landmarks on two surfaces ask of a target.
#pragma once

#include <vector>

#include "orbitutte/io/landmark_file.h"
#include "orbitutte/mesh/surface.h"
#include "orbitutte/orbifold/target.h"

namespace orbitutte {

/// Landmarks (indices into the list that was given) that lie inside both surfaces, and those on the
/// boundaries, in their order along these.
struct LandmarkPlaces {
  std::vector<int> inside, on_boundary;

  int count() const { return static_cast<int>(inside.size() + on_boundary.size()); }
};

/// Judges the landmarks of two spheres or two disks. Throws MeshError: if the topologies differ or are
/// others, naming the landmark if a vertex does not exist, belongs to no face or is used twice, or if it lies
/// inside one surface and on the boundary of the other; if the boundaries meet the landmarks in different
/// orders; and if there are too few.
LandmarkPlaces landmark_places(const Surface& a, const Surface& b, const std::vector<Landmark>& landmarks);

/// The target with a mark for each landmark, those inside first. On a sphere all orders are two: 222, 2222 in
/// the plane, or hyperbolic. On a disk three or four landmarks on the boundary alone make *222 and *2222;
/// otherwise it is a flat disk whose corners have the angle pi - d and whose cones have 2 pi - 2 d, with the
/// same d.
Target landmark_target(Topology topology, const LandmarkPlaces& places);

/// A flat surface with the same angle at each landmark inside, and the same at each on the boundary: the
/// deficits add up to 4 pi on a sphere, to 2 pi on a disk, where that of a cone is twice that of a corner.
Target flat_landmark_target(Topology topology, const LandmarkPlaces& places);

}  // namespace orbitutte
