#pragma once

#include <vector>

#include "solver/channels.hpp"
#include "solver/radiosity_operator.hpp"
#include "solver/reductions.hpp"
#include "solver/unknowns.hpp"

namespace fluxel {

/// B = E + rho F B in one channel or three, E being what sides send of themselves and of luminaires, this
/// rank's part of it. F must outlive this.
template <class Value>
struct LinearSystem {
  RadiosityOperator& F;
  std::vector<Value> E, rho;
  std::vector<double> area;  ///< [m2], 0: no unknown
  std::size_t elements = 0;  ///< in scenes with two sides half the unknowns
  double total_area = 0;     ///< of the unknowns of all ranks [m2]
  Value largest_rho{0};      ///< of the same

  [[nodiscard]] std::size_t size() const { return E.size(); }

  /// sum A_i x_i / sum A_i over the unknowns of all ranks.
  [[nodiscard]] Value area_mean(std::span<const Value> x) const {
    const Value sum = sum_over<Value>(F.ranks(), size(), [&](std::size_t i) { return area[i] * x[i]; });
    return total_area > 0 ? sum / total_area : Value(0);
  }

  /// Into `residual` E + rho H - B, with H = F B.
  void residual_of(std::span<const Value> B, std::span<const Value> H, std::span<Value> residual) const {
    for (std::size_t i = 0; i < size(); ++i) residual[i] = E[i] + rho[i] * H[i] - B[i];
  }
};

/// The system in the unknowns' own three channels, or in the first alone where the scene is grey. By all
/// ranks of F together.
template <class Value>
[[nodiscard]] LinearSystem<Value> make_system(RadiosityOperator& F, const Unknowns& unknowns) {
  LinearSystem<Value> system{F, {}, {}, unknowns.area, unknowns.elements, 0, Value(0)};
  if constexpr (kChannelsOf<Value> == kChannels) {
    system.E = sources(unknowns);
    system.rho = unknowns.rho;
  } else {
    for (const Rgb& E : sources(unknowns)) system.E.push_back(E.r);
    for (const Rgb& rho : unknowns.rho) system.rho.push_back(rho.r);
  }
  system.total_area =
      sum_over<double>(F.ranks(), system.size(), [&](std::size_t i) { return system.area[i]; });
  for (const Value& rho : system.rho) system.largest_rho = glm::max(system.largest_rho, rho);
  system.largest_rho = largest_over(F.ranks(), system.largest_rho);
  return system;
}

}  // namespace fluxel
