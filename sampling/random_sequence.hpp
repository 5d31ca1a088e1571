#pragma once

#include <cstdint>

#include "core/portable_sampling.hpp"

namespace fluxel {

/// Points whose coordinates look random: a hash of the seed, the index and the number of the coordinate
/// (counter-based: Salmon et al. 2011), so that each is there without those before.
class RandomSequence {
 public:
  explicit RandomSequence(std::uint64_t seed = 0) : seed_(random_bits(seed)) {}

  /// Begins the point of this number.
  void start(std::uint64_t index) {
    state_ = random_bits(seed_ ^ index);
    dimension_ = 0;
  }

  /// The next coordinate, in [0, 1).
  double next() { return static_cast<double>(random_bits(state_ + dimension_++) >> 11) * 0x1p-53; }

 private:
  std::uint64_t seed_, state_ = 0, dimension_ = 0;
};

}  // namespace fluxel
