// SPDX-License-Identifier: MIT
// The plain values that every module exchanges.
#pragma once

#include <Eigen/Core>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "orbitutte/errors.h"
#include "orbitutte/names.h"

// Matrices pass between the library and programs, and Eigen allocates them by the vector instructions that
// each is compiled for. An installed library says what it has.
#ifdef ORBITUTTE_EIGEN_ALIGNMENT
static_assert(EIGEN_DEFAULT_ALIGN_BYTES == ORBITUTTE_EIGEN_ALIGNMENT,
              "orbitutte was compiled for other vector instructions: build both with the same -march");
#endif

namespace orbitutte {

using Vector3 = Eigen::Vector3d;
using Matrix3 = Eigen::Matrix3d;

/// n x 3, one position a row.
using Points = Eigen::Matrix<double, Eigen::Dynamic, 3, Eigen::RowMajor>;

/// m x 3, one triangle a row: 0-based vertices, counterclockwise seen from outside.
using Triangles = Eigen::Matrix<int, Eigen::Dynamic, 3, Eigen::RowMajor>;

/// Faces of three corners or more: face f has the vertices corners[start[f]] .. corners[start[f + 1] - 1],
/// counterclockwise seen from outside.
struct Polygons {
  std::vector<int> corners;
  /// One entry more than there are faces.
  std::vector<int> start = {0};

  int count() const { return static_cast<int>(start.size()) - 1; }
};

/// Faces as they are given: a reference to triangles or to polygons.
class FaceView {
 public:
  explicit FaceView(const Triangles& triangles)
      : corners_(triangles.data()), count_(static_cast<int>(triangles.rows())) {}
  explicit FaceView(const Polygons& polygons) : FaceView(polygons.corners, polygons.start) {}
  FaceView(const std::vector<int>& corners, const std::vector<int>& start)
      : corners_(corners.data()), start_(start.data()), count_(static_cast<int>(start.size()) - 1) {}

  int count() const { return count_; }

  /// The number of corners of all faces before f.
  int start(int f) const { return start_ ? start_[f] : 3 * f; }

  int degree(int f) const { return start(f + 1) - start(f); }

  /// The vertices of face f.
  std::span<const int> operator[](int f) const {
    return {corners_ + start(f), static_cast<std::size_t>(degree(f))};
  }

 private:
  const int* corners_;
  /// Of polygons only.
  const int* start_ = nullptr;
  int count_;
};

/// A triangle mesh. Vertices that no face uses are allowed.
struct Mesh {
  /// n x 3.
  Points V;
  /// m x 3.
  Triangles F;
};

/// A corner of a spherical polygon: a vertex on the boundary of a mesh, and the unit vector at which it is
/// held.
struct PolygonCorner {
  int vertex = -1;
  Vector3 position = Vector3::Zero();
};

/// What a surface is, as far as orbifolds need to know.
enum class Topology { sphere, disk, projective_plane, other };

/// Its names.
template <>
struct NameTable<Topology> {
  static constexpr NamedValue<Topology> rows[] = {{Topology::sphere, "sphere"},
                                                  {Topology::disk, "disk"},
                                                  {Topology::projective_plane, "projective-plane"},
                                                  {Topology::other, "other"}};
};

}  // namespace orbitutte
