#include "solver/error_bound.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace fluxel {

namespace {

/// Below this, v > 0 could be the rounding of single-precision row sums.
constexpr double kMinMargin = 1e-5;

/// Above this, a tighter bound would save fewer iterations than the sweeps for it cost.
constexpr double kGoodMargin = 0.1;

/// A sweep costs about as much as an iteration, so its bound must be worth one.
constexpr double kGoodProgress = 0.6;

/// Sweeps between two looks at the growth.
constexpr int kPatience = 10;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// rho F w with the largest reflectance of each unknown; F w is left in `F_w`.
std::vector<double> damped(RadiosityOperator& F, const Unknowns& unknowns, const std::vector<double>& w,
                           std::vector<double>& F_w) {
  F.apply(w, F_w);
  std::vector<double> result(unknowns.size());
  for (std::size_t i = 0; i < result.size(); ++i) result[i] = largest_channel(unknowns.rho[i]) * F_w[i];
  return result;
}

/// The norm of s = sqrt(A / rho) d, over the root of the area, times what the error of B is at most over that
/// of u.
template <class Value>
Value root_mean_square(const LinearSystem<Value>& system, std::span<const Value> change) {
  const auto square = [](double d, double rho) { return rho > 0 ? d * d / rho : d == 0 ? 0 : kInfinity; };
  const Value sum = sum_over<Value>(system.F.ranks(), change.size(), [&](std::size_t i) {
    return system.area[i] > 0 ? system.area[i] * by_channel(square, change[i], system.rho[i]) : Value(0);
  });
  // B - B* = sqrt(rho / A) (u - u*).
  return system.total_area > 0 ? glm::sqrt(system.largest_rho * sum / system.total_area) : Value(0);
}

/// No mean square is above the largest.
template <class Value>
ErrorBound<Value> at_most_the_largest(const ErrorBound<Value>& bound) {
  const auto least = [](double a, double b) { return b <= a ? b : a; };
  return {bound.largest, by_channel(least, bound.largest, bound.mean_square)};
}

}  // namespace

RowSums find_error_weights(RadiosityOperator& F, const Unknowns& unknowns, double rounding, int max_sweeps) {
  RowSums found;
  found.rounding = rounding;
  std::vector<double> w(unknowns.size(), 1.0), v(unknowns.size()), F_w(unknowns.size());
  std::vector<double> rho_F_w = damped(F, unknowns, w, F_w);
  found.sums = F_w;
  for (std::size_t i = 0; i < w.size(); ++i) {
    found.largest = std::max(found.largest, found.sums[i]);
    if (rho_F_w[i] >= 1) found.amplifying.push_back(i);
  }
  found.largest = largest_over(F.ranks(), found.largest);
  double best = kInfinity, norm_before = kInfinity;
  for (found.sweeps = 1; found.sweeps <= max_sweeps; ++found.sweeps) {
    std::array<double, 4> most{0, 0, 0, -kInfinity};
    auto& [contraction, largest_w, largest_w_less_v, largest_negative_v] = most;
    for (std::size_t i = 0; i < w.size(); ++i) {
      v[i] = w[i] - (1 + rounding) * rho_F_w[i];
      contraction = std::max(contraction, (1 + rounding) * rho_F_w[i] / w[i]);
      largest_w = std::max(largest_w, w[i]);
      largest_w_less_v = std::max(largest_w_less_v, w[i] - v[i]);
      largest_negative_v = std::max(largest_negative_v, -v[i]);
    }
    F.ranks().max(most);
    const double least = -largest_negative_v;
    if (least > kMinMargin) {
      const double factor = largest_w / least;
      const bool good_progress = factor < kGoodProgress * best;
      if (factor < best) {
        best = factor;
        found.weights = ErrorWeights{w, v, contraction, largest_w, largest_w_less_v};
      }
      if (least >= kGoodMargin || !good_progress) return found;
    }
    // 1 - least is the norm of (rho F)^k; where it still grows after many sweeps the spectral radius is
    // above 1.
    if (found.sweeps % kPatience == 0) {
      if (1 - least > norm_before) return found;
      norm_before = 1 - least;
    }
    for (std::size_t i = 0; i < w.size(); ++i) w[i] = 1 + rho_F_w[i];
    rho_F_w = damped(F, unknowns, w, F_w);
  }
  return found;
}

template <class Value>
ErrorBound<Value> error_bound(const RowSums& row_sums, const LinearSystem<Value>& system,
                              std::span<const Value> change, ChangeKind kind) {
  const ErrorWeights& weights = *row_sums.weights;
  const bool step = kind == ChangeKind::step;
  Value most(0);
  for (std::size_t i = 0; i < change.size(); ++i) most = glm::max(most, glm::abs(change[i]) / weights.v[i]);
  most = largest_over(system.F.ranks(), most);
  const double reach = step ? weights.largest_w_less_v : weights.largest_w;
  const double of_norm = (step ? weights.contraction : 1) / (1 - weights.contraction);
  return at_most_the_largest<Value>({most * reach, root_mean_square(system, change) * of_norm});
}

template <class Value>
ErrorBound<Value> rounding_bound(const RowSums& row_sums, const LinearSystem<Value>& system,
                                 std::span<const Value> B) {
  std::vector<Value> rounded(B.size());
  for (std::size_t i = 0; i < B.size(); ++i) rounded[i] = row_sums.rounding * glm::abs(B[i] - system.E[i]);
  return error_bound<Value>(row_sums, system, rounded, ChangeKind::residual);
}

template ErrorBound<double> error_bound(const RowSums&, const LinearSystem<double>&, std::span<const double>,
                                        ChangeKind);
template ErrorBound<Rgb> error_bound(const RowSums&, const LinearSystem<Rgb>&, std::span<const Rgb>,
                                     ChangeKind);
template ErrorBound<double> rounding_bound(const RowSums&, const LinearSystem<double>&,
                                           std::span<const double>);
template ErrorBound<Rgb> rounding_bound(const RowSums&, const LinearSystem<Rgb>&, std::span<const Rgb>);

}  // namespace fluxel
