#include "image/seen_noise.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

namespace fluxel {

namespace {

/// The standard deviation of normal noise over the median of its size.
constexpr double kOfMedian = 1.4826;

/// Of a difference from the line between two neighbours, (-1, 2, -1) / 2, over that of a pixel: sqrt(6) / 2.
constexpr double kOfDifference = 1.2247448713915890;

}  // namespace

std::optional<double> seen_noise(const Raster& raster, std::span<const Rgb> irradiance) {
  std::vector<double> sizes;
  const auto look = [&](std::size_t before, std::size_t at, std::size_t after) {
    if (raster.patch[at] == kNoPatch) return;
    for (const std::size_t other : {before, after})
      if (raster.patch[other] != raster.patch[at] || raster.front[other] != raster.front[at]) return;
    const std::array light{mean_of_colours(irradiance[before]), mean_of_colours(irradiance[at]),
                           mean_of_colours(irradiance[after])};
    const double mean = (light[0] + light[1] + light[2]) / 3;
    if (mean > 0) sizes.push_back(std::abs(light[1] - (light[0] + light[2]) / 2) / mean);
  };
  const auto width = static_cast<std::size_t>(raster.width);
  for (std::size_t pixel = 0; pixel < raster.pixels(); ++pixel) {
    const std::size_t column = pixel % width;
    if (column > 0 && column + 1 < width) look(pixel - 1, pixel, pixel + 1);
    if (pixel >= width && pixel + width < raster.pixels()) look(pixel - width, pixel, pixel + width);
  }
  if (sizes.empty()) return std::nullopt;
  const auto middle = sizes.begin() + static_cast<std::ptrdiff_t>(sizes.size() / 2);
  std::ranges::nth_element(sizes, middle);
  return kOfMedian * *middle / kOfDifference;
}

}  // namespace fluxel
