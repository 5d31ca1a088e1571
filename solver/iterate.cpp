#include "solver/iterate.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <limits>

namespace fluxel {

namespace {

/// Of the bound that rounding gives: below it a step counts for nothing.
constexpr double kNegligibleStep = 0.1;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// The largest over the colours of x relative to the mean; colours without light do not count.
double relative_to_mean(const Rgb& x, const Rgb& mean) {
  double largest = 0;
  for (int c = 0; c < kChannels; ++c) {
    if (std::isnan(x[c])) return kInfinity;
    if (x[c] > 0) largest = std::max(largest, mean[c] > 0 ? x[c] / mean[c] : kInfinity);
  }
  return largest;
}

Rgb largest_step(std::span<const Rgb> before, std::span<const Rgb> after) {
  Rgb largest(0);
  for (std::size_t i = 0; i < before.size(); ++i) largest = glm::max(largest, glm::abs(after[i] - before[i]));
  return largest;
}

/// E + rho F B into `after`; H is F B.
void jacobi_step(RadiosityOperator& F, const Unknowns& unknowns, std::span<const Rgb> B, std::vector<Rgb>& H,
                 std::vector<Rgb>& after) {
  F.apply(B, H);
  for (std::size_t i = 0; i < after.size(); ++i) after[i] = unknowns.E[i] + unknowns.rho[i] * H[i];
}

/// Recognises growth and standstill from the largest steps [W/m2].
class StepHistory {
 public:
  void add(const Rgb& step, double relative_step) {
    last_ = std::max({step.r, step.g, step.b});
    relative_ = relative_step;
    smallest_ = std::min(smallest_, last_);
    // Compared with the last mark, not with the last step, slow progress adds up to some.
    if (last_ < 0.99 * mark_) {
      mark_ = last_;
      since_mark_ = 0;
    } else {
      ++since_mark_;
    }
  }
  [[nodiscard]] bool grows() const { return !std::isfinite(relative_) || last_ > 10 * smallest_; }
  /// Far enough that no rounding explains it.
  [[nodiscard]] bool diverged() const { return !std::isfinite(relative_) || last_ > 1e6 * smallest_; }
  /// Over so many iterations that even a reflectance of 0.9999 would show.
  [[nodiscard]] bool stands_still() const { return since_mark_ >= kPatience && relative_ < 1e-5; }

 private:
  static constexpr int kPatience = 200;

  double smallest_ = kInfinity;
  double last_ = 0;
  double relative_ = 0;
  double mark_ = kInfinity;
  int since_mark_ = 0;
};

constexpr const char* kHelpAgainstGrowth =
    "use --form-factor adaptive or --closure, smaller elements (--max-edge) or lower reflectances";

std::string diverged_cause(const RowSums& row_sums) {
  return fmt::format(
      "the iteration diverges: the largest row sum of the form factors is {:.4g}, and times the "
      "reflectance it amplifies; {}",
      row_sums.largest, kHelpAgainstGrowth);
}

std::string rounding_cause(double error_bound) {
  return fmt::format(
      "the iteration has come to the rounding of single precision, with an error bound of {:.2g}; ask "
      "for a larger --tolerance",
      error_bound);
}

std::string unfinished_cause(const Radiosity& result, const StopRule& stop, const RowSums& row_sums) {
  if (!row_sums.weights)
    return fmt::format(
        "after {} iterations no bound of the error is known, because the reflectance times the row sums "
        "of the form factors (largest {:.4g}) amplifies; {}",
        result.iterations, row_sums.largest, kHelpAgainstGrowth);
  return fmt::format(
      "{} iterations were not enough for --tolerance {:g} (error bound {:.3g}); raise --max-iterations",
      result.iterations, stop.tolerance, result.error_bound);
}

}  // namespace

Radiosity solve_radiosity(Solver solver, RadiosityOperator& F, const Unknowns& unknowns,
                          const RowSums& row_sums, const StopRule& stop, const IterationObserver& observer) {
  Radiosity result;
  result.B = unknowns.E;
  result.H.resize(unknowns.size());
  result.error_bound = kInfinity;
  std::vector<Rgb> after(unknowns.size());
  StepHistory history;

  while (result.iterations < stop.max_iterations) {
    if (solver == Solver::jacobi) {
      jacobi_step(F, unknowns, result.B, result.H, after);
    } else {
      after = result.B;
      F.sweep(unknowns.E, unknowns.rho, after);
    }
    ++result.iterations;
    const Rgb mean = area_mean(unknowns, after);
    const Rgb step = largest_step(result.B, after);
    history.add(step, relative_to_mean(step, mean));
    bool rounding_rules = false;
    if (row_sums.weights) {
      const Rgb of_step = step_error_bound(*row_sums.weights, result.B, after);
      const Rgb of_rounding = rounding_error_bound(row_sums, unknowns.E, after);
      result.error_bound = relative_to_mean(of_step + of_rounding, mean);
      rounding_rules = row_sums.rounding > 0 && relative_to_mean(of_step, mean) <=
                                                    kNegligibleStep * relative_to_mean(of_rounding, mean);
    }
    result.B.swap(after);
    observer(result.iterations, result.error_bound);

    result.converged = result.error_bound <= stop.tolerance;
    if (result.converged) break;
    if (history.diverged()) {
      result.cause = diverged_cause(row_sums);
      break;
    }
    // More iterations would not lower the bound by much.
    if (rounding_rules || history.stands_still()) {
      result.cause = rounding_cause(result.error_bound);
      break;
    }
  }
  if (!result.converged && result.cause.empty()) {
    result.cause = history.grows() ? diverged_cause(row_sums) : unfinished_cause(result, stop, row_sums);
  }

  jacobi_step(F, unknowns, result.B, result.H, after);
  result.residual = relative_to_mean(largest_step(result.B, after), area_mean(unknowns, result.B));
  return result;
}

}  // namespace fluxel
