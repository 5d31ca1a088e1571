#include "sampling/halton.hpp"

#include <limits>

namespace fluxel {

namespace {

/// Of numbers in the table of a base, which for many bases together stay in a processor's second cache.
constexpr std::uint32_t kLargestGroup = 2048;

std::uint16_t reversed_digits(std::uint32_t number, std::uint32_t base, std::uint32_t group) {
  std::uint32_t found = 0;
  for (; group > 1; group /= base, number /= base) found = found * base + number % base;
  return static_cast<std::uint16_t>(found);
}

}  // namespace

HaltonBase::HaltonBase(std::uint32_t of) : base(of), group(of) {
  while (group * base <= kLargestGroup) group *= base;
  for (std::uint32_t number = 0; number < group; ++number)
    reversed.push_back(reversed_digits(number, base, group));
  const std::uint64_t largest_high = std::numeric_limits<std::uint64_t>::max() / group;
  powers = {1};
  while (powers.back() <= largest_high) powers.push_back(powers.back() * group);
  groups = static_cast<std::uint32_t>(powers.size()) - 1;
  of_group = 1.0 / group;
  of_high = 1.0 / static_cast<double>(powers.back());
}

const std::vector<HaltonBase>& HaltonSequence::bases() {
  static const std::vector<HaltonBase> kBases = [] {
    constexpr auto kPrimes = first_primes<kDimensions>();
    return std::vector<HaltonBase>(kPrimes.begin(), kPrimes.end());
  }();
  return kBases;
}

}  // namespace fluxel
