#include "solver/error_bound.hpp"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <limits>

namespace fluxel {

namespace {

/// Below this, v > 0 could be the rounding of single-precision row sums.
constexpr double kLeastMargin = 1e-5;

/// Above this, a tighter bound would save fewer iterations than the sweeps for it cost.
constexpr double kGoodMargin = 0.1;

/// Sweeps between two looks at the growth.
constexpr int kPatience = 10;

double largest_channel(const Rgb& x) { return std::max({x.r, x.g, x.b}); }

/// rho F w with the largest reflectance of each unknown.
std::vector<double> damped(RadiosityOperator& F, const Unknowns& unknowns, const std::vector<double>& w,
                           std::vector<double>* row_sums = nullptr) {
  // Only one channel is needed; the geometry of a pair, which costs most, is shared by the three anyway.
  std::vector<Rgb> x(unknowns.size()), H(unknowns.size());
  for (std::size_t i = 0; i < x.size(); ++i) x[i] = Rgb(w[i], 0, 0);
  F.apply(x, H);
  std::vector<double> result(unknowns.size());
  for (std::size_t i = 0; i < x.size(); ++i) result[i] = largest_channel(unknowns.rho[i]) * H[i].r;
  if (row_sums != nullptr) std::ranges::transform(H, row_sums->begin(), [](const Rgb& row) { return row.r; });
  return result;
}

}  // namespace

RowSums find_error_weights(RadiosityOperator& F, const Unknowns& unknowns, double rounding, int max_sweeps) {
  RowSums found;
  found.rounding = rounding;
  std::vector<double> w(unknowns.size(), 1.0), v(unknowns.size());
  found.sums.resize(unknowns.size());
  std::vector<double> rho_F_w = damped(F, unknowns, w, &found.sums);
  for (std::size_t i = 0; i < w.size(); ++i) {
    found.largest = std::max(found.largest, found.sums[i]);
    if (rho_F_w[i] >= 1) found.amplifying.push_back(i);
  }
  double norm_before = std::numeric_limits<double>::infinity();
  for (found.sweeps = 1; found.sweeps <= max_sweeps; ++found.sweeps) {
    for (std::size_t i = 0; i < w.size(); ++i) v[i] = w[i] - (1 + rounding) * rho_F_w[i];
    const double least = *std::ranges::min_element(v);
    if (least > kLeastMargin) found.weights = ErrorWeights{w, v};
    if (least >= kGoodMargin) return found;
    // 1 - least is the norm of (rho F)^k; where it still grows after many sweeps the spectral radius is
    // above 1.
    if (found.sweeps % kPatience == 0) {
      if (1 - least > norm_before) return found;
      norm_before = 1 - least;
    }
    for (std::size_t i = 0; i < w.size(); ++i) w[i] = 1 + rho_F_w[i];
    rho_F_w = damped(F, unknowns, w);
  }
  return found;
}

Rgb step_error_bound(const ErrorWeights& weights, std::span<const Rgb> before, std::span<const Rgb> after) {
  Rgb step(0);
  double reach = 0;
  for (std::size_t i = 0; i < before.size(); ++i) {
    step = glm::max(step, glm::abs(after[i] - before[i]) / weights.v[i]);
    reach = std::max(reach, weights.w[i] - weights.v[i]);
  }
  return step * reach;
}

Rgb rounding_error_bound(const RowSums& row_sums, std::span<const Rgb> E, std::span<const Rgb> after) {
  const auto& [w, v] = *row_sums.weights;
  Rgb rounded(0);
  for (std::size_t i = 0; i < after.size(); ++i)
    rounded = glm::max(rounded, glm::abs(after[i] - E[i]) / v[i]);
  return rounded * (row_sums.rounding * *std::ranges::max_element(w));
}

}  // namespace fluxel
