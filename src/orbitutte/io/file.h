// SPDX-License-Identifier: MIT
// Whole files in, whole files out.
#pragma once

#include <string>
#include <string_view>
#include <utility>

#include "orbitutte/errors.h"

namespace orbitutte {

/// All bytes of a file. Throws FileError with the path and the system's reason.
std::string read_file(const std::string& path);

/// All bytes of standard input up to its end. Throws FileError with the system's reason.
std::string read_standard_input();

/// Writes the bytes to a temporary file beside `path` and renames it, so that the file appears whole or not
/// at all. If something exists there that is not a regular file (a pipe, /dev/stdout), it is written to
/// directly, never replaced. Throws FileError with the path and the system's reason.
void write_file(const std::string& path, std::string_view bytes);

/// What `step` returns; its MeshError gets the path before its message.
template <typename Step>
auto naming_file(const std::string& path, const Step& step) {
  try {
    return step();
  } catch (const MeshError& error) {
    throw MeshError(path + ": " + error.what());
  }
}

/// What `parse` makes of the bytes of a file. Throws FileError, and as naming_file does.
template <typename Parse>
auto parse_file(const std::string& path, const Parse& parse) {
  std::string bytes = read_file(path);
  return naming_file(path, [&] { return parse(std::move(bytes)); });
}

/// The ending by which writers choose a format: ".ply" of "A Mesh.PLY".
std::string ending_of(const std::string& path);

/// Does the path end in `.gz` (any case)?
bool is_compressed(const std::string& path);

/// The path without `.gz` (any case) at its end.
std::string without_gz(const std::string& path);

}  // namespace orbitutte
