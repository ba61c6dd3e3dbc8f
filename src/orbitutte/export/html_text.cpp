// SPDX-License-Identifier: MIT
#include "orbitutte/export/html_text.h"

#include <openssl/evp.h>

#include <algorithm>

namespace orbitutte {

std::string escape_html(std::string_view text) {
  std::string escaped;
  escaped.reserve(text.size());
  for (const char c : text) {
    switch (c) {
      case '&':
        escaped += "&amp;";
        break;
      case '<':
        escaped += "&lt;";
        break;
      case '>':
        escaped += "&gt;";
        break;
      case '"':
        escaped += "&quot;";
        break;
      case '\'':
        escaped += "&#39;";
        break;
      default:
        escaped += c;
    }
  }
  return escaped;
}

std::string base64(std::string_view bytes) {
  // A multiple of three bytes, so that only the last piece is padded.
  constexpr std::size_t piece = 3 << 20;
  std::string text(4 * ((bytes.size() + 2) / 3) + 1, '\0');  // the encoder ends with a zero byte
  std::size_t written = 0;
  for (std::size_t from = 0; from < bytes.size(); from += piece) {
    const std::size_t length = std::min(piece, bytes.size() - from);
    written += static_cast<std::size_t>(EVP_EncodeBlock(
        reinterpret_cast<unsigned char*>(text.data() + written),
        reinterpret_cast<const unsigned char*>(bytes.data() + from), static_cast<int>(length)));
  }
  text.resize(written);
  return text;
}

std::string grouped_digits(long long count) {
  std::string digits = std::to_string(count);
  const std::size_t first = count < 0 ? 1 : 0;
  for (std::size_t at = digits.size(); at > first + 3; at -= 3) digits.insert(at - 3, 1, ',');
  return digits;
}

}  // namespace orbitutte
