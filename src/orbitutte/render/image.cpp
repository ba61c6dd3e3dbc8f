// SPDX-License-Identifier: MIT
#include "orbitutte/render/image.h"

#include "orbitutte/parallel.h"

namespace orbitutte {

Image picture_of(const PictureSize& size, const std::function<Rgba(int column, int row)>& colour) {
  Image image = {size, std::vector<Rgba>(static_cast<std::size_t>(size.width) * size.height)};
  parallel_for(size.height, [&](int row) {
    Rgba* const pixels = &image.pixels[static_cast<std::size_t>(row) * size.width];
    for (int column = 0; column < size.width; ++column) pixels[column] = colour(column, row);
  });
  return image;
}

}  // namespace orbitutte
