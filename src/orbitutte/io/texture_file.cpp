// SPDX-License-Identifier: MIT
#include "orbitutte/io/texture_file.h"

#include <fmt/format.h>

#include <cmath>

#include "orbitutte/io/compression.h"
#include "orbitutte/io/file.h"
#include "orbitutte/io/mesh_io.h"
#include "orbitutte/io/text_scanner.h"

namespace orbitutte {
namespace {

constexpr int without_texture = -1;

// Reads the lines vt, and of the lines f the second index of each corner v/vt/vn.
class TextureReader {
 public:
  explicit TextureReader(std::string_view text) : in_(text, {.comment = '#', .backslash_continues = true}) {}

  std::optional<TextureLayout> read() {
    while (in_.find_word()) {
      const std::string_view keyword = in_.word();
      if (keyword == "vt") {
        read_coordinates();
      } else if (keyword == "f") {
        while (in_.find_word_in_line()) read_corner(in_.word());
        ++faces_;
      } else {
        in_.rest_of_line();
      }
    }
    return layout();
  }

 private:
  std::size_t rows() const { return coordinates_.size() / 2; }

  // A third number, of textures that fill space, is ignored.
  void read_coordinates() {
    const TextItem item = {"texture coordinates", rows()};
    coordinates_.push_back(in_.number<double>(item, "u"));
    coordinates_.push_back(in_.find_word_in_line() ? in_.number<double>(item, "v") : 0);
    in_.skip_words();
    if (!std::isfinite(coordinates_.back()) || !std::isfinite(*(coordinates_.rbegin() + 1)))
      in_.refuse(fmt::format("texture coordinates {} are not finite", item.number));
  }

  void read_corner(std::string_view corner) {
    const int row = row_of(corner);
    if (!of_corner_.empty() && (row == without_texture) != (of_corner_.back() == without_texture))
      in_.refuse(fmt::format("face {}: some corners have texture coordinates and others do not", faces_));
    of_corner_.push_back(row);
  }

  int row_of(std::string_view corner) {
    const std::size_t slash = corner.find('/');
    if (slash == corner.npos) return without_texture;
    const std::string_view rest = corner.substr(slash + 1), word = rest.substr(0, rest.find('/'));
    if (word.empty()) return without_texture;
    long long index = 0;
    const TextItem face = {"face", faces_};
    const NumberError error = parse_number(word, index);
    if (error != NumberError::none) in_.refuse_number(error, true, word, face, "texture index");
    const long long row = index > 0 ? index - 1 : static_cast<long long>(rows()) + index;
    if (index == 0 || row < 0 || row > largest_row)
      in_.refuse(fmt::format("face {} has the texture index {}, which is none", faces_, index));
    return static_cast<int>(row);
  }

  // Indices may name lines that follow, so all are compared at the end.
  std::optional<TextureLayout> layout() const {
    if (of_corner_.empty() || of_corner_.front() == without_texture) return std::nullopt;
    TextureLayout layout = {Eigen::MatrixX2d(static_cast<Eigen::Index>(rows()), 2), of_corner_};
    for (Eigen::Index k = 0; k < layout.uv.rows(); ++k)
      layout.uv.row(k) << coordinates_[2 * k], coordinates_[2 * k + 1];
    for (const int row : of_corner_)
      if (row >= layout.uv.rows())
        throw MeshError(fmt::format("a face has the texture index {}, but only {} lines begin with 'vt'",
                                    row + 1LL, layout.uv.rows()));
    return layout;
  }

  static constexpr long long largest_row = 2147483646;

  TextScanner in_;
  std::vector<double> coordinates_;
  std::vector<int> of_corner_;
  std::size_t faces_ = 0;
};

}  // namespace

std::optional<TextureLayout> parse_obj_texture(std::string_view text) { return TextureReader(text).read(); }

std::optional<TextureLayout> read_texture_layout(const std::string& path) {
  if (mesh_format(path) != MeshFormat::obj) return std::nullopt;
  return parse_file(path, [&](const std::string& bytes) {
    return is_compressed(path) ? parse_obj_texture(decompress(bytes)) : parse_obj_texture(bytes);
  });
}

}  // namespace orbitutte
