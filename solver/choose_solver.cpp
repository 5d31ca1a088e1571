#include "solver/choose_solver.hpp"

#include <fmt/format.h>

#include <cmath>

namespace fluxel {

SolverChoice choose_solver(const RowSums& row_sums) {
  if (!row_sums.weights)
    return {Solver::jacobi,
            fmt::format(
                "the reflectance times the row sums of the form factors (largest {:.4g}) amplifies, so that "
                "conjugate gradients may break down",
                row_sums.largest)};
  // Of the symmetric form: eigenvalues from 1 - mu to 1 + mu (Saad, Iterative Methods for Sparse Linear
  // Systems, 2003, eq. 6.128).
  const double mu = row_sums.weights->contraction;
  const double root = std::sqrt((1 + mu) / (1 - mu));
  return {Solver::conjugate_gradients,
          fmt::format(
              "the spectral radius is at most {:.4g}: an iteration leaves at most {:.3g} of the error, one "
              "of Jacobi's method up to {:.3g}",
              mu, (root - 1) / (root + 1), mu)};
}

}  // namespace fluxel
