#include "image/median_filter.hpp"

#include <algorithm>
#include <array>

namespace fluxel {

void apply_median(int radius, Picture& picture) {
  if (radius == 0) return;
  // A window wider than the picture sees no more than the picture.
  const int reach = std::min(radius, std::max(picture.width, picture.height));
  const auto radiance_at = [&picture](int column, int row) -> const Rgb& {
    return picture.radiance[static_cast<std::size_t>(row) * static_cast<std::size_t>(picture.width) +
                            static_cast<std::size_t>(column)];
  };
  std::vector<Rgb> filtered;
  filtered.reserve(picture.pixels());
  std::array<std::vector<double>, kChannels> window;
  for (int row = 0; row < picture.height; ++row) {
    for (int column = 0; column < picture.width; ++column) {
      for (auto& channel : window) channel.clear();
      for (int y = row - reach; y <= row + reach; ++y) {
        for (int x = column - reach; x <= column + reach; ++x) {
          const Rgb& near =
              radiance_at(std::clamp(x, 0, picture.width - 1), std::clamp(y, 0, picture.height - 1));
          for (int c = 0; c < kChannels; ++c) window[static_cast<std::size_t>(c)].push_back(near[c]);
        }
      }
      Rgb& median = filtered.emplace_back(0.0);
      for (int c = 0; c < kChannels; ++c) {
        auto& values = window[static_cast<std::size_t>(c)];
        const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
        std::nth_element(values.begin(), middle, values.end());
        median[c] = *middle;
      }
    }
  }
  picture.radiance = std::move(filtered);
}

}  // namespace fluxel
