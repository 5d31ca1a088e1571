#include "formfactor/view_factor_table.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace fluxel {

std::vector<SurfaceViewFactor> view_factors_of(std::span<const SurfaceExchange> exchanges,
                                               std::span<const double> areas) {
  // Of a row first come those of exchanges with earlier surfaces, which are sorted by them.
  std::vector<std::size_t> next(areas.size() + 1, 0);
  for (const SurfaceExchange& of : exchanges) {
    ++next[of.from + 1];
    if (of.from != of.to) ++next[of.to + 1];
  }
  std::partial_sum(next.begin(), next.end(), next.begin());
  std::vector<SurfaceViewFactor> factors(next.back());
  for (const auto& [from, to, exchange] : exchanges) {
    const double error = exchange.total_error();
    // Every pair of a surface's own faces sends both ways inside it.
    const double times = from == to ? 2 : 1;
    factors[next[from]++] = {from, to, times * exchange.G / areas[from], times * error / areas[from]};
    if (from != to) factors[next[to]++] = {to, from, exchange.G / areas[to], error / areas[to]};
  }
  return factors;
}

ViewFactorChecks check_view_factors(std::span<const SurfaceViewFactor> factors,
                                    std::span<const double> areas) {
  std::vector<double> sums(areas.size(), 0.0);
  // Rows come in order, so that those of a column are met in its own row's order.
  std::vector<std::size_t> next(areas.size() + 1, 0);
  for (const SurfaceViewFactor& f : factors) ++next[f.from + 1];
  std::partial_sum(next.begin(), next.end(), next.begin());
  ViewFactorChecks checks;
  for (const SurfaceViewFactor& f : factors) {
    sums[f.from] += f.value;
    checks.max_error = std::max(checks.max_error, f.error);
    const SurfaceViewFactor& back = factors[next[f.to]++];
    const double there = areas[f.from] * f.value, here = areas[f.to] * back.value;
    checks.reciprocity = std::max(checks.reciprocity, std::abs(there - here) / std::max(there, here));
  }
  double area = 0, seen = 0, least = std::numeric_limits<double>::infinity();
  for (std::size_t surface = 0; surface < areas.size(); ++surface) {
    if (areas[surface] == 0) continue;
    if (sums[surface] == 0) {
      ++checks.blind;
      continue;
    }
    least = std::min(least, sums[surface]);
    checks.max_row_sum = std::max(checks.max_row_sum, sums[surface]);
    seen += areas[surface] * sums[surface];
    area += areas[surface];
  }
  if (area > 0) {
    checks.min_row_sum = least;
    checks.mean_row_sum = seen / area;
  }
  return checks;
}

}  // namespace fluxel
