#pragma once

#include <cstdint>
#include <optional>
#include <vector>

namespace fluxel {

/// One refinement and the solution on it.
struct HierarchyRound {
  double block_error = 0;  ///< see RefinementGoal
  std::uint64_t blocks = 0;
  std::size_t nodes = 0, leaves = 0;
  int iterations = 0;
  std::optional<double> change;  ///< of the radiosity since the round before, root mean square over the mean
  std::optional<double> discretisation;  ///< the error that it lets expect
  double refine_seconds = 0, solve_seconds = 0;
};

/// Estimated errors of the result, root mean square over the mean.
struct HierarchyErrors {
  std::optional<double> discretisation;  ///< of nodes and blocks; none after a single round
  double visibility = 0;                 ///< of the rays that the picture's points ask
  double iteration = 0;                  ///< a bound
};

/// What a hierarchical run has made and chosen.
struct HierarchyFacts {
  std::vector<HierarchyRound> rounds;
  HierarchyErrors errors;
  double ray_error = 0;     ///< of GatherGoal, as it was chosen
  double tolerance = 0;     ///< of the solver
  bool reached = true;      ///< the target, where there is one
  bool fits = true;         ///< in the memory that was given
  std::uint64_t bytes = 0;  ///< of the largest rank's tree and blocks
  std::uint64_t pairs = 0;  ///< of nodes that were looked at, by all ranks
  std::uint64_t shafts = 0, contours = 0, rays = 0, gather_rays = 0;
};

}  // namespace fluxel
