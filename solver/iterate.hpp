#pragma once

#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/choices.hpp"
#include "solver/discretisation_error.hpp"
#include "solver/error_bound.hpp"
#include "solver/radiosity_operator.hpp"
#include "solver/unknowns.hpp"

namespace fluxel {

/// When to stop. Every colour has to come there.
struct StopRule {
  double tolerance = 1e-3;  ///< of max |B - B*| over the area-mean of B
  int max_iterations = 1000;
  /// Where it is set and known it takes the tolerance's place: the area-weighted root mean square of B - B*
  /// is brought to `share` of that estimate, but not below kFinestTolerance.
  const DiscretisationError* discretisation = nullptr;
  double share = 0.1;
  /// What the user may do where the reflectance times the row sums amplifies; ends a cause of failure.
  std::string_view against_growth = "use lower reflectances";
};

/// Of max |B - B*| over the area-mean of B: form factors are no better, so that going on is waste.
inline constexpr double kFinestTolerance = 1e-4;

/// The solution of B = E + rho F B, this rank's part of it, and how good it is. Bounds are relative to the
/// area-mean of B.
struct Radiosity {
  std::vector<Rgb> B;  ///< [W/m2], an entry an unknown of this rank
  std::vector<Rgb> H;  ///< irradiance F B [W/m2]
  Solver solver = Solver::jacobi;
  int channels = kChannels;  ///< 1: the scene is grey, and was solved in one
  int iterations = 0;
  double residual = 0;       ///< max |E + rho H - B|, the largest over the colours
  double error_bound = 0;    ///< of max |B - B*|, the largest over the colours; infinite where none is known
  Rgb largest_bound{0};      ///< the same of each colour
  Rgb mean_square_bound{0};  ///< area-weighted, of each colour
  std::optional<Rgb> discretisation;  ///< its estimate, where a share of it was the tolerance
  double tolerance = 0;               ///< StopRule's, in force where the former is not known
  bool converged = false;
  std::string cause;  ///< why not converged, and what to do
};

/// Where a solve stands after an iteration.
struct IterationState {
  int iteration;
  double error_bound;    ///< as in Radiosity
  double error, target;  ///< the bound of the colour that has furthest to go, and what it has to come to
};

/// B = E + rho F B, and what is known of the row sums of F, as all ranks of F have it. All that it refers to
/// outlives the solution.
struct RadiositySystem {
  RadiosityOperator& F;
  const Unknowns& unknowns;
  const RowSums& row_sums;
};

/// Called after every iteration.
using IterationObserver = std::function<void(const IterationState&)>;

/// Whether all three colours of E and rho are the same everywhere, on all ranks.
[[nodiscard]] bool is_grey(const Ranks& ranks, const Unknowns& unknowns);

/// Solves from `start` (an entry an unknown; none: from B = E), stopped by the bound of the true error (not
/// by the step, which understates it by rho / (1 - rho)), to which the operator's rounding belongs. A
/// tolerance that rounding does not allow ends with the best that it allows. Grey scenes are solved in one
/// channel. By all ranks of F together. Never throws for divergence: the result says so. `solver` is not
/// Solver::automatic.
[[nodiscard]] Radiosity solve_radiosity(Solver solver, const RadiositySystem& system, const StopRule& stop,
                                        const IterationObserver& observer, std::span<const Rgb> start = {});

}  // namespace fluxel
