#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "image/picture.hpp"

namespace fluxel {

/// A picture for the eye: sRGB, 8 bits a channel.
struct DisplayPicture {
  int width = 0;
  int height = 0;
  std::vector<std::uint8_t> rgb;  ///< three a pixel, row-major, row 0 at the top
  double exposure = 0;            ///< [stops]: the displayed linear value is radiance * 2^exposure
};

/// Exposes the radiance, cuts it to 0..1 and encodes it (sRGB transfer, IEC 61966-2-1), rounded to 8 bits.
/// Without an exposure one is chosen: the 98th percentile of the luminance (weights of ITU-R BT.709) becomes
/// the linear value 0.8. It is taken of reflected light alone, rho H / pi, over the pixels that have some, so
/// that a luminaire that fills much of the picture does not darken the rest; where nothing reflects, of the
/// radiance. A black picture gets the exposure 0. An exposure that is not finite throws InputError.
[[nodiscard]] DisplayPicture tone_map(const Picture& picture, std::optional<double> exposure);

}  // namespace fluxel
