#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

namespace fluxel {

/// A first estimate of the solution, which tells what a pair is worth; an entry an unknown (fronts, then
/// backs).
struct PowerEstimate {
  std::vector<double> B;  ///< [W/m2], summed over the colours
  std::vector<double> H;  ///< likewise, above 0

  /// The larger share that one of two sides has in the other's irradiance, their form factors being F_ij,
  /// F_ji.
  [[nodiscard]] double share(std::size_t i, std::size_t j, double F_ij, double F_ji) const {
    return std::max(F_ij * B[j] / H[i], F_ji * B[i] / H[j]);
  }
};

}  // namespace fluxel
