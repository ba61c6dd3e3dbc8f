// SPDX-License-Identifier: MIT
// The plain values that every module exchanges, and the exceptions that it throws.
#pragma once

#include <Eigen/Core>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace orbitutte {

using Vector3 = Eigen::Vector3d;
using Matrix3 = Eigen::Matrix3d;

/// n x 3, one position a row.
using Points = Eigen::Matrix<double, Eigen::Dynamic, 3, Eigen::RowMajor>;

/// m x 3, one triangle a row: 0-based vertices, counterclockwise seen from outside.
using Faces = Eigen::Matrix<int, Eigen::Dynamic, 3, Eigen::RowMajor>;

/// A triangle mesh. Vertices that no face uses are allowed.
struct Mesh {
  Points V;  ///< n x 3
  Faces F;   ///< m x 3
};

/// A corner of a spherical polygon: a vertex on the boundary of a mesh, and the unit vector at which it is
/// held.
struct PolygonCorner {
  int vertex = -1;
  Vector3 position = Vector3::Zero();
};

/// What a surface is, as far as spherical orbifolds ask.
enum class Topology { sphere, disk, projective_plane, other };

/// "sphere", "disk", "projective-plane" or "other".
std::string name(Topology topology);

/// The family of all exceptions that the library throws on purpose. what() is one sentence for the user.
class Error : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// A file could not be opened, read or written.
class FileError : public Error {
 public:
  using Error::Error;
};

/// An argument has no meaning: a signature that is no spherical orbifold, an option out of its range.
class ArgumentError : public Error {
 public:
  using Error::Error;
};

/// The mesh, or the vertices marked on it, cannot be embedded as asked; names the vertex, edge or face.
class MeshError : public Error {
 public:
  using Error::Error;
};

/// A progress callback asked to stop.
class Cancelled : public Error {
 public:
  Cancelled() : Error("cancelled") {}
};

}  // namespace orbitutte
