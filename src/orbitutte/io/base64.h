// SPDX-License-Identifier: MIT
// Bytes as text (base64, RFC 4648).
#pragma once

#include <string>
#include <string_view>

namespace orbitutte {

/// Base64 (padded) of bytes.
std::string base64(std::string_view bytes);

/// The bytes that the text stands for; blanks and ends of lines are ignored. Throws MeshError for anything
/// else that is no base64.
std::string from_base64(std::string_view text);

}  // namespace orbitutte
