#pragma once

#include <optional>
#include <span>
#include <vector>

#include "solver/radiosity_operator.hpp"
#include "solver/unknowns.hpp"

namespace fluxel {

/// What a bound of the true error stands on: w > 0 with v = (I - rho F) w > 0, rho the largest of the
/// colours. For any residual r, |error_i| <= w_i max_j |r_j| / v_j, because I - rho F is then an M-matrix
/// (Varga, Matrix Iterative Analysis, 1962, theorem 3.10). After a step B -> B' = B + d of Jacobi's or
/// Gauss-Seidel's method, d being Jacobi's residual or bounded like it, the error of B' is at most (w_i -
/// v_i) max_j |d_j| / v_j.
struct ErrorWeights {
  std::vector<double> w, v;
};

/// Of RowOperator: the difference of F x in single precision from the exact one, over F |x|. Each pair and
/// each sum over a lane's part of a block loses a few units in the last place; the true errors of B on cubes
/// and on random plates, of every rule, were at most a quarter of the bound that this gives.
inline constexpr double kSinglePrecisionRounding = 8 * 0x1p-23;

/// Row sums of F and the rows where rho times the sum reaches 1, and w where one was found.
struct RowSums {
  std::vector<double> sums;  ///< an entry an unknown
  double largest = 0;
  std::vector<std::size_t> amplifying;  ///< unknowns with largest rho * row sum >= 1
  std::optional<ErrorWeights> weights;  ///< none: no bound, and iterations may diverge
  double rounding = 0;                  ///< of the operator, relative
  int sweeps = 0;                       ///< applications of F that were needed
};

/// w = 1 where rho times the row sums stays well below 1, else w from sweeps of w = 1 + rho F w, at most
/// `max_sweeps`: v = 1 - (rho F)^k 1 grows with them, and the bound with 1/v becomes sharper. `rounding`: of
/// F.apply and F.sweep, relative to F |x|; v is taken smaller by what it may do.
[[nodiscard]] RowSums find_error_weights(RadiosityOperator& F, const Unknowns& unknowns, double rounding = 0,
                                         int max_sweeps = 100);

/// Bound of |B' - B*| for each colour after the step from `before` to `after`, the largest over all unknowns.
[[nodiscard]] Rgb step_error_bound(const ErrorWeights& weights, std::span<const Rgb> before,
                                   std::span<const Rgb> after);

/// What the operator's rounding may have added to the error of `after`, however small the step was. An
/// iteration takes E + rho F x + d with |d_i| at most rounding (rho F |x|)_i = rounding (after_i - E_i), and
/// d acts as a residual does: the error is at most w_i max_j |d_j| / v_j.
[[nodiscard]] Rgb rounding_error_bound(const RowSums& row_sums, std::span<const Rgb> E,
                                       std::span<const Rgb> after);

}  // namespace fluxel
