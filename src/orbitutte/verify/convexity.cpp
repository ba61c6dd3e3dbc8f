// SPDX-License-Identifier: MIT
#include "orbitutte/verify/convexity.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>

namespace orbitutte {
namespace {

// The mean of the corners, from the first.
Vector3 to_middle(const ExactPositions& positions, std::span<const int> corners) {
  Vector3 sum = Vector3::Zero();
  for (const int v : corners) sum += positions.difference(corners.front(), v);
  return sum / static_cast<double>(corners.size());
}

// Puts a vertex at the middle of a polygon. Beside positions with offsets it is the first corner's position
// and an offset more: off the space by the square of the polygon's size, which changes no orientation.
void add_middle(Embedding& divided, const ExactPositions& positions, std::span<const int> corners) {
  const int first = corners.front(), v = static_cast<int>(divided.source_vertex.size());
  const Vector3 step = to_middle(positions, corners), start = divided.positions.row(first);
  divided.source_vertex.push_back(-1);
  const auto is_exact = [&](int corner) { return positions.has_offsets(corner); };
  if (std::none_of(corners.begin(), corners.end(), is_exact)) {
    divided.positions.row(v) = divided.space().retract(start + step);
    return;
  }
  divided.positions.row(v) = start;
  for (std::size_t k = 0, count = divided.offsets.size(); k < count; ++k)
    if (divided.offsets[k].vertex == first) divided.offsets.push_back({v, divided.offsets[k].d});
  divided.offsets.push_back({v, step});
}

int count_polygons(const FaceView& faces) {
  int count = 0;
  for (int f = 0; f < faces.count(); ++f) count += faces.degree(f) > 3;
  return count;
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
double offset(const ExactPositions& positions, int a, int b, int c) {
  const Vector3 normal = positions.rounded(a).cross(positions.difference(a, c));
  return std::abs(normal.dot(positions.difference(a, b))) / normal.norm();
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
  divided.offsets = embedding.offsets;
  const ExactPositions positions(embedding);
  const int n_cut = static_cast<int>(embedding.source_vertex.size());
  divided.positions.resize(n_cut + count_polygons(faces), 3);
  divided.positions.topRows(n_cut) = embedding.positions;
  std::vector<int> corners;
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
    add_middle(divided, positions, face);
  }
  divided.triangles =
      Eigen::Map<const Triangles>(corners.data(), static_cast<Eigen::Index>(corners.size() / 3), 3);
  return result;
}

std::vector<ConcaveCorner> concave_corners(const Embedding& embedding, const ExactPositions& positions,
                                           double straight_bound) {
  const FaceView faces = embedding.faces();
  const std::vector<char> has_two_edges = vertices_with_two_edges(embedding);
  const auto is_concave = [&](std::span<const int> face, std::size_t k) {
    const auto [before, behind] = beside(face, k);
    if (positions.orientation(before, face[k], behind) > 0) return false;
    return !(has_two_edges[embedding.source_vertex[face[k]]] &&
             offset(positions, before, face[k], behind) <= straight_bound);
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
