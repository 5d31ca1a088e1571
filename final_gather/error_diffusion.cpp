#include "final_gather/error_diffusion.hpp"

#include <algorithm>
#include <cstddef>

namespace fluxel {

std::vector<std::uint32_t> diffuse_errors(int width, std::span<const float> wanted) {
  const auto columns = static_cast<std::size_t>(width);
  const std::size_t rows = wanted.size() / columns;
  std::vector<std::uint32_t> chosen;
  // A column on either side takes what leaves the row.
  std::vector<float> here(columns + 2, 0), below(columns + 2, 0);
  for (std::size_t y = 0; y < rows; ++y) {
    const bool backwards = y % 2 == 1;
    for (std::size_t k = 0; k < columns; ++k) {
      const std::size_t x = backwards ? columns - 1 - k : k;
      const std::size_t pixel = y * columns + x;
      float left = wanted[pixel] + here[x + 1];
      if (left >= 0.5F) {
        chosen.push_back(static_cast<std::uint32_t>(pixel));
        left -= 1;
      }
      const std::size_t ahead = backwards ? x : x + 2, behind = backwards ? x + 2 : x;
      here[ahead] += left * (7.0F / 16);
      below[behind] += left * (3.0F / 16);
      below[x + 1] += left * (5.0F / 16);
      below[ahead] += left * (1.0F / 16);
    }
    here.swap(below);
    std::ranges::fill(below, 0.0F);
  }
  std::ranges::sort(chosen);
  return chosen;
}

}  // namespace fluxel
