#include "solver/estimate_power.hpp"

#include <algorithm>
#include <glm/common.hpp>

namespace fluxel {

PowerEstimate estimate_power(RadiosityOperator& F, const Unknowns& unknowns) {
  const std::size_t size = unknowns.size();
  // Heat that is drawn (E < 0) matters as much as heat that is sent.
  // Of evenly spread light each reflection keeps the mean reflectance: the sum of a geometric series.
  Rgb emitted(0), absorbing(0);
  for (std::size_t i = 0; i < size; ++i) {
    emitted += unknowns.area[i] * glm::abs(unknowns.E[i]);
    absorbing += unknowns.area[i] * (Rgb(1) - unknowns.rho[i]);
  }
  Rgb ambient(0);
  for (int c = 0; c < kChannels; ++c) ambient[c] = absorbing[c] > 0 ? emitted[c] / absorbing[c] : 0;

  std::vector<Rgb> B(size), H(size);
  for (std::size_t i = 0; i < size; ++i) B[i] = glm::abs(unknowns.E[i]) + unknowns.rho[i] * ambient;
  F.apply(B, H);
  PowerEstimate power{std::vector<double>(size), std::vector<double>(size)};
  double most = 0;
  for (std::size_t i = 0; i < size; ++i) {
    const Rgb after = glm::abs(unknowns.E[i]) + unknowns.rho[i] * H[i];
    power.B[i] = after.r + after.g + after.b;
    power.H[i] = H[i].r + H[i].g + H[i].b;
    most = std::max(most, power.H[i]);
  }
  // In the darkest corners nothing needs to be known to the last digit of nothing.
  constexpr double kDarkest = 1e-4;
  for (double& H_i : power.H) H_i = most > 0 ? std::max(H_i, kDarkest * most) : 1.0;
  return power;
}

}  // namespace fluxel
