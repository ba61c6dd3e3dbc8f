// SPDX-License-Identifier: MIT
#include "orbitutte/render/lighting.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "orbitutte/mesh/connectivity.h"
#include "orbitutte/mesh/disjoint_sets.h"
#include "orbitutte/render/image.h"

namespace orbitutte {
namespace {

CornerNormals face_normals(const Points& V, const Triangles& F) {
  CornerNormals normals(F.rows(), 3);
  for (Eigen::Index f = 0; f < F.rows(); ++f) {
    const Vector3 a = V.row(F(f, 0)), b = V.row(F(f, 1)), c = V.row(F(f, 2));
    normals.row(f) = (b - a).cross(c - a).cast<float>();
  }
  return normals;
}

// Whether the faces of two half-edges that run against each other meet in an angle of at most acos(cosine).
bool is_smooth(const CornerNormals& faces, int h, int opposite, float cosine) {
  const Vector3f n = faces.row(h / 3), m = faces.row(opposite / 3);
  return n.dot(m) >= cosine * n.norm() * m.norm();
}

// The corners that share a normal.
DisjointSets smooth_corners(const Points& V, const Triangles& F, const CornerNormals& faces, float cosine) {
  const Connectivity connectivity = connectivity_of(F, static_cast<int>(V.rows()));
  DisjointSets corners(static_cast<int>(F.size()));
  for (int h = 0; h < static_cast<int>(F.size()); ++h) {
    const int o = connectivity.opposite[h];
    if (o < h || halfedge_origin(F, h) != halfedge_target(F, o) || !is_smooth(faces, h, o, cosine)) continue;
    corners.unite(h, next_halfedge(o));
    corners.unite(next_halfedge(h), o);
  }
  return corners;
}

float fraction(float x) { return x - std::floor(x); }

// Interleaved gradient noise (J. Jimenez, "Next Generation Post Processing in Call of Duty", 2014): a number
// 0 .. 1 for every pixel that takes all values in every small block of pixels.
float dither(float x, float y) { return fraction(52.9829189F * fraction(0.06711056F * x + 0.00583715F * y)); }

// The k-th direction of a pixel on the hemisphere about the z axis, cosine-weighted: M. Roberts' R2 sequence,
// which fills the unit square evenly, shifted by the pixel's own number.
Vector3f hemisphere_direction(float shift, int k) {
  const float u = fraction(shift + 0.7548776662F * static_cast<float>(k));
  const float v = fraction(7 * shift + 0.5698402910F * static_cast<float>(k));
  const float angle = 2 * std::numbers::pi_v<float> * v, radius = std::sqrt(u);
  return {radius * std::cos(angle), radius * std::sin(angle), std::sqrt(1 - u)};
}

Vector3f unit(float x, float y, float z) { return Vector3f(x, y, z).normalized(); }

// In the camera's frame.
const Vector3f& main_light() {
  static const Vector3f direction = unit(-0.45F, 0.65F, 0.75F);
  return direction;
}

constexpr float lamp_radius = 0.35F;  // at distance 1
constexpr float shade = 0.75F;        // the share of the main light that its shadows take away

}  // namespace

CornerNormals corner_normals(const Points& V, const Triangles& F, double crease) {
  const CornerNormals faces = face_normals(V, F);
  DisjointSets sets = smooth_corners(V, F, faces, static_cast<float>(std::cos(crease)));
  CornerNormals normals = CornerNormals::Zero(F.size(), 3);
  for (int c = 0; c < static_cast<int>(F.size()); ++c) normals.row(sets.find(c)) += faces.row(c / 3);
  // The smallest member of a set comes first: it is a unit vector by the time the others copy it.
  for (int c = 0; c < static_cast<int>(F.size()); ++c) {
    const int set = sets.find(c);
    if (set == c) {
      normals.row(c).stableNormalize();
    } else {
      normals.row(c) = normals.row(set);
    }
  }
  return normals;
}

float brightness(const Vector3f& normal, const Exposure& exposure) {
  static const Vector3f fill_light = unit(0.8F, 0.1F, 0.5F);
  const float open = exposure.openness;
  const float ambient = 0.40F * open * (0.8F + 0.2F * normal[1]);
  const float main = 0.78F * std::max(0.0F, normal.dot(main_light())) * (1 - shade + shade * exposure.lit);
  const float fill = 0.16F * std::max(0.0F, normal.dot(fill_light));
  return ambient + (0.35F + 0.65F * open) * (main + fill);
}

float gloss(const Vector3f& normal) {
  static const Vector3f halfway = (main_light() + Vector3f::UnitZ()).normalized();
  return 0.07F * std::pow(std::max(0.0F, normal.dot(halfway)), 40.0F);
}

float openness(const Blocker& is_blocked, const Ray& from, int rays, const Sample& sample) {
  const float shift = dither(std::floor(sample.x), std::floor(sample.y));
  const Eigen::Quaternionf turn = Eigen::Quaternionf::FromTwoVectors(Vector3f::UnitZ(), from.direction);
  int open = 0;
  for (int k = 0; k < rays; ++k) {
    const Vector3f direction = turn * hemisphere_direction(shift, rays * sample.number + k);
    open += is_blocked({from.origin, direction, from.length}) ? 0 : 1;
  }
  return static_cast<float>(open) / static_cast<float>(rays);
}

float lit(const Blocker& is_blocked, const Vector3f& origin, const Matrix3& axes, const Sample& sample) {
  const float shift = dither(std::floor(sample.x), std::floor(sample.y));
  const Vector3f centre = axes.transpose().cast<float>() * main_light();
  const Eigen::Quaternionf turn = Eigen::Quaternionf::FromTwoVectors(Vector3f::UnitZ(), centre);
  Vector3f aside = hemisphere_direction(shift, sample.number);
  aside[2] = 0;
  return is_blocked({origin, centre + lamp_radius * (turn * aside)}) ? 0.0F : 1.0F;
}

}  // namespace orbitutte
