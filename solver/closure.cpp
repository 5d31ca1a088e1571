#include "solver/closure.hpp"

#include <algorithm>
#include <cmath>

namespace fluxel {

namespace {

/// D F D 1.
std::vector<double> scaled_sums(RadiosityOperator& F, const std::vector<double>& scale) {
  std::vector<double> sums(scale.size());
  F.apply(scale, sums);
  for (std::size_t i = 0; i < scale.size(); ++i) sums[i] *= scale[i];
  return sums;
}

}  // namespace

std::vector<double> row_sums_of(RadiosityOperator& F, std::size_t unknowns) {
  return scaled_sums(F, std::vector<double>(unknowns, 1.0));
}

double cost_of_defect(const Unknowns& unknowns, std::span<const double> row_sums,
                      std::span<const double> wanted) {
  Rgb missed(0), absorbed(0);
  for (std::size_t k = 0; k < row_sums.size(); ++k) {
    if (!(row_sums[k] > 0 && wanted[k] > 0)) continue;
    absorbed += unknowns.area[k] * (Rgb(1) - unknowns.rho[k]);
    missed += unknowns.area[k] * unknowns.rho[k] * (wanted[k] - row_sums[k]);
  }
  double cost = 0;
  for (int c = 0; c < kChannels; ++c)
    if (absorbed[c] > 0) cost = std::max(cost, std::abs(missed[c]) / absorbed[c]);
  return cost;
}

Closure find_closure(RadiosityOperator& F, std::span<const double> wanted, const ClosureGoal& goal) {
  constexpr double kMaxChange = 0.1;
  Closure closure;
  closure.scale.assign(wanted.size(), 1.0);
  while (true) {
    const std::vector<double> sums = scaled_sums(F, closure.scale);
    ++closure.sweeps;
    closure.defect_after = 0;
    for (std::size_t i = 0; i < wanted.size(); ++i)
      if (wanted[i] > 0 && sums[i] > 0)
        closure.defect_after = std::max(closure.defect_after, std::abs(sums[i] - wanted[i]));
    if (closure.sweeps == 1) closure.defect_before = closure.defect_after;
    if (closure.defect_after <= goal.tolerance || closure.sweeps == goal.max_sweeps) break;
    for (std::size_t i = 0; i < wanted.size(); ++i)
      if (wanted[i] > 0 && sums[i] > 0) closure.scale[i] *= std::sqrt(wanted[i] / sums[i]);
  }
  double least = 1, most = 1;
  for (const double scale : closure.scale) {
    least = std::min(least, scale);
    most = std::max(most, scale);
  }
  closure.largest_change = std::max(most * most - 1, 1 - least * least);
  closure.trusted = closure.defect_after <= goal.tolerance && closure.largest_change < kMaxChange;
  return closure;
}

std::vector<double> cap_row_sums(std::span<const double> row_sums, double limit) {
  std::vector<double> scale(row_sums.size());
  std::ranges::transform(row_sums, scale.begin(),
                         [limit](double sum) { return sum > limit ? std::sqrt(limit / sum) : 1.0; });
  return scale;
}

}  // namespace fluxel
