#include "image/filter.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "core/error.hpp"

namespace fluxel {

namespace {

std::size_t pixel_at(const Picture& picture, int column, int row) {
  return static_cast<std::size_t>(row) * static_cast<std::size_t>(picture.width) +
         static_cast<std::size_t>(column);
}

/// A window wider than the picture sees no more than the picture.
int reach_within(const Picture& picture, double reach) {
  return static_cast<int>(std::min(reach, static_cast<double>(std::max(picture.width, picture.height))));
}

/// One pass of the separable filter, along rows (step 1, 0) or columns (step 0, 1).
std::vector<Rgb> blur_along(const Picture& picture, const std::vector<double>& weight, int step_x,
                            int step_y) {
  const int reach = static_cast<int>(weight.size()) - 1;
  std::vector<Rgb> blurred(picture.pixels());
  for (int row = 0; row < picture.height; ++row) {
    for (int column = 0; column < picture.width; ++column) {
      const int position = step_x * column + step_y * row;
      const int last = step_x * (picture.width - 1) + step_y * (picture.height - 1);
      Rgb sum(0.0);
      double weights = 0;
      for (int at = std::max(0, position - reach); at <= std::min(last, position + reach); ++at) {
        const double w = weight[static_cast<std::size_t>(std::abs(at - position))];
        sum += w * picture.radiance[step_x != 0 ? pixel_at(picture, at, row) : pixel_at(picture, column, at)];
        weights += w;
      }
      blurred[pixel_at(picture, column, row)] = sum / weights;
    }
  }
  return blurred;
}

void apply_gaussian(double sigma, Picture& picture) {
  std::vector<double> weight;
  const int reach = reach_within(picture, std::floor(3 * sigma));
  for (int offset = 0; offset <= reach; ++offset) {
    weight.push_back(std::exp(-0.5 * (offset / sigma) * (offset / sigma)));
  }
  picture.radiance = blur_along(picture, weight, 1, 0);
  picture.radiance = blur_along(picture, weight, 0, 1);
}

void apply_median(int radius, Picture& picture) {
  std::vector<Rgb> filtered(picture.pixels());
  std::array<std::vector<double>, kChannels> window;
  for (int row = 0; row < picture.height; ++row) {
    for (int column = 0; column < picture.width; ++column) {
      for (auto& channel : window) channel.clear();
      for (int y = row - radius; y <= row + radius; ++y) {
        for (int x = column - radius; x <= column + radius; ++x) {
          const Rgb& near = picture.radiance[pixel_at(picture, std::clamp(x, 0, picture.width - 1),
                                                      std::clamp(y, 0, picture.height - 1))];
          for (int c = 0; c < kChannels; ++c) window[static_cast<std::size_t>(c)].push_back(near[c]);
        }
      }
      for (int c = 0; c < kChannels; ++c) {
        auto& values = window[static_cast<std::size_t>(c)];
        const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
        std::nth_element(values.begin(), middle, values.end());
        filtered[pixel_at(picture, column, row)][c] = *middle;
      }
    }
  }
  picture.radiance = std::move(filtered);
}

}  // namespace

void apply_filter(const PictureFilter& filter, Picture& picture) {
  using Kind = PictureFilter::Kind;
  if (filter.kind == Kind::none) return;
  if (!std::isfinite(filter.size) || filter.size < 0) {
    throw InputError(fmt::format("a picture filter's size of {} pixels is not possible", filter.size));
  }
  if (filter.kind == Kind::median && filter.size != std::floor(filter.size)) {
    throw InputError(fmt::format("a median's radius is a whole number of pixels, not {}", filter.size));
  }
  if (filter.size == 0) return;
  if (filter.kind == Kind::gaussian) {
    apply_gaussian(filter.size, picture);
  } else {
    apply_median(reach_within(picture, filter.size), picture);
  }
}

}  // namespace fluxel
