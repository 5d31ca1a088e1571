#pragma once

#include <cmath>
#include <utility>

#include "solver/iterate.hpp"
#include "solver/linear_system.hpp"

namespace fluxel {

/// How good a radiosity is, and whether that is good enough. Errors are bounds relative to the area-mean of
/// B, infinite where none is known; a colour without light has none.
template <class Value>
struct Verdict {
  Value largest{0}, mean_square{0};
  Value of_rounding{0};        ///< what the operator's rounding makes of `largest`
  Value discretisation{0};     ///< likewise, where StopRule asks for it
  double largest_change = 0;   ///< of all colours [W/m2]; infinite where one is not a number
  double relative_change = 0;  ///< the same, over each colour's mean

  /// Whether the channel has come to where StopRule wants it. A share of the discretisation error that
  /// rounding does not allow gives way to the tolerance.
  [[nodiscard]] bool is_enough(const StopRule& stop, int c) const {
    const double bound = channel(largest, c);
    if (!std::isfinite(bound)) return false;
    if (stop.discretisation == nullptr) return bound <= stop.tolerance;
    return channel(mean_square, c) <= stop.share * channel(discretisation, c) || bound <= kFinestTolerance ||
           (is_at_rounding(c) && bound <= stop.tolerance);
  }
  [[nodiscard]] bool is_enough(const StopRule& stop) const {
    for (int c = 0; c < kChannelsOf<Value>; ++c)
      if (!is_enough(stop, c)) return false;
    return true;
  }

  /// The bound that decides of the colour that has furthest to go, relative to what it has to come to, and
  /// that.
  [[nodiscard]] std::pair<double, double> furthest(const StopRule& stop) const {
    std::pair<double, double> result{0, 1};
    for (int c = 0; c < kChannelsOf<Value>; ++c) {
      std::pair<double, double> own{channel(largest, c), stop.tolerance};
      if (stop.discretisation != nullptr) {
        const std::pair<double, double> of_share{channel(mean_square, c),
                                                 stop.share * channel(discretisation, c)};
        own.second = kFinestTolerance;
        if (is_nearer(of_share, own)) own = of_share;
      }
      if (is_nearer(result, own)) result = own;
    }
    return result;
  }

  /// More iterations would not lower the bound of the channel by much.
  [[nodiscard]] bool is_at_rounding(int c) const {
    const double rounding = channel(of_rounding, c);
    return rounding > 0 && channel(largest, c) <= (1 + kNegligibleChange) * rounding;
  }
  /// That holds for every channel that is not good enough.
  [[nodiscard]] bool rounding_rules(const StopRule& stop) const {
    for (int c = 0; c < kChannelsOf<Value>; ++c)
      if (!is_enough(stop, c) && !is_at_rounding(c)) return false;
    return true;
  }

 private:
  static constexpr double kNegligibleChange = 0.1;

  /// Errors over their targets.
  [[nodiscard]] static bool is_nearer(const std::pair<double, double>& a,
                                      const std::pair<double, double>& b) {
    return a.first * b.second < b.first * a.second;
  }
};

template <class Value>
[[nodiscard]] Verdict<Value> judge(const LinearSystem<Value>& system, const RowSums& row_sums,
                                   const StopRule& stop, std::span<const Value> B,
                                   std::span<const Value> change, ChangeKind kind);

}  // namespace fluxel
