#pragma once

#include <string>

#include "core/choices.hpp"
#include "solver/error_bound.hpp"

namespace fluxel {

/// A solver and a sentence that says why.
struct SolverChoice {
  Solver solver = Solver::jacobi;
  std::string reason;
};

/// What Solver::automatic means for a system: conjugate gradients where it is known to be positive definite.
[[nodiscard]] SolverChoice choose_solver(const RowSums& row_sums);

}  // namespace fluxel
