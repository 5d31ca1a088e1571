#pragma once

#include "core/rgb.hpp"

namespace fluxel {

/// Of a colour, by the weights of ITU-R BT.709.
[[nodiscard]] inline double luminance(const Rgb& colour) {
  return 0.2126 * colour.r + 0.7152 * colour.g + 0.0722 * colour.b;
}

}  // namespace fluxel
