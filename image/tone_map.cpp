#include "image/tone_map.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/error.hpp"

namespace fluxel {

namespace {

constexpr double kPercentile = 0.98;
constexpr double kDisplayedValue = 0.8;

double luminance(const Rgb& colour) { return 0.2126 * colour.r + 0.7152 * colour.g + 0.0722 * colour.b; }

/// The percentile of the positive, finite values; 0 where there are none.
double percentile_of_positive(std::vector<double> values) {
  std::erase_if(values, [](double value) { return !(value > 0) || std::isinf(value); });
  if (values.empty()) return 0;
  const auto rank = static_cast<std::ptrdiff_t>(kPercentile * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), values.begin() + rank, values.end());
  return values[static_cast<std::size_t>(rank)];
}

double choose_exposure(const Picture& picture) {
  std::vector<double> reflected(picture.pixels()), seen(picture.pixels());
  for (std::size_t i = 0; i < picture.pixels(); ++i) {
    reflected[i] = luminance(picture.reflectance[i] * picture.irradiance[i]) / std::numbers::pi;
    seen[i] = luminance(picture.radiance[i]);
  }
  double bright = percentile_of_positive(std::move(reflected));
  if (bright == 0) bright = percentile_of_positive(std::move(seen));
  return bright == 0 ? 0 : std::log2(kDisplayedValue / bright);
}

/// IEC 61966-2-1, linear 0..1 to encoded 0..255.
std::uint8_t encode_srgb(double linear) {
  if (!(linear > 0)) return 0;
  const double cut = std::min(linear, 1.0);
  const double encoded = cut <= 0.0031308 ? 12.92 * cut : 1.055 * std::pow(cut, 1 / 2.4) - 0.055;
  return static_cast<std::uint8_t>(std::lround(255 * encoded));
}

}  // namespace

DisplayPicture tone_map(const Picture& picture, std::optional<double> exposure) {
  if (exposure && !std::isfinite(*exposure)) throw InputError("the exposure is not a finite number of stops");
  DisplayPicture display;
  display.width = picture.width;
  display.height = picture.height;
  display.exposure = exposure ? *exposure : choose_exposure(picture);
  const double scale = std::exp2(display.exposure);
  display.rgb.reserve(picture.pixels() * kChannels);
  for (const Rgb& radiance : picture.radiance) {
    for (int c = 0; c < kChannels; ++c) display.rgb.push_back(encode_srgb(radiance[c] * scale));
  }
  return display;
}

}  // namespace fluxel
