// SPDX-License-Identifier: MIT
#include "orbitutte/verify/convexity.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>

#include "orbitutte/geometry/orientation.h"

namespace orbitutte {
namespace {

Vector3 middle(Space space, const Points& positions, std::span<const int> corners) {
  const Vector3 first = positions.row(corners.front());
  Vector3 sum = Vector3::Zero();
  for (const int v : corners) sum += positions.row(v).transpose() - first;
  return space.retract(first + sum / static_cast<double>(corners.size()));
}

// The neighbours of corner k along the polygon.
std::array<int, 2> beside(std::span<const int> corners, std::size_t k) {
  const std::size_t d = corners.size();
  return {corners[(k + d - 1) % d], corners[(k + 1) % d]};
}

// Per input vertex: does it have two edges, so that all its corners have the same neighbours? Cones do not
// count.
std::vector<char> vertices_with_two_edges(const Embedding& embedding) {
  const FaceView faces = embedding.faces();
  const std::vector<int>& source = embedding.source_vertex;
  constexpr std::array<int, 2> none = {-1, -1};
  std::vector<std::array<int, 2>> neighbors(source.size(), none);
  std::vector<char> result(source.size(), 1);
  for (const ConeCopies& cone : embedding.cones) result[cone.vertex] = 0;
  for (int f = 0; f < faces.count(); ++f) {
    for (std::size_t k = 0; k < faces[f].size(); ++k) {
      const int v = source[faces[f][k]];
      const auto [before, behind] = beside(faces[f], k);
      const auto [lower, upper] = std::minmax({source[before], source[behind]});
      const std::array<int, 2> here = {lower, upper};
      if (neighbors[v] == none) neighbors[v] = here;
      if (neighbors[v] != here) result[v] = 0;
    }
  }
  return result;
}

// The distance of b from the great circle through a and c.
double offset(const Vector3& a, const Vector3& b, const Vector3& c) {
  const Vector3 normal = a.cross(c);
  return std::abs(normal.dot(b - a)) / normal.norm();
}

}  // namespace

DividedPolygons divide_from_middles(const Embedding& embedding) {
  const FaceView faces = embedding.faces();
  DividedPolygons result;
  Embedding& divided = result.embedding;
  divided.target = embedding.target;
  divided.source_vertex = embedding.source_vertex;
  divided.seams = embedding.seams;
  divided.cones = embedding.cones;
  std::vector<int> corners;
  std::vector<Vector3> middles;
  for (int f = 0; f < faces.count(); ++f) {
    const std::span<const int> face = faces[f];
    if (face.size() == 3) {
      corners.insert(corners.end(), face.begin(), face.end());
      result.face_of.push_back(f);
      continue;
    }
    for (std::size_t k = 0; k < face.size(); ++k) {
      corners.insert(corners.end(),
                     {face[k], face[(k + 1) % face.size()], static_cast<int>(divided.source_vertex.size())});
      result.face_of.push_back(f);
    }
    divided.source_vertex.push_back(-1);
    middles.push_back(middle(embedding.space(), embedding.positions, face));
  }
  divided.triangles =
      Eigen::Map<const Triangles>(corners.data(), static_cast<Eigen::Index>(corners.size() / 3), 3);
  divided.positions.resize(static_cast<Eigen::Index>(divided.source_vertex.size()), 3);
  divided.positions.topRows(embedding.positions.rows()) = embedding.positions;
  for (std::size_t k = 0; k < middles.size(); ++k)
    divided.positions.row(embedding.positions.rows() + static_cast<Eigen::Index>(k)) = middles[k];
  return result;
}

std::vector<ConcaveCorner> concave_corners(const Embedding& embedding, double straight_bound) {
  const FaceView faces = embedding.faces();
  const Points& X = embedding.positions;
  const std::vector<char> has_two_edges = vertices_with_two_edges(embedding);
  const auto is_concave = [&](std::span<const int> face, std::size_t k) {
    const auto [before, behind] = beside(face, k);
    const Vector3 a = X.row(before), b = X.row(face[k]), c = X.row(behind);
    if (orientation_sign(a, b, c) > 0) return false;
    return !(has_two_edges[embedding.source_vertex[face[k]]] && offset(a, b, c) <= straight_bound);
  };
  std::vector<ConcaveCorner> result;
  for (int f = 0; f < faces.count(); ++f) {
    std::size_t k = faces[f].size() == 3 ? 3 : 0;  // a triangle is convex
    while (k < faces[f].size() && !is_concave(faces[f], k)) ++k;
    if (k < faces[f].size()) result.push_back({f, faces[f][k]});
  }
  return result;
}

}  // namespace orbitutte
