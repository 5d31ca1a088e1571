#pragma once

#include <cstdint>
#include <span>

#include "reference/sensors.hpp"

namespace fluxel {

/// Paths of many sensors that share one sequence of numbers: each takes as many of its points as the others,
/// in the order of the sensors. So what is near each other in that order is even together, as is every part
/// of the whole (Ahmed & Wonka 2020), and means over many sensors err less than those of single ones let
/// expect; the error of such a mean is what waves of different seeds differ by.
struct Wave {
  std::uint64_t seed = 0;
  std::uint32_t paths = 1;  ///< of each sensor; with the sensors at most 2^32 in all
};

/// The mean of each sensor's paths, from number `from` on. Returns the rays.
std::uint64_t measure_wave(const Sensors& sensors, const Wave& wave, std::size_t from, std::span<Rgb> means);

}  // namespace fluxel
