#pragma once

#include <cstdint>
#include <random>

namespace fluxel::cuda::checks {

/// The same numbers with every C++ library.
class Chance {
 public:
  double between(double low, double high) {
    return low + (high - low) * (static_cast<double>(bits_() >> 11) * 0x1p-53);
  }

  /// Below `count`.
  std::uint32_t below(std::uint32_t count) { return static_cast<std::uint32_t>(bits_() % count); }

 private:
  std::mt19937_64 bits_{10083};
};

}  // namespace fluxel::cuda::checks
