#pragma once

#include <array>
#include <cstdint>

#include "sampling/cuda/path_numbers.hpp"

namespace fluxel {

/// Of the sequence that OwenSobol scrambles.
[[nodiscard]] const cuda::SobolDirections& sobol_directions();

/// Numbers for one path: a Sobol sequence (1967) with its digits scrambled by Owen's nested permutations
/// (1995), made by hashing (Laine & Karras 2011; Burley 2020). Each point is uniform in the unit cube, so
/// that means are unbiased; points of one seed fill the cube evenly, any number of them; sequences of
/// different seeds err independently. Dimensions come in groups of four, and groups are shuffled against each
/// other, so that only the dimensions of one group are even together.
class OwenSobol {
 public:
  static constexpr std::size_t kAxes = cuda::kSobolAxes;

  /// Point `index` of the sequence of `seed`.
  OwenSobol(std::uint64_t seed, std::uint32_t index) : numbers_{seed, index, 0} {}

  /// The next group of dimensions, each in (0, 1).
  std::array<double, kAxes> next();

  /// One number in (0, 1) that is even with nothing.
  double next_random() { return numbers_.next_random(); }

  /// How far the path has come, for a device.
  [[nodiscard]] const cuda::PathNumbers& state() const { return numbers_; }

 private:
  cuda::PathNumbers numbers_;
};

}  // namespace fluxel
