// SPDX-License-Identifier: MIT
// Compressed bytes: zlib and gzip streams (RFC 1950 to 1952).
#pragma once

#include <string>
#include <string_view>

namespace orbitutte {

/// What was compressed, of gzip or zlib streams, one or several after each other. Throws MeshError if the
/// bytes are no such stream, cut short or damaged.
std::string decompress(std::string_view bytes);

/// The same of `size` bytes: MeshError if there are more or fewer, before memory is taken for a size that no
/// such stream can have.
std::string decompress(std::string_view bytes, std::size_t size);

/// As a gzip file without name and time, so that the same bytes give the same file.
std::string compress_to_gzip(std::string_view bytes);

/// Writes a file (write_file), as a gzip file if the path ends in `.gz`.
void write_compressed_as_named(const std::string& path, const std::string& bytes);

/// As a zlib stream.
std::string compress(std::string_view bytes);

}  // namespace orbitutte
