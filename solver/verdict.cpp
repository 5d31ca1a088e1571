#include "solver/verdict.hpp"

#include <algorithm>
#include <limits>

namespace fluxel {

namespace {

constexpr double kUnbounded = std::numeric_limits<double>::infinity();

/// x over the mean; of a colour without light 0.
template <class Value>
Value relative(const Value& x, const Value& mean) {
  return by_channel(
      [](double of, double to) {
        if (of == 0) return 0.0;
        return to > 0 ? of / to : kUnbounded;
      },
      x, mean);
}

template <class Value>
Value largest_of(std::span<const Value> values) {
  // What is not a number is beyond all numbers.
  const auto larger = [](double a, double b) { return std::isnan(b) ? kUnbounded : std::max(a, b); };
  Value largest(0);
  for (const Value& value : values) largest = by_channel(larger, largest, glm::abs(value));
  return largest;
}

}  // namespace

template <class Value>
Verdict<Value> judge(const LinearSystem<Value>& system, const RowSums& row_sums, const StopRule& stop,
                     std::span<const Value> B, std::span<const Value> change, ChangeKind kind) {
  const Value mean = system.area_mean(B);
  Verdict<Value> verdict{Value(kUnbounded), Value(kUnbounded)};
  const Value largest_change = largest_over(system.F.ranks(), largest_of(change));
  verdict.largest_change = largest_channel(largest_change);
  verdict.relative_change = largest_channel(relative(largest_change, mean));
  if (stop.discretisation != nullptr)
    verdict.discretisation = relative(stop.discretisation->estimate(B), mean);
  if (!row_sums.weights || !std::isfinite(verdict.relative_change)) return verdict;
  const ErrorBound<Value> of_change = error_bound(row_sums, system, change, kind);
  const ErrorBound<Value> of_rounding = rounding_bound(row_sums, system, B);
  verdict.largest = relative<Value>(of_change.largest + of_rounding.largest, mean);
  verdict.mean_square = relative<Value>(of_change.mean_square + of_rounding.mean_square, mean);
  verdict.of_rounding = relative(of_rounding.largest, mean);
  return verdict;
}

template Verdict<double> judge(const LinearSystem<double>&, const RowSums&, const StopRule&,
                               std::span<const double>, std::span<const double>, ChangeKind);
template Verdict<Rgb> judge(const LinearSystem<Rgb>&, const RowSums&, const StopRule&, std::span<const Rgb>,
                            std::span<const Rgb>, ChangeKind);

}  // namespace fluxel
