#pragma once

#include <vector>

#include "solver/channels.hpp"
#include "solver/radiosity_operator.hpp"
#include "solver/unknowns.hpp"

namespace fluxel {

/// B = E + rho F B in one channel or three. F must outlive this.
template <class Value>
struct LinearSystem {
  RadiosityOperator& F;
  std::vector<Value> E, rho;
  std::vector<double> area;  ///< [m2], 0: no unknown
  std::size_t elements = 0;  ///< in scenes with two sides half the unknowns

  [[nodiscard]] std::size_t size() const { return E.size(); }

  /// Into `residual` E + rho H - B, with H = F B.
  void residual_of(std::span<const Value> B, std::span<const Value> H, std::span<Value> residual) const {
    for (std::size_t i = 0; i < size(); ++i) residual[i] = E[i] + rho[i] * H[i] - B[i];
  }
};

/// The system in the unknowns' own three channels, or in the first alone where the scene is grey.
template <class Value>
[[nodiscard]] LinearSystem<Value> make_system(RadiosityOperator& F, const Unknowns& unknowns) {
  LinearSystem<Value> system{F, {}, {}, unknowns.area, unknowns.elements};
  if constexpr (kChannelsOf<Value> == kChannels) {
    system.E = unknowns.E;
    system.rho = unknowns.rho;
  } else {
    for (const Rgb& E : unknowns.E) system.E.push_back(E.r);
    for (const Rgb& rho : unknowns.rho) system.rho.push_back(rho.r);
  }
  return system;
}

}  // namespace fluxel
