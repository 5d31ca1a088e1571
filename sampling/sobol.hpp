#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>

namespace fluxel {

/// Sobol's sequence (1967; LP-tau): each digit of an index, in base 2, turns some digits of a coordinate. Of
/// 64 bits, with the direction numbers of Joe & Kuo (2008), as Boost has them. Coordinates are made one at a
/// time, from the last one that was known of the same dimension, whatever its index (Dmitriev 2002, equation
/// 10): as many operations as digits of the two indices differ.
class SobolSequence {
 public:
  static constexpr std::size_t kDimensions = 64;
  static constexpr std::size_t kDigits = 64;
  /// Of each dimension what each digit of an index turns, the lowest digit first; the highest bit is the
  /// half.
  using Directions = std::array<std::array<std::uint64_t, kDigits>, kDimensions>;

  /// Begins the point of this number.
  void start(std::uint64_t index) {
    index_ = index;
    dimension_ = 0;
  }

  /// The next coordinate, in [0, 1), of kDimensions.
  double next() {
    const std::array<std::uint64_t, kDigits>& of = directions_[dimension_];
    Known& known = known_[dimension_++];
    for (std::uint64_t turned = index_ ^ known.index; turned != 0; turned &= turned - 1)
      known.digits ^= of[static_cast<std::size_t>(std::countr_zero(turned))];
    known.index = index_;
    return value(known.digits);
  }

  /// Of digits, by the first 53 of them.
  [[nodiscard]] static double value(std::uint64_t digits) {
    return static_cast<double>(digits >> 11) * 0x1p-53;
  }

  [[nodiscard]] static const Directions& directions();

 private:
  struct Known {
    std::uint64_t index = 0, digits = 0;
  };

  const Directions& directions_ = directions();
  std::uint64_t index_ = 0;
  std::size_t dimension_ = 0;
  std::array<Known, kDimensions> known_{};
};

}  // namespace fluxel
