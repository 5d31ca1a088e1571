#pragma once

#include "solver/iterate.hpp"
#include "solver/linear_system.hpp"

namespace fluxel {

/// How good a radiosity is, and whether that is good enough. Errors are bounds relative to the area-mean of
/// B, infinite where none is known; a colour without light has none.
template <class Value>
struct Verdict {
  Value largest{0}, mean_square{0};
  Value discretisation{0};      ///< likewise, where StopRule asks for it
  double largest_change = 0;    ///< of all colours [W/m2]
  double relative_change = 0;   ///< the same, over each colour's mean
  bool rounding_rules = false;  ///< more iterations would not lower the bounds by much

  /// Whether the channel has come to where StopRule wants it.
  [[nodiscard]] bool is_enough(const StopRule& stop, int c) const {
    if (stop.discretisation == nullptr) return channel(largest, c) <= stop.tolerance;
    return channel(mean_square, c) <= stop.share * channel(discretisation, c) ||
           channel(largest, c) <= kFinestTolerance;
  }
  [[nodiscard]] bool is_enough(const StopRule& stop) const {
    for (int c = 0; c < kChannelsOf<Value>; ++c)
      if (!is_enough(stop, c)) return false;
    return true;
  }
};

template <class Value>
[[nodiscard]] Verdict<Value> judge(const LinearSystem<Value>& system, const RowSums& row_sums,
                                   const StopRule& stop, std::span<const Value> B,
                                   std::span<const Value> change, ChangeKind kind);

}  // namespace fluxel
