#pragma once

#include <cstdint>

namespace fluxel {

/// Bits of two numbers in turns (Morton 1966): what is near on this curve is near in the plane, and every
/// fourth part of it is a lattice.
[[nodiscard]] constexpr std::uint64_t morton(std::uint32_t x, std::uint32_t y) {
  std::uint64_t code = 0;
  for (std::uint32_t bit = 0; bit < 32; ++bit)
    code |= std::uint64_t{(x >> bit) & 1u} << (2 * bit) | std::uint64_t{(y >> bit) & 1u} << (2 * bit + 1);
  return code;
}

}  // namespace fluxel
