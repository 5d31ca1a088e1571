#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "core/choices.hpp"
#include "image/picture.hpp"

namespace fluxel {

/// How radiance is shown.
struct ToneCurve {
  Tone tone = Tone::linear;
  double exposure = 0;  ///< [stops]: exposed is radiance * 2^exposure
  double white = 1;     ///< the exposed luminance that becomes white

  /// Linear, 0 to 1 in each channel; what is not a number is black.
  [[nodiscard]] Rgb shown(const Rgb& radiance) const;
};

/// A picture for the eye: sRGB, 8 bits a channel.
struct DisplayPicture {
  int width = 0;
  int height = 0;
  std::vector<std::uint8_t> rgb;  ///< three a pixel, row-major, row 0 at the top
  ToneCurve curve;                ///< that it was made by
};

/// The curve of a picture: radiance is exposed, and its luminance (weights of ITU-R BT.709) compressed.
/// Curves act on the luminance, and a colour of which a channel would be above 1 becomes darker as a whole,
/// so that hue and saturation stay.
///
/// linear: the luminance itself. reinhard: L (1 + L / W^2) / (1 + L), W being the largest luminance of
/// reflected light (Reinhard, Stark, Shirley & Ferwerda 2002, equation 4). filmic: a fit to the curve of the
/// Academy Color Encoding System (Narkowicz 2016), which makes shadows darker and highlights softer.
///
/// Without an exposure one is chosen: with linear the 98th percentile of the luminance becomes 0.8, with the
/// curves the logarithmic mean of what has more than a hundredth of the mean becomes 0.18 before them. It is
/// taken of reflected light alone, rho H / pi, over the pixels that have some, so that a luminaire that fills
/// much of the picture does not darken the rest; where nothing reflects, of the radiance. A black picture
/// gets the exposure 0. An exposure that is not finite throws InputError.
[[nodiscard]] ToneCurve choose_curve(const Picture& picture, std::optional<double> exposure, Tone tone);

/// What that curve makes of the picture, encoded (sRGB transfer, IEC 61966-2-1) and rounded to 8 bits.
[[nodiscard]] DisplayPicture tone_map(const Picture& picture, std::optional<double> exposure, Tone tone);

}  // namespace fluxel
