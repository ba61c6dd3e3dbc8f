// SPDX-License-Identifier: MIT
#include "orbitutte/render/lighting.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "orbitutte/mesh/connectivity.h"
#include "orbitutte/mesh/disjoint_sets.h"

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

// The k-th of so many points that fill the unit disk evenly: H. Vogel, "A better way to construct the
// sunflower head", Mathematical Biosciences 44, 1979.
Eigen::Vector2f sunflower(int k, int count) {
  constexpr float golden_angle = 2.3999632F;
  const float angle = golden_angle * static_cast<float>(k);
  return std::sqrt((static_cast<float>(k) + 0.5F) / static_cast<float>(count)) *
         Eigen::Vector2f(std::cos(angle), std::sin(angle));
}

constexpr int packets_to_surroundings = 2;

// On the hemisphere about the z axis, cosine-weighted: above points that fill the disk.
std::array<Vector3f, packets_to_surroundings * packet_size> hemisphere_directions() {
  std::array<Vector3f, packets_to_surroundings * packet_size> directions;
  for (std::size_t k = 0; k < directions.size(); ++k) {
    const Eigen::Vector2f place = sunflower(static_cast<int>(k), static_cast<int>(directions.size()));
    directions[k] << place, std::sqrt(1 - place.squaredNorm());
  }
  return directions;
}

std::array<Vector3f, packet_size> lamp_points() {
  std::array<Vector3f, packet_size> points;
  for (int k = 0; k < packet_size; ++k) points[k] << sunflower(k, packet_size), 0;
  return points;
}

// Columns: two directions across an axis, turned about it by a share of a full turn, and the axis.
Eigen::Matrix3f frame_about(const Vector3f& axis, float turn) {
  const float angle = 2 * std::numbers::pi_v<float> * turn;
  const Vector3f across = axis.unitOrthogonal(), further = axis.cross(across);
  Eigen::Matrix3f frame;
  frame << std::cos(angle) * across + std::sin(angle) * further,
      std::cos(angle) * further - std::sin(angle) * across, axis;
  return frame;
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
  const float cosine = std::max(0.0F, normal.dot(halfway)), to_2 = cosine * cosine, to_4 = to_2 * to_2,
              to_8 = to_4 * to_4, to_16 = to_8 * to_8;
  return 0.07F * to_16 * to_16 * to_8;
}

float openness(const Blocker& are_blocked, const Ray& from, float turn) {
  static const auto directions = hemisphere_directions();
  const Eigen::Matrix3f frame = frame_about(from.direction, turn);
  std::size_t blocked = 0;
  for (int p = 0; p < packets_to_surroundings; ++p) {
    Packet rays;
    for (int k = 0; k < packet_size; ++k)
      rays[k] = {from.origin, frame * directions[packet_size * p + k], from.length};
    blocked += are_blocked(rays).count();
  }
  return 1 - static_cast<float>(blocked) / static_cast<float>(directions.size());
}

float lit(const Blocker& are_blocked, const Vector3f& origin, const Matrix3& axes, float turn) {
  static const auto points = lamp_points();
  const Vector3f centre = axes.transpose().cast<float>() * main_light();
  const Eigen::Matrix3f frame = frame_about(centre, turn);
  Packet rays;
  for (int k = 0; k < packet_size; ++k) rays[k] = {origin, centre + lamp_radius * (frame * points[k])};
  return 1 - static_cast<float>(are_blocked(rays).count()) / packet_size;
}

}  // namespace orbitutte
