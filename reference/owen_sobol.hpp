#pragma once

#include <array>
#include <cstdint>

namespace fluxel {

/// Numbers for one path: a Sobol sequence (1967) with its digits scrambled by Owen's nested permutations
/// (1995), made by hashing (Laine & Karras 2011; Burley 2020). Each point is uniform in the unit cube, so
/// that means are unbiased; points of one seed fill the cube evenly, any number of them; sequences of
/// different seeds err independently. Dimensions come in groups of four, and groups are shuffled against each
/// other, so that only the dimensions of one group are even together.
class OwenSobol {
 public:
  static constexpr std::size_t kAxes = 4;

  /// Point `index` of the sequence of `seed`.
  OwenSobol(std::uint64_t seed, std::uint32_t index) : seed_(seed), index_(index) {}

  /// The next group of dimensions, each in (0, 1).
  std::array<double, kAxes> next();

  /// One number in (0, 1) that is even with nothing.
  double next_random();

 private:
  std::uint64_t seed_;
  std::uint32_t index_;
  std::uint32_t group_ = 0;
};

}  // namespace fluxel
