#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "sampling/primes.hpp"

namespace fluxel {

/// A base of Halton's sequence, and the groups of digits by which an index is reversed.
struct HaltonBase {
  std::uint32_t base = 2;
  std::uint32_t group = 2;              ///< base^k, of the digits of one group
  std::uint32_t groups = 1;             ///< behind the lowest one, of an index of 64 bits
  double of_group = 0.5;                ///< 1 / group
  double of_high = 0.5;                 ///< 1 / group^groups
  std::vector<std::uint16_t> reversed;  ///< of the numbers below `group`: their digits in reversed order

  explicit HaltonBase(std::uint32_t base);

  /// The digits behind the lowest group in reversed order: a whole number below group^groups.
  [[nodiscard]] std::uint64_t reversed_high(std::uint64_t high) const {
    std::uint64_t found = 0;
    for (std::uint32_t k = 0; k < groups; ++k, high /= group) {
      if (high == 0) return found * powers[groups - k];
      found = found * group + reversed[high % group];
    }
    return found;
  }

  /// What reversed high digits add to the reversed lowest group, in [0, 1).
  [[nodiscard]] double behind(std::uint64_t reversed_high) const {
    return static_cast<double>(reversed_high) * of_high;
  }

  /// The radical inverse in [0, 1) of a reversed lowest group and what is behind it.
  [[nodiscard]] double value(std::uint32_t reversed_low, double behind) const {
    constexpr double kBelowOne = 1 - 0x1p-53;
    const double sum = (static_cast<double>(reversed_low) + behind) * of_group;
    return sum < kBelowOne ? sum : kBelowOne;
  }

 private:
  std::vector<std::uint64_t> powers;  // of the group
};

/// Halton's sequence (1960): coordinate j of point i is the radical inverse of i in the j-th prime base, for
/// any i of 64 bits. Coordinates are made one at a time, as many as are asked for. The high digits of an
/// index are kept reversed from one point to the next (Dmitriev 2002, equation 7), the low ones are looked up
/// in a table, for which he used a recurrence. All is in whole numbers, so that nothing drifts.
class HaltonSequence {
 public:
  static constexpr std::size_t kDimensions = 64;

  /// Begins the point of this number.
  void start(std::uint64_t index) {
    index_ = index;
    dimension_ = 0;
  }

  /// The next coordinate, in [0, 1), of kDimensions.
  double next() {
    const HaltonBase& of = bases_[dimension_];
    Known& known = known_[dimension_++];
    const std::uint64_t low = index_ - known.first;
    if (low < of.group) return of.value(of.reversed[low], known.behind);
    const std::uint64_t high = index_ / of.group;
    known.first = high * of.group;
    known.behind = of.behind(of.reversed_high(high));
    return of.value(of.reversed[index_ - known.first], known.behind);
  }

  /// Of all dimensions.
  [[nodiscard]] static const std::vector<HaltonBase>& bases();

 private:
  /// What was last known of a dimension; at first that of index 0.
  struct Known {
    std::uint64_t first = 0;  ///< the lowest index with the same high digits
    double behind = 0;        ///< see HaltonBase
  };

  const HaltonBase* bases_ = bases().data();
  std::uint64_t index_ = 0;
  std::size_t dimension_ = 0;
  std::array<Known, kDimensions> known_{};
};

}  // namespace fluxel
