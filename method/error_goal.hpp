#pragma once

#include <cstdint>

#include "method/problem.hpp"

namespace fluxel {

/// What the solution is refined to.
struct ErrorGoal {
  double target = 0;  ///< of the discretisation error; 0: `block_error` is what counts
  double block_error = 0;
  std::uint64_t bytes = 0;  ///< that a rank's tree and links may take
  double points = 0;        ///< gathers at single points that take as long as the picture in the end
};

/// Collective, for a picture of so many points. What each rank finds of its memory is its own; where to end
/// all must agree.
[[nodiscard]] ErrorGoal goal_of(const Problem& problem, double points);

}  // namespace fluxel
