// SPDX-License-Identifier: MIT
#include "orbitutte/io/compression.h"

#include <fmt/format.h>
#include <zlib.h>

#include <algorithm>
#include <limits>
#include <memory>

#include "orbitutte/io/file.h"
#include "orbitutte/types.h"

namespace orbitutte {
namespace {

constexpr int window = 15, or_gzip_header = 32, gzip_header = 16;
constexpr std::size_t most_at_once = std::size_t{1} << 30;  // zlib counts in unsigned int
constexpr std::size_t best_ratio = 1032;                    // of deflate

Bytef* to_zlib(const char* bytes) { return reinterpret_cast<Bytef*>(const_cast<char*>(bytes)); }

struct EndInflate {
  void operator()(z_stream* stream) const { inflateEnd(stream); }
};
struct EndDeflate {
  void operator()(z_stream* stream) const { deflateEnd(stream); }
};

[[noreturn]] void refuse_damaged(const z_stream& stream) {
  throw MeshError(
      fmt::format("the compressed data are damaged or cut short ({}); copy or export the file again",
                  stream.msg ? stream.msg : "they end too early"));
}

// Decompresses into a text that grows up to `limit` bytes.
class Inflation {
 public:
  Inflation(std::string_view bytes, std::size_t limit) : rest_(bytes), limit_(limit) {
    if (inflateInit2(&stream_, window + or_gzip_header) != Z_OK) throw std::bad_alloc();
    end_.reset(&stream_);
  }

  std::string run(std::size_t expected) {
    std::string result;
    result.resize(std::min(expected, limit_) + 1);
    std::size_t done = 0;
    while (true) {
      if (done == result.size()) result.resize(2 * result.size());
      const int status = step(result, done);
      if (done > limit_)
        throw MeshError("the compressed data hold more than they should; export the file again");
      if (status == Z_STREAM_END) {
        if (stream_.avail_in == 0 && rest_.empty()) break;
        if (inflateReset(&stream_) != Z_OK) refuse_damaged(stream_);  // another stream follows
      } else if (status == Z_BUF_ERROR || status == Z_OK) {
        if (stream_.avail_in == 0 && rest_.empty() && done < result.size()) refuse_damaged(stream_);
      } else {
        refuse_damaged(stream_);
      }
    }
    result.resize(done);
    return result;
  }

 private:
  int step(std::string& result, std::size_t& done) {
    if (stream_.avail_in == 0) {
      const std::size_t next = std::min(rest_.size(), most_at_once);
      stream_.next_in = to_zlib(rest_.data());
      stream_.avail_in = static_cast<uInt>(next);
      rest_.remove_prefix(next);
    }
    const auto room = static_cast<uInt>(std::min(result.size() - done, most_at_once));
    stream_.next_out = to_zlib(result.data() + done);
    stream_.avail_out = room;
    const int status = inflate(&stream_, Z_NO_FLUSH);
    done += room - stream_.avail_out;
    return status;
  }

  std::string_view rest_;
  std::size_t limit_;
  z_stream stream_ = {};
  std::unique_ptr<z_stream, EndInflate> end_;
};

std::string deflated(std::string_view bytes, int window_bits) {
  z_stream stream = {};
  if (deflateInit2(&stream, Z_DEFAULT_COMPRESSION, Z_DEFLATED, window_bits, 8, Z_DEFAULT_STRATEGY) != Z_OK)
    throw std::bad_alloc();
  const std::unique_ptr<z_stream, EndDeflate> end(&stream);
  std::string result;
  result.resize(bytes.size() / 2 + 1024);
  std::size_t done = 0;
  for (int status = Z_OK; status != Z_STREAM_END;) {
    if (stream.avail_in == 0 && !bytes.empty()) {
      const std::size_t next = std::min(bytes.size(), most_at_once);
      stream.next_in = to_zlib(bytes.data());
      stream.avail_in = static_cast<uInt>(next);
      bytes.remove_prefix(next);
    }
    if (done == result.size()) result.resize(2 * result.size());
    const auto room = static_cast<uInt>(std::min(result.size() - done, most_at_once));
    stream.next_out = to_zlib(result.data() + done);
    stream.avail_out = room;
    status = deflate(&stream, bytes.empty() ? Z_FINISH : Z_NO_FLUSH);
    done += room - stream.avail_out;
  }
  result.resize(done);
  return result;
}

}  // namespace

std::string decompress(std::string_view bytes) {
  return Inflation(bytes, std::numeric_limits<std::size_t>::max() / 4).run(4 * bytes.size());
}

std::string decompress(std::string_view bytes, std::size_t size) {
  const auto wrong = [&](std::string_view than) {
    return MeshError(fmt::format(
        "the compressed data hold {} than the {} bytes they should; export the file again", than, size));
  };
  if (size / best_ratio > bytes.size()) throw wrong("less");
  std::string result = Inflation(bytes, size).run(size);
  if (result.size() != size) throw wrong("less");
  return result;
}

std::string compress_to_gzip(std::string_view bytes) { return deflated(bytes, window + gzip_header); }

std::string compress(std::string_view bytes) { return deflated(bytes, window); }

void write_compressed_as_named(const std::string& path, const std::string& bytes) {
  write_file(path, is_compressed(path) ? compress_to_gzip(bytes) : bytes);
}

}  // namespace orbitutte
