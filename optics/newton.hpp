#pragma once

#include <cmath>

namespace fluxel {

/// Where a function that grows from below 0 at `low` to above 0 at `high` is 0: by Newton's way from `start`
/// on, with a bracket, to whose middle steps go that would leave it. Ends where the value is within
/// `close_value` or the bracket within `close`.
template <class Function, class Derivative>
[[nodiscard]] double root_by_newton(const Function& value, const Derivative& derivative, double low,
                                    double high, double start, double close, double close_value) {
  constexpr int kMostSteps = 60;
  double x = start;
  for (int step = 0; step < kMostSteps && high - low > close; ++step) {
    const double at = value(x);
    if (std::abs(at) <= close_value) break;
    (at < 0 ? low : high) = x;
    const double next = x - at / derivative(x);
    x = next > low && next < high ? next : 0.5 * (low + high);
  }
  return x;
}

}  // namespace fluxel
