#pragma once

#include <functional>
#include <string>
#include <vector>

#include "core/options.hpp"
#include "solver/error_bound.hpp"
#include "solver/radiosity_operator.hpp"
#include "solver/unknowns.hpp"

namespace fluxel {

/// When to stop.
struct StopRule {
  double tolerance = 1e-3;  ///< of max |B - B*| over the area-mean of B, for each colour
  int max_iterations = 1000;
};

/// The solution of B = E + rho F B and how good it is. Bounds are relative to the area-mean of B.
struct Radiosity {
  std::vector<Rgb> B;  ///< [W/m2], an entry an unknown
  std::vector<Rgb> H;  ///< irradiance F B [W/m2]
  int iterations = 0;
  double residual = 0;     ///< max |E + rho H - B|, the largest over the colours
  double error_bound = 0;  ///< infinite where none is known
  bool converged = false;
  std::string cause;  ///< why not converged, and what to do
};

/// Called after every iteration with its number and the error bound reached.
using IterationObserver = std::function<void(int iteration, double error_bound)>;

/// Jacobi's or Gauss-Seidel's method from B = E, stopped by the bound of the true error (not by the step,
/// which understates it by rho / (1 - rho)), to which the operator's rounding belongs. A tolerance that
/// rounding does not allow ends with the best that it allows. Never throws for divergence: the result says
/// so.
[[nodiscard]] Radiosity solve_radiosity(Solver solver, RadiosityOperator& F, const Unknowns& unknowns,
                                        const RowSums& row_sums, const StopRule& stop,
                                        const IterationObserver& observer);

}  // namespace fluxel
