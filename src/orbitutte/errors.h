// SPDX-License-Identifier: MIT
// The exceptions that the library throws on purpose.
#pragma once

#include <stdexcept>

namespace orbitutte {

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

/// An argument makes no sense: a signature that names no orbifold, an option out of its range.
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
