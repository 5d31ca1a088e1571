#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>

namespace fluxel {

/// One refinement and the solution on it.
struct HierarchyRound {
  double block_error = 0;  ///< see RefinementGoal
  std::uint64_t links = 0;
  std::size_t rows = 0;  ///< of rays; 0 where there are links
  std::size_t nodes = 0, leaves = 0;
  int iterations = 0;
  /// Of the radiosity since the round before: root mean square over the mean, of the colour where that is
  /// largest.
  std::optional<double> change;
  std::optional<double> discretisation;  ///< the error that it lets expect
  double refine_seconds = 0, solve_seconds = 0;
};

}  // namespace fluxel
