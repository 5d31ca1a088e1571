#pragma once

#include <cstdint>

#include "core/rgb.hpp"

namespace fluxel {

/// A pixel in which surfaces meet: means over its area, the background counting as black.
struct EdgePixel {
  std::uint32_t pixel = 0;
  Rgb exitance{0};     ///< emitted and reflected [W/m2]
  Rgb reflectance{0};  ///< 0..1
  Rgb irradiance{0};   ///< [W/m2]
};

}  // namespace fluxel
