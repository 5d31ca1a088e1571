#pragma once

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <span>

#include "core/rgb.hpp"

namespace fluxel {

/// Over the error of other rays, that of those by which emitted and reflected light are told apart for a
/// scale of the latter: what single points have of noise is multiplied by as little as the scale differs
/// from 1.
inline constexpr double kForScale = 4;

[[nodiscard]] inline Rgb mean_square(std::span<const Rgb> a, std::span<const Rgb> b) {
  Rgb squares(0);
  for (std::size_t k = 0; k < a.size(); ++k) squares += (a[k] - b[k]) * (a[k] - b[k]);
  return squares / static_cast<double>(a.size());
}

/// The root over the mean, of the colour where that is largest. Links and rays are as good as the mean of
/// the colours needs, so that a faint colour counts as if it had a tenth of that.
[[nodiscard]] inline double root_over_mean(const Rgb& square, const Rgb& mean) {
  constexpr double kFaint = 0.1;
  const Rgb over = glm::max(mean, Rgb(kFaint * mean_of_colours(mean)));
  double largest = 0;
  for (int c = 0; c < kChannels; ++c) largest = std::max(largest, std::sqrt(square[c]) / over[c]);
  return largest;
}

}  // namespace fluxel
