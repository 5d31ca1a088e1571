#include "solver/estimate_power.hpp"

#include <algorithm>
#include <glm/common.hpp>

#include "solver/reductions.hpp"

namespace fluxel {

namespace {

double sum(const Rgb& of) { return of.r + of.g + of.b; }

/// The irradiance of evenly spread light: of it each reflection keeps the mean reflectance, the sum of a
/// geometric series. Heat that is drawn (E < 0) matters as much as heat that is sent.
Rgb ambient_of(const Ranks& ranks, const Unknowns& unknowns) {
  const Rgb emitted = sum_over<Rgb>(
      ranks, unknowns.size(), [&](std::size_t i) { return unknowns.area[i] * glm::abs(unknowns.source(i)); });
  const Rgb absorbing = sum_over<Rgb>(
      ranks, unknowns.size(), [&](std::size_t i) { return unknowns.area[i] * (Rgb(1) - unknowns.rho[i]); });
  Rgb ambient(0);
  for (int c = 0; c < kChannels; ++c) ambient[c] = absorbing[c] > 0 ? emitted[c] / absorbing[c] : 0;
  return ambient;
}

Rgb leaving(const Unknowns& unknowns, std::size_t i, const Rgb& H) {
  return glm::abs(unknowns.source(i)) + unknowns.rho[i] * H;
}

}  // namespace

PowerEstimate even_power(const Unknowns& unknowns) {
  const Rgb ambient = ambient_of({}, unknowns);
  PowerEstimate power;
  for (std::size_t i = 0; i < unknowns.size(); ++i) power.B.push_back(sum(leaving(unknowns, i, ambient)));
  power.H.assign(unknowns.size(), sum(ambient) > 0 ? sum(ambient) : 1.0);
  return power;
}

PowerEstimate estimate_power(RadiosityOperator& F, const Unknowns& unknowns) {
  const std::size_t size = unknowns.size();
  const Rgb ambient = ambient_of(F.ranks(), unknowns);
  std::vector<Rgb> B(size), H(size);
  for (std::size_t i = 0; i < size; ++i) B[i] = leaving(unknowns, i, ambient);
  F.apply(B, H);
  for (std::size_t i = 0; i < size; ++i) B[i] = leaving(unknowns, i, H[i]);
  return power_of_light(F.ranks(), B, H);
}

PowerEstimate power_of_light(const Ranks& ranks, std::span<const Rgb> B, std::span<const Rgb> H) {
  const std::size_t size = B.size();
  PowerEstimate power{std::vector<double>(size), std::vector<double>(size)};
  double most = 0;
  for (std::size_t i = 0; i < size; ++i) {
    power.B[i] = sum(glm::abs(B[i]));
    power.H[i] = sum(glm::abs(H[i]));
    most = std::max(most, power.H[i]);
  }
  most = largest_over(ranks, most);
  // In the darkest corners nothing needs to be known to the last digit of nothing.
  constexpr double kDarkest = 1e-4;
  for (double& H_i : power.H) H_i = most > 0 ? std::max(H_i, kDarkest * most) : 1.0;
  return power;
}

}  // namespace fluxel
