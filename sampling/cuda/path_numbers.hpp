#pragma once

#include <cstddef>

#include "core/portable_sampling.hpp"

namespace fluxel::cuda {

/// Dimensions of a Sobol sequence that are even together.
inline constexpr std::uint32_t kSobolAxes = 4;

/// What each value of a byte of the index, from the lowest on, adds to each axis of a Sobol sequence.
struct SobolDirections {
  std::uint32_t digits[4][256][kSobolAxes];
};

FLUXEL_PORTABLE inline std::uint32_t reversed(std::uint32_t x) {
  x = (x >> 16) | (x << 16);
  x = ((x & 0xFF00FF00u) >> 8) | ((x & 0x00FF00FFu) << 8);
  x = ((x & 0xF0F0F0F0u) >> 4) | ((x & 0x0F0F0F0Fu) << 4);
  x = ((x & 0xCCCCCCCCu) >> 2) | ((x & 0x33333333u) << 2);
  return ((x & 0xAAAAAAAAu) >> 1) | ((x & 0x55555555u) << 1);
}

/// A nested uniform scrambling of the digits, the highest first: a digit is turned by a hash of those above
/// it. In reversed order that is a hash in which bits change higher ones only, as even factors do.
FLUXEL_PORTABLE inline std::uint32_t nested_scramble(std::uint32_t x, std::uint32_t seed) {
  x = reversed(x);
  x += seed;
  x ^= x * 0x6C50B47Cu;
  x ^= x * 0xB82F1E52u;
  x ^= x * 0xC7AFE638u;
  x ^= x * 0x8D22F6E6u;
  return reversed(x);
}

/// In the middle of the finest cell, so that no number is 0 or 1.
FLUXEL_PORTABLE inline double of_digits(std::uint32_t digits) {
  return (static_cast<double>(digits) + 0.5) * 0x1p-32;
}

/// How far a path has come in its numbers: see OwenSobol, which these are.
struct PathNumbers {
  std::uint64_t seed;
  std::uint32_t index, group;

  /// The next group of dimensions, each in (0, 1).
  FLUXEL_PORTABLE void next(const SobolDirections& directions, double (&point)[kSobolAxes]) {
    const std::uint64_t first = random_bits(of_next_group());
    const std::uint64_t second = random_bits(first);
    const std::uint64_t third = random_bits(second);
    const std::uint32_t shuffled = nested_scramble(index, static_cast<std::uint32_t>(first));
    const std::uint32_t seeds[kSobolAxes] = {
        static_cast<std::uint32_t>(second), static_cast<std::uint32_t>(second >> 32),
        static_cast<std::uint32_t>(third), static_cast<std::uint32_t>(third >> 32)};
    std::uint32_t digits[kSobolAxes] = {};
    for (std::uint32_t byte = 0; byte < 4; ++byte) {
      const auto& added = directions.digits[byte][shuffled >> 8 * byte & 0xFFu];
      for (std::uint32_t axis = 0; axis < kSobolAxes; ++axis) digits[axis] ^= added[axis];
    }
    for (std::uint32_t axis = 0; axis < kSobolAxes; ++axis)
      point[axis] = of_digits(nested_scramble(digits[axis], seeds[axis]));
  }

  /// One number in (0, 1) that is even with nothing.
  FLUXEL_PORTABLE double next_random() {
    return of_digits(static_cast<std::uint32_t>(random_bits(random_bits(of_next_group()) + index) >> 32));
  }

  FLUXEL_PORTABLE std::uint64_t of_next_group() { return seed ^ (std::uint64_t{++group} << 40); }
};

}  // namespace fluxel::cuda
