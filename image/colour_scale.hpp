#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "core/choices.hpp"

namespace fluxel {

/// Which colour of a false-colour picture a value has.
struct ColourScale {
  double min = 0, max = 1;
  bool logarithmic = false;

  /// Of the value between the two ends, 0 to 1; values beyond them have the ends' places.
  [[nodiscard]] double place(double value) const;
  /// Round values from end to end: steps of 1, 2 or 5 times a power of ten, some eight of them.
  [[nodiscard]] std::vector<double> marks() const;
};

/// Where a linear scale begins.
enum class ScaleStart { zero, least };

/// As it is asked for; by itself it ends at the largest of the values, and a linear one begins at 0 or at the
/// least of them. What is not a number does not count.
[[nodiscard]] ColourScale choose_scale(std::span<const double> values, const FalseColourScale& asked,
                                       ScaleStart start = ScaleStart::zero);

/// sRGB of a place: viridis (Smith & van der Walt 2015), even to the eye, also to those who do not tell red
/// from green, and in grey.
[[nodiscard]] std::array<std::uint8_t, 3> scale_colour(double place);

/// Round values from `min` to `max` in about so many steps.
[[nodiscard]] std::vector<double> round_values(double min, double max, int steps);

}  // namespace fluxel
