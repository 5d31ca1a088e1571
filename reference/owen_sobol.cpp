#include "reference/owen_sobol.hpp"

#include <boost/random/sobol.hpp>

#include "core/sampling.hpp"

namespace fluxel {

namespace {

constexpr std::size_t kBytes = 4, kValues = 256;

using Digits = std::array<std::uint32_t, OwenSobol::kAxes>;

/// What each value of a byte of the index, from the lowest on, adds to each axis.
using Directions = std::array<std::array<Digits, kValues>, kBytes>;

const Directions& directions() {
  static const Directions kDirections = [] {
    Directions table{};
    for (std::size_t byte = 0; byte < kBytes; ++byte) {
      for (std::size_t digit = 0; digit < 8; ++digit) {
        // Boost's engine runs in the order of Gray's code and leaves out the origin: its point number
        // 2^(digit + 1) - 1 has this digit alone.
        boost::random::sobol engine(OwenSobol::kAxes);
        engine.discard(OwenSobol::kAxes * ((std::uint64_t{2} << (8 * byte + digit)) - 2));
        for (std::uint32_t& axis : table[byte][std::size_t{1} << digit])
          axis = static_cast<std::uint32_t>(engine() >> 32);
      }
      for (std::size_t value = 1; value < kValues; ++value) {
        const std::size_t lowest = value & (~value + 1);
        for (std::size_t axis = 0; value != lowest && axis < OwenSobol::kAxes; ++axis)
          table[byte][value][axis] = table[byte][value ^ lowest][axis] ^ table[byte][lowest][axis];
      }
    }
    return table;
  }();
  return kDirections;
}

std::uint32_t reversed(std::uint32_t x) {
  x = (x >> 16) | (x << 16);
  x = ((x & 0xFF00FF00u) >> 8) | ((x & 0x00FF00FFu) << 8);
  x = ((x & 0xF0F0F0F0u) >> 4) | ((x & 0x0F0F0F0Fu) << 4);
  x = ((x & 0xCCCCCCCCu) >> 2) | ((x & 0x33333333u) << 2);
  return ((x & 0xAAAAAAAAu) >> 1) | ((x & 0x55555555u) << 1);
}

/// A nested uniform scrambling of the digits, the highest first: a digit is turned by a hash of those above
/// it. In reversed order that is a hash in which bits change higher ones only, as even factors do.
std::uint32_t nested_scramble(std::uint32_t x, std::uint32_t seed) {
  x = reversed(x);
  x += seed;
  for (const std::uint32_t factor : {0x6C50B47Cu, 0xB82F1E52u, 0xC7AFE638u, 0x8D22F6E6u}) x ^= x * factor;
  return reversed(x);
}

/// In the middle of the finest cell, so that no number is 0 or 1.
double of_digits(std::uint32_t digits) { return (static_cast<double>(digits) + 0.5) * 0x1p-32; }

}  // namespace

std::array<double, OwenSobol::kAxes> OwenSobol::next() {
  const Directions& table = directions();
  const std::uint64_t first = random_bits(seed_ ^ (std::uint64_t{++group_} << 40));
  const std::uint64_t second = random_bits(first);
  const std::uint64_t third = random_bits(second);
  Digits digits{};
  const std::uint32_t shuffled = nested_scramble(index_, static_cast<std::uint32_t>(first));
  for (std::size_t byte = 0; byte < kBytes; ++byte) {
    const Digits& added = table[byte][(shuffled >> (8 * byte)) & 0xFFu];
    for (std::size_t axis = 0; axis < kAxes; ++axis) digits[axis] ^= added[axis];
  }
  const std::array seeds{static_cast<std::uint32_t>(second), static_cast<std::uint32_t>(second >> 32),
                         static_cast<std::uint32_t>(third), static_cast<std::uint32_t>(third >> 32)};
  std::array<double, kAxes> point;
  for (std::size_t axis = 0; axis < kAxes; ++axis)
    point[axis] = of_digits(nested_scramble(digits[axis], seeds[axis]));
  return point;
}

double OwenSobol::next_random() {
  const std::uint64_t of_group = random_bits(seed_ ^ (std::uint64_t{++group_} << 40));
  return of_digits(static_cast<std::uint32_t>(random_bits(of_group + index_) >> 32));
}

}  // namespace fluxel
