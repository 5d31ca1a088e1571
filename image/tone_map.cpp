#include "image/tone_map.hpp"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <limits>
#include <numbers>
#include <numeric>

#include "core/error.hpp"
#include "core/luminance.hpp"
#include "core/srgb.hpp"

namespace fluxel {

namespace {

/// The percentile of linear pictures that becomes so bright; what the logarithmic mean of others becomes.
constexpr double kPercentile = 0.98, kDisplayedValue = 0.8, kMiddleGrey = 0.18;

/// Of the mean: darker pixels do not choose an exposure.
constexpr double kNearlyBlack = 0.01;

/// All that is brighter looks the same, and sums of it are numbers.
constexpr double kBrightest = 1e100;

/// Those that are positive and finite, of reflected light; where there are none, of the radiance.
std::vector<double> luminances_of(const Picture& picture) {
  std::vector<double> reflected, seen;
  const auto add = [](double value, std::vector<double>& to) {
    if (value > 0 && std::isfinite(value)) to.push_back(value);
  };
  for (std::size_t i = 0; i < picture.pixels(); ++i) {
    add(luminance(picture.reflectance[i] * picture.irradiance[i]) / std::numbers::pi, reflected);
    add(luminance(picture.radiance[i]), seen);
  }
  return reflected.empty() ? seen : reflected;
}

/// [stops]
double choose_exposure(std::vector<double> luminances, Tone tone) {
  if (luminances.empty()) return 0;
  if (tone == Tone::linear) {
    const auto rank = static_cast<std::ptrdiff_t>(kPercentile * static_cast<double>(luminances.size() - 1));
    std::nth_element(luminances.begin(), luminances.begin() + rank, luminances.end());
    return std::log2(kDisplayedValue / luminances[static_cast<std::size_t>(rank)]);
  }
  // What is nearly black is shown so, however black it is.
  const double mean =
      std::reduce(luminances.begin(), luminances.end()) / static_cast<double>(luminances.size());
  std::erase_if(luminances, [least = kNearlyBlack * mean](double L) { return L < least; });
  double sum = 0;
  for (const double L : luminances) sum += std::log2(L);
  return std::log2(kMiddleGrey) - sum / static_cast<double>(luminances.size());
}

/// What is shown of exposed luminance.
double compress(double L, double white, Tone tone) {
  switch (tone) {
    case Tone::linear:
      return L;
    case Tone::reinhard:
      return L * (1 + L / (white * white)) / (1 + L);
    case Tone::filmic:
      break;
  }
  return L * (2.51 * L + 0.03) / (L * (2.43 * L + 0.59) + 0.14);
}

}  // namespace

Rgb ToneCurve::shown(const Rgb& radiance) const {
  Rgb colour = glm::clamp(radiance * std::exp2(exposure), Rgb(0), Rgb(std::numeric_limits<double>::max()));
  if (const double most = std::max({colour.r, colour.g, colour.b}); most > kBrightest)
    colour *= kBrightest / most;
  const double L = luminance(colour);
  if (!(L > 0)) return Rgb(0);
  const Rgb compressed = colour * (compress(L, white, tone) / L);
  return compressed / std::max({1.0, compressed.r, compressed.g, compressed.b});
}

ToneCurve choose_curve(const Picture& picture, std::optional<double> exposure, Tone tone) {
  if (exposure && !std::isfinite(*exposure)) throw InputError("the exposure is not a finite number of stops");
  const std::vector<double> luminances = luminances_of(picture);
  ToneCurve curve{tone, exposure ? *exposure : choose_exposure(luminances, tone), 1};
  // What reflects the most of light is white; darker pictures are not made brighter than they are.
  if (!luminances.empty())
    curve.white = std::max(1.0, std::exp2(curve.exposure) * *std::ranges::max_element(luminances));
  return curve;
}

DisplayPicture tone_map(const Picture& picture, std::optional<double> exposure, Tone tone) {
  DisplayPicture display;
  display.width = picture.width;
  display.height = picture.height;
  display.curve = choose_curve(picture, exposure, tone);
  display.rgb.reserve(picture.pixels() * kChannels);
  for (const Rgb& radiance : picture.radiance) {
    const Rgb colour = display.curve.shown(radiance);
    for (int c = 0; c < kChannels; ++c) display.rgb.push_back(encode_srgb(colour[c]));
  }
  return display;
}

}  // namespace fluxel
