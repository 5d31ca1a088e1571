#include "image/colour_scale.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace fluxel {

namespace {

constexpr int kMarks = 8;

/// Ten even places of viridis.
constexpr std::array<std::array<int, 3>, 10> kViridis{{{0x44, 0x01, 0x54},
                                                       {0x48, 0x28, 0x78},
                                                       {0x3e, 0x49, 0x89},
                                                       {0x31, 0x68, 0x8e},
                                                       {0x26, 0x82, 0x8e},
                                                       {0x1f, 0x9e, 0x89},
                                                       {0x35, 0xb7, 0x79},
                                                       {0x6e, 0xce, 0x58},
                                                       {0xb5, 0xde, 0x2b},
                                                       {0xfd, 0xe7, 0x25}}};

/// The least of 1, 2 and 5 times a power of ten that is not below.
double round_up(double step) {
  const double power = std::pow(10, std::floor(std::log10(step)));
  for (const double factor : {1.0, 2.0, 5.0})
    if (factor * power >= (1 - 1e-9) * step) return factor * power;
  return 10 * power;
}

}  // namespace

std::vector<double> round_values(double min, double max, int steps) {
  if (!(max > min) || !std::isfinite(max - min)) return {};
  const double step = round_up((max - min) / steps);
  std::vector<double> values;
  for (auto k = std::llround(std::ceil(min / step - 1e-9)); static_cast<double>(k) <= max / step + 1e-9; ++k)
    values.push_back(static_cast<double>(k) * step);
  return values;
}

double ColourScale::place(double value) const {
  const double place = logarithmic ? (value > 0 ? std::log(value / min) / std::log(max / min) : 0)
                                   : (value - min) / (max - min);
  return std::clamp(place, 0.0, 1.0);
}

std::vector<double> ColourScale::marks() const {
  if (!logarithmic) return round_values(min, max, kMarks);
  std::vector<double> values;
  if (!(min >= std::numeric_limits<double>::min())) return values;
  for (double power = std::pow(10, std::floor(std::log10(min))); power <= max; power *= 10)
    for (const double factor : {1.0, 2.0, 5.0})
      if (const double value = factor * power; value >= (1 - 1e-9) * min && value <= (1 + 1e-9) * max)
        values.push_back(value);
  return values;
}

ColourScale choose_scale(std::span<const double> values, const FalseColourScale& asked, ScaleStart start) {
  ColourScale scale;
  double least = std::numeric_limits<double>::max(), largest = std::numeric_limits<double>::lowest();
  for (const double value : values) {
    if (!std::isfinite(value)) continue;
    least = std::min(least, value);
    largest = std::max(largest, value);
  }
  scale.logarithmic = asked.decades.has_value();
  const bool begins_at_zero = scale.logarithmic || start == ScaleStart::zero;
  scale.max = asked.max.value_or(begins_at_zero ? std::max(0.0, largest) : largest);
  scale.min = scale.logarithmic ? scale.max / std::pow(10, *asked.decades) : begins_at_zero ? 0 : least;
  // Of values that are all the same, or none.
  if (!(scale.max > scale.min)) {
    const bool is_asked = asked.max.has_value();
    return {is_asked ? scale.max - 1 : scale.min, is_asked ? scale.max : scale.min + 1, false};
  }
  return scale;
}

std::array<std::uint8_t, 3> scale_colour(double place) {
  const double at = std::clamp(place, 0.0, 1.0) * (kViridis.size() - 1);
  const auto below = std::min(static_cast<std::size_t>(at), kViridis.size() - 2);
  const double share = at - static_cast<double>(below);
  std::array<std::uint8_t, 3> colour{};
  for (std::size_t c = 0; c < colour.size(); ++c)
    colour[c] = static_cast<std::uint8_t>(
        std::lround((1 - share) * kViridis[below][c] + share * kViridis[below + 1][c]));
  return colour;
}

}  // namespace fluxel
