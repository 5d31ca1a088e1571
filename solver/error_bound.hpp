#pragma once

#include <optional>
#include <span>
#include <vector>

#include "solver/linear_system.hpp"

namespace fluxel {

/// What a bound of the true error stands on: w > 0 with v = (I - rho F) w > 0, rho the largest of the
/// colours. For any residual r of B = E + rho F B, |error_i| <= w_i max_j |r_j| / v_j, because I - rho F is
/// then an M-matrix (Varga, Matrix Iterative Analysis, 1962, theorem 3.10).
struct ErrorWeights {
  std::vector<double> w, v;  ///< an entry an unknown of this rank; what follows is of all ranks
  double contraction = 0;    ///< max (rho F w)_i / w_i: bounds the spectral radius of rho F (Collatz 1942)
  double largest_w = 0, largest_w_less_v = 0;
};

/// Of RowOperator: the difference of F x in single precision from the exact one, over F |x|. Each pair and
/// each sum over a lane's part of a block loses a few units in the last place; the true errors of B on cubes
/// and on random plates, of every rule, were at most a quarter of the bound that this gives.
inline constexpr double kSinglePrecisionRounding = 8 * 0x1p-23;

/// Row sums of F and the rows where rho times the sum reaches 1, and w where one was found.
struct RowSums {
  std::vector<double> sums;             ///< an entry an unknown of this rank
  double largest = 0;                   ///< of all ranks
  std::vector<std::size_t> amplifying;  ///< unknowns of this rank with largest rho * row sum >= 1
  std::optional<ErrorWeights> weights;  ///< none: no bound, and iterations may diverge
  double rounding = 0;                  ///< of the operator, relative
  int sweeps = 0;                       ///< applications of F that were needed
};

/// w = 1 where rho times the row sums stays well below 1, else w from sweeps of w = 1 + rho F w, at most
/// `max_sweeps`, as long as max w / min v, the bound's factor, falls fast. `rounding`: of F.apply and
/// F.sweep, relative to F |x|; v is taken smaller by what it may do.
[[nodiscard]] RowSums find_error_weights(RadiosityOperator& F, const Unknowns& unknowns, double rounding = 0,
                                         int max_sweeps = 100);

/// What a vector of changes d is of the radiosity B whose error is asked for.
enum class ChangeKind {
  residual,  ///< d = E + rho F B - B
  step       ///< B has just become B + d, d being Jacobi's residual or bounded by it: w - v takes w's place
};

/// Bounds of B - B* [W/m2], of each channel: the largest over all unknowns, and the area-weighted root mean
/// square. The second needs A F to be symmetric: with s = sqrt(A / rho) d and mu the contraction, the error
/// in the symmetric form (I - R G R) u is at most |s| / (1 - mu), and mu times that after a step.
template <class Value>
struct ErrorBound {
  Value largest, mean_square;
};

/// Without what the operator's rounding does. Needs row_sums.weights.
template <class Value>
[[nodiscard]] ErrorBound<Value> error_bound(const RowSums& row_sums, const LinearSystem<Value>& system,
                                            std::span<const Value> change, ChangeKind kind);

/// What the operator's rounding may have added to the error of B, however small the change was. An
/// iteration takes E + rho F B + d with |d_i| at most rounding (rho F |B|)_i = rounding |B_i - E_i|, and
/// d acts as a residual does. Needs row_sums.weights.
template <class Value>
[[nodiscard]] ErrorBound<Value> rounding_bound(const RowSums& row_sums, const LinearSystem<Value>& system,
                                               std::span<const Value> B);

}  // namespace fluxel
