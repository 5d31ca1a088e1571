#include "solver/closure.hpp"

#include <algorithm>
#include <cmath>

#include "solver/reductions.hpp"

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

double cost_of_defect(const Ranks& ranks, const Unknowns& unknowns, std::span<const double> row_sums,
                      std::span<const double> wanted) {
  const auto sum_of_rows = [&](const auto& term) {
    return sum_over<Rgb>(ranks, row_sums.size(),
                         [&](std::size_t k) { return row_sums[k] > 0 && wanted[k] > 0 ? term(k) : Rgb(0); });
  };
  const Rgb absorbed =
      sum_of_rows([&](std::size_t k) { return unknowns.area[k] * (Rgb(1) - unknowns.rho[k]); });
  const Rgb missed = sum_of_rows(
      [&](std::size_t k) { return unknowns.area[k] * unknowns.rho[k] * (wanted[k] - row_sums[k]); });
  double cost = 0;
  for (int c = 0; c < kChannels; ++c)
    if (absorbed[c] > 0) cost = std::max(cost, std::abs(missed[c]) / absorbed[c]);
  return cost;
}

double closure_defect_rms(const Ranks& ranks, std::span<const double> area, std::span<const double> row_sums,
                          std::span<const SideView> views) {
  const double squares = sum_over<double>(ranks, area.size(), [&](std::size_t i) {
    const double closed = 1 - static_cast<double>(views[i].escape) - static_cast<double>(views[i].dark);
    return area[i] * (row_sums[i] - closed) * (row_sums[i] - closed);
  });
  const double sum = sum_over<double>(ranks, area.size(), [&](std::size_t i) { return area[i]; });
  return sum > 0 ? std::sqrt(squares / sum) : 0;
}

std::vector<double> wanted_row_sums(const Ranks& ranks, std::span<const double> row_sums,
                                    std::span<const SideView> views) {
  const bool complete = !is_any(ranks, std::ranges::any_of(views, [](const SideView& view) {
                                  return view.escape != 0 || view.dark != 0;
                                }));
  std::vector<double> wanted(row_sums.size(), 0.0);
  for (std::size_t i = 0; i < wanted.size(); ++i) {
    if (row_sums[i] <= 0) continue;
    const double lost = static_cast<double>(views[i].escape) + static_cast<double>(views[i].dark);
    // Of n rays none may be lost though some would be: Laplace's estimate (k + 1) / (n + 2) knows.
    const double likely = (lost * kEscapeRays + 1) / (kEscapeRays + 2);
    const double uncertainty = complete ? 0 : 4 * std::sqrt(likely * (1 - likely) / kEscapeRays);
    wanted[i] = std::clamp(row_sums[i], std::max(0.0, 1 - lost - uncertainty), 1 - lost + uncertainty);
  }
  return wanted;
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
    closure.defect_after = largest_over(F.ranks(), closure.defect_after);
    if (closure.sweeps == 1) closure.defect_before = closure.defect_after;
    if (closure.defect_after <= goal.tolerance || closure.sweeps == goal.max_sweeps) break;
    for (std::size_t i = 0; i < wanted.size(); ++i)
      if (wanted[i] > 0 && sums[i] > 0) closure.scale[i] *= std::sqrt(wanted[i] / sums[i]);
  }
  for (const double scale : closure.scale)
    closure.largest_change = std::max(closure.largest_change, std::abs(scale * scale - 1));
  closure.largest_change = largest_over(F.ranks(), closure.largest_change);
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
