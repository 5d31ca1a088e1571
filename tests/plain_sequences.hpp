#pragma once

#include <cstddef>
#include <cstdint>

#include "sampling/halton.hpp"
#include "sampling/sobol.hpp"

namespace fluxel::test {

// The sequences as their definitions have them (Dmitriev 2002, equations 5, 6 and 9), to compare with.

/// Reverses the digits of an index one by one.
inline double plain_halton(std::uint64_t index, const HaltonBase& of) {
  const auto reversed_group = [&](std::uint64_t found) {
    for (std::uint32_t power = of.group; power > 1; power /= of.base) {
      found = found * of.base + index % of.base;
      index /= of.base;
    }
    return found;
  };
  const auto low = static_cast<std::uint32_t>(reversed_group(0));
  std::uint64_t high = 0;
  for (std::uint32_t k = 0; k < of.groups; ++k) high = reversed_group(high);
  return of.value(low, of.behind(high));
}

inline double plain_sobol(std::uint64_t index, std::size_t dimension) {
  std::uint64_t digits = 0;
  for (std::size_t digit = 0; digit < SobolSequence::kDigits; ++digit)
    if ((index >> digit & 1) != 0) digits ^= SobolSequence::directions()[dimension][digit];
  return SobolSequence::value(digits);
}

}  // namespace fluxel::test
