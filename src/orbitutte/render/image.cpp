// SPDX-License-Identifier: MIT
#include "orbitutte/render/image.h"

#include "orbitutte/parallel.h"

namespace orbitutte {

Image supersample(const PictureSize& size, const std::function<Rgba(const Sample&)>& shade) {
  constexpr int per_pixel = samples_across * samples_across;
  Image image = {size, std::vector<Rgba>(static_cast<std::size_t>(size.width) * size.height)};
  const auto offset = [](int k) { return (static_cast<float>(k) + 0.5F) / samples_across; };
  parallel_for(size.height, [&](int row) {
    for (int column = 0; column < size.width; ++column) {
      const std::size_t pixel = static_cast<std::size_t>(row) * size.width + column;
      Rgba sum = Rgba::Zero();
      for (int k = 0; k < per_pixel; ++k)
        sum += shade({static_cast<float>(column) + offset(k % samples_across),
                      static_cast<float>(row) + offset(k / samples_across), k});
      image.pixels[pixel] = sum / per_pixel;
    }
  });
  return image;
}

}  // namespace orbitutte
