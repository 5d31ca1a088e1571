#pragma once

#include <array>
#include <cstddef>

#include "visibility/cuda/scene_arrays.hpp"

namespace fluxel::cuda::checks {

inline constexpr std::size_t kKindsOfWork = 5;

/// What a pair takes, on average over tiles from all parts of the matrix.
struct WorkOfPair {
  std::array<double, kKindsOfWork> times{};  ///< by Work
  /// Products, sums and comparisons: read off the code, an estimate, in which tests go on to their ends.
  double single_operations = 0, double_operations = 0;
  /// [bytes] that come from the device's memory or go there at least: of its share of the result.
  double bytes = 0;
};

/// Counted while the host makes so many tiles.
[[nodiscard]] WorkOfPair count_work(const SceneArrays& arrays, std::size_t tiles, unsigned threads);

}  // namespace fluxel::cuda::checks
