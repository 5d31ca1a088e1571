#pragma once

#include <cstddef>
#include <cstdint>

#include "visibility/cuda/device_tracer.hpp"

namespace fluxel::cuda::checks {

/// As in the project's other benchmarks, pairs are those of the whole matrix of N^2, of which the upper
/// triangle is made.
struct Speed {
  std::size_t tiles = 0, traced = 0;
  std::uint64_t facing = 0;  ///< pairs of sides that face each other in the traced tiles
  double seconds = 0;        ///< of the host's clock
  DeviceSeconds device;
  double pairs_per_second = 0;
};

/// Tiles of a launch, and of a call: several launches, so that copies can overlap with work.
inline constexpr std::size_t kTilesOfLaunch = 4096, kTilesOfStrip = 4 * kTilesOfLaunch;

/// The whole matrix of so many elements, or what is done of it in so many seconds: strips of consecutive
/// tiles from all parts of it. Times of kernel and copies are clear of each other in strips of one launch
/// alone.
[[nodiscard]] Speed speed_of_device(const SceneArrays& arrays, std::size_t elements, DeviceTracer& tracer,
                                    double seconds, std::size_t tiles_of_strip = kTilesOfStrip);

/// The same of single tiles by the kernel's code on one core of the host, which is not how the program
/// computes there.
[[nodiscard]] Speed speed_of_host(const SceneArrays& arrays, std::size_t elements, double seconds);

}  // namespace fluxel::cuda::checks
