#pragma once

#include <cstdint>

namespace fluxel {

/// What GPUs had to do with rays or paths.
struct VerifiedCounts {
  std::uint64_t made = 0;       ///< by them
  std::uint64_t verified = 0;   ///< of those, that a processor has made again
  std::uint64_t differing = 0;  ///< of those, by more than rounding
};

/// Whether more differ than `share` of what was verified, and where that is little more than a few.
[[nodiscard]] inline bool differs_too_often(const VerifiedCounts& counts, double share) {
  constexpr double kAlwaysAllowed = 8;
  return static_cast<double>(counts.differing) >
         kAlwaysAllowed + share * static_cast<double>(counts.verified);
}

}  // namespace fluxel
