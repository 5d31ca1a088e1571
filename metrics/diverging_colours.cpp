#include "metrics/diverging_colours.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace fluxel {

namespace {

constexpr int kStops = 11;
constexpr double kRdBu[kStops][3] = {{5, 48, 97},     {33, 102, 172},  {67, 147, 195},  {146, 197, 222},
                                     {209, 229, 240}, {247, 247, 247}, {253, 219, 199}, {244, 165, 130},
                                     {214, 96, 77},   {178, 24, 43},   {103, 0, 31}};

}  // namespace

std::vector<std::uint8_t> diverging_colours(std::span<const double> values, double range) {
  std::vector<std::uint8_t> colours;
  colours.reserve(3 * values.size());
  for (const double value : values) {
    const double place = (std::clamp(value / range, -1.0, 1.0) + 1) / 2 * (kStops - 1);
    const int below = std::min(static_cast<int>(place), kStops - 2);
    for (int c = 0; c < 3; ++c)
      colours.push_back(static_cast<std::uint8_t>(
          std::lround(std::lerp(kRdBu[below][c], kRdBu[below + 1][c], place - below))));
  }
  return colours;
}

}  // namespace fluxel
