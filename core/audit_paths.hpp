#pragma once

#include <cstdint>
#include <vector>

#include "core/rgb.hpp"

namespace fluxel {

/// Paths that have been traced from the places of an audit. What they have found there is true of any
/// solution, whichever has guided them.
struct AuditPaths {
  std::vector<Rgb> sums;      ///< of each place's randomisations, one after another [W/m2]
  std::uint32_t of_each = 0;  ///< of each place and randomisation
  std::uint64_t seed = 1;     ///< of the next wave
  std::uint64_t rays = 0;
  double seconds = 0;  ///< that they have taken
};

}  // namespace fluxel
