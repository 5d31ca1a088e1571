#include "image/seen_noise.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

namespace fluxel {

namespace {

/// The standard deviation of normal noise over the median of its size.
constexpr double kOfMedian = 1.4826;

/// Of a difference from the line between two neighbours, (-1, 2, -1) / 2, over that of a pixel: sqrt(6) / 2.
constexpr double kOfDifference = 1.2247448713915890;

/// A pixel of the picture.
struct SeenPixel {
  PatchId patch = kNoPatch;  ///< kNoPatch: none, or several surfaces
  bool front = false;
  double light = 0;  ///< mean irradiance [W/m2], of the colours too
};

/// Row-major, as the picture.
std::vector<SeenPixel> pixels_of(const Raster& fine, int supersample, std::span<const Rgb> irradiance) {
  const auto k = static_cast<std::size_t>(supersample), width = static_cast<std::size_t>(fine.width);
  std::vector<SeenPixel> pixels;
  for (std::size_t row = 0; row + k <= static_cast<std::size_t>(fine.height); row += k)
    for (std::size_t column = 0; column + k <= width; column += k) {
      const std::size_t first = row * width + column;
      SeenPixel pixel{fine.patch[first], fine.front[first] != 0};
      for (std::size_t part = 0; part < k * k; ++part) {
        const std::size_t at = first + part / k * width + part % k;
        if (fine.patch[at] != fine.patch[first] || fine.front[at] != fine.front[first])
          pixel.patch = kNoPatch;
        pixel.light += mean_of_colours(irradiance[at]) / static_cast<double>(k * k);
      }
      pixels.push_back(pixel);
    }
  return pixels;
}

}  // namespace

std::optional<double> seen_noise(const Raster& fine, int supersample, std::span<const Rgb> irradiance) {
  const std::vector<SeenPixel> pixels = pixels_of(fine, supersample, irradiance);
  std::vector<double> sizes;
  const auto look = [&](const SeenPixel& before, const SeenPixel& at, const SeenPixel& after) {
    if (at.patch == kNoPatch) return;
    for (const SeenPixel& other : {before, after})
      if (other.patch != at.patch || other.front != at.front) return;
    const double mean = (before.light + at.light + after.light) / 3;
    if (mean > 0) sizes.push_back(std::abs(at.light - (before.light + after.light) / 2) / mean);
  };
  const auto width = static_cast<std::size_t>(fine.width / supersample);
  for (std::size_t pixel = 0; pixel < pixels.size(); ++pixel) {
    const std::size_t column = pixel % width;
    if (column > 0 && column + 1 < width) look(pixels[pixel - 1], pixels[pixel], pixels[pixel + 1]);
    if (pixel >= width && pixel + width < pixels.size())
      look(pixels[pixel - width], pixels[pixel], pixels[pixel + width]);
  }
  if (sizes.empty()) return std::nullopt;
  const auto middle = sizes.begin() + static_cast<std::ptrdiff_t>(sizes.size() / 2);
  std::ranges::nth_element(sizes, middle);
  return kOfMedian * *middle / kOfDifference;
}

}  // namespace fluxel
