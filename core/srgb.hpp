#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace fluxel {

/// The sRGB transfer (IEC 61966-2-1) from linear 0..1 to 8 bits, rounded. What lies outside is cut, and what
/// is no number is 0.
[[nodiscard]] inline std::uint8_t encode_srgb(double linear) {
  if (!(linear > 0)) return 0;
  const double cut = std::min(linear, 1.0);
  const double encoded = cut <= 0.0031308 ? 12.92 * cut : 1.055 * std::pow(cut, 1 / 2.4) - 0.055;
  return static_cast<std::uint8_t>(std::lround(255 * encoded));
}

/// Its inverse, to linear 0..1.
[[nodiscard]] inline double decode_srgb(std::uint8_t encoded) {
  const double value = encoded / 255.0;
  return value <= 0.04045 ? value / 12.92 : std::pow((value + 0.055) / 1.055, 2.4);
}

}  // namespace fluxel
