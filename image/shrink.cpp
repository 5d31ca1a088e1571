#include "image/shrink.hpp"

#include <algorithm>

namespace fluxel {

DisplayPicture shrunk(const DisplayPicture& picture, int most) {
  const int factor = (std::max(picture.width, picture.height) + most - 1) / most;
  if (factor <= 1) return picture;
  DisplayPicture small;
  small.curve = picture.curve;
  small.width = (picture.width + factor - 1) / factor;
  small.height = (picture.height + factor - 1) / factor;
  for (int y = 0; y < small.height; ++y)
    for (int x = 0; x < small.width; ++x) {
      const int right = std::min(picture.width, (x + 1) * factor);
      const int bottom = std::min(picture.height, (y + 1) * factor);
      const int count = (right - x * factor) * (bottom - y * factor);
      for (int c = 0; c < 3; ++c) {
        int sum = 0;
        for (int row = y * factor; row < bottom; ++row)
          for (int column = x * factor; column < right; ++column)
            sum += picture.rgb[(static_cast<std::size_t>(row) * static_cast<std::size_t>(picture.width) +
                                static_cast<std::size_t>(column)) *
                                   3 +
                               static_cast<std::size_t>(c)];
        small.rgb.push_back(static_cast<std::uint8_t>((sum + count / 2) / count));
      }
    }
  return small;
}

}  // namespace fluxel
