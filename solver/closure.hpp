#pragma once

#include <span>
#include <vector>

#include "formfactor/escape_fraction.hpp"
#include "solver/radiosity_operator.hpp"
#include "solver/unknowns.hpp"

namespace fluxel {

// Vectors are this rank's part of them, and all ranks of F call together.

/// sum_j F_ij, an entry an unknown.
[[nodiscard]] std::vector<double> row_sums_of(RadiosityOperator& F, std::size_t unknowns);

/// About how far off the mean radiosity is, relative, in the worst colour, because row sums are not what is
/// `wanted` (as find_closure has it): the power that is lost between the surfaces over what they absorb.
[[nodiscard]] double cost_of_defect(const Ranks& ranks, const Unknowns& unknowns,
                                    std::span<const double> row_sums, std::span<const double> wanted);

/// Area-weighted root mean square of row sum - (1 - escape - dark).
[[nodiscard]] double closure_defect_rms(const Ranks& ranks, std::span<const double> area,
                                        std::span<const double> row_sums, std::span<const SideView> views);

/// What the row sums of F should be: 1 - escape - dark. Where every ray of every side ends on an unknown side
/// that is 1 exactly; else a row sum within four standard errors of what the rays
/// say stays what it is. 0 for an empty row.
[[nodiscard]] std::vector<double> wanted_row_sums(const Ranks& ranks, std::span<const double> row_sums,
                                                  std::span<const SideView> views);

/// A diagonal D for D F D, and how it came about.
struct Closure {
  std::vector<double> scale;
  double defect_before = 0;   ///< largest |row sum - wanted|
  double defect_after = 0;    ///< likewise of D F D
  double largest_change = 0;  ///< of an entry, |D_i D_j - 1| at most
  int sweeps = 0;             ///< applications of F
  bool trusted = true;        ///< false: see find_closure
};

/// When the sums are near enough.
struct ClosureGoal {
  double tolerance = 1e-7;  ///< of any row sum
  int max_sweeps = 100;
};

/// Scales the symmetric G, row and column alike, until the row sums of F are `wanted` (1 minus what leaves
/// the scene; 0 leaves a row alone, and so does an empty row): iterative scaling of a symmetric matrix
/// (Sinkhorn 1964), damped by the square root as symmetry wants. Reciprocity is kept, as it would not be if
/// every row were divided by its sum. Not to be trusted where an entry changes by a tenth or more, or where
/// the goal is not reached: then form factors are missing or wrong, and scaling hides that.
[[nodiscard]] Closure find_closure(RadiosityOperator& F, std::span<const double> wanted,
                                   const ClosureGoal& goal = {});

/// No row of a form-factor matrix can exceed 1. D_i = 1 / sqrt(max(1, row sum)) keeps the spectral radius of
/// D F D at or below 1, so that no reflectance below 1 can make the light grow: D F D is similar to D D F,
/// whose rows sum to at most 1. Where all sums are at most 1 it changes nothing. A larger `limit` in place of
/// 1 cuts off less of what is right in the mean.
[[nodiscard]] std::vector<double> cap_row_sums(std::span<const double> row_sums, double limit = 1);

}  // namespace fluxel
