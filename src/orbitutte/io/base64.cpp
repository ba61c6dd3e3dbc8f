// SPDX-License-Identifier: MIT
#include "orbitutte/io/base64.h"

#include <openssl/evp.h>

#include <algorithm>
#include <memory>
#include <new>

#include "orbitutte/types.h"

namespace orbitutte {
namespace {

struct FreeDecoder {
  void operator()(EVP_ENCODE_CTX* context) const { EVP_ENCODE_CTX_free(context); }
};

}  // namespace

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

std::string from_base64(std::string_view text) {
  const std::unique_ptr<EVP_ENCODE_CTX, FreeDecoder> context(EVP_ENCODE_CTX_new());
  if (!context) throw std::bad_alloc();
  EVP_DecodeInit(context.get());
  std::string result;
  result.resize(text.size() / 4 * 3 + 64);
  std::size_t done = 0;
  const auto take = [&](int status, int count) {
    if (status < 0) throw MeshError("the data are not base64; export the file again");
    done += static_cast<std::size_t>(count);
  };
  const auto at = [&] { return reinterpret_cast<unsigned char*>(result.data() + done); };
  for (constexpr std::size_t part = 1 << 24; !text.empty();) {
    const std::string_view next = text.substr(0, part);
    text.remove_prefix(next.size());
    int count = 0;
    const int status =
        EVP_DecodeUpdate(context.get(), at(), &count, reinterpret_cast<const unsigned char*>(next.data()),
                         static_cast<int>(next.size()));
    take(status, count);
  }
  int count = 0;
  const int status = EVP_DecodeFinal(context.get(), at(), &count);
  take(status, count);
  result.resize(done);
  return result;
}

}  // namespace orbitutte
