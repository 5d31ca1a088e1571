#include "method/energy.hpp"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/exponential.hpp>
#include <glm/geometric.hpp>
#include <limits>

namespace fluxel {

EnergyBalance energy_balance(const Unknowns& unknowns, const Radiosity& radiosity,
                             std::span<const SideSample> samples, const LuminaireEscape& luminaires) {
  EnergyBalance balance;
  balance.emitted = luminaires.flux;
  for (std::size_t i = 0; i < unknowns.size(); ++i) {
    const double A = unknowns.area[i];
    balance.emitted += A * glm::max(unknowns.E[i], Rgb(0));
    balance.absorbed += A * ((Rgb(1) - unknowns.rho[i]) * radiosity.H[i] - glm::min(unknowns.E[i], Rgb(0)));
    balance.received += A * radiosity.H[i];
  }
  // Of drawn sides, what each draw says of the whole: its mean square tells of rays and draws alike.
  Rgb of_rays(0), squares(0);
  double draws = 0;
  for (const SideSample& sample : samples) {
    const auto escape = static_cast<double>(sample.view.escape);
    const auto dark = static_cast<double>(sample.view.dark);
    const Rgb power = sample.weight * unknowns.area[sample.unknown] * radiosity.B[sample.unknown];
    const Rgb lost = power * (escape + dark);
    balance.escaped += power * escape;
    balance.dark += power * dark;
    of_rays += power * power * ((escape + dark) * (1 - escape - dark) / kEscapeRays);
    squares += lost * lost / static_cast<double>(sample.draws);
    draws += sample.draws;
  }
  const Rgb whole = balance.escaped + balance.dark;
  balance.escaped += luminaires.escaped;
  balance.dark += luminaires.dark;
  balance.defect = balance.emitted - balance.absorbed - balance.escaped - balance.dark;
  const bool all = std::ranges::all_of(samples, [](const SideSample& sample) { return sample.weight == 1; });
  const Rgb variance = all ? of_rays : glm::max(of_rays, squares - whole * whole / std::max(draws, 1.0));
  balance.sampling_error = glm::sqrt(variance + luminaires.error * luminaires.error);
  return balance;
}

double largest_relative_defect(const EnergyBalance& balance) {
  double largest = 0;
  for (int c = 0; c < kChannels; ++c) {
    if (std::isnan(balance.defect[c]) || std::isnan(balance.emitted[c]))
      return std::numeric_limits<double>::quiet_NaN();
    if (balance.emitted[c] > 0) largest = std::max(largest, std::abs(balance.defect[c]) / balance.emitted[c]);
  }
  return largest;
}

bool is_large_defect(const EnergyBalance& balance) {
  for (int c = 0; c < kChannels; ++c)
    if (std::abs(balance.defect[c]) > 0.1 * balance.emitted[c] + 3 * balance.sampling_error[c]) return true;
  return false;
}

bool nearly_all_escapes(const EnergyBalance& balance) {
  return glm::dot(balance.received, Rgb(1)) < 0.01 * glm::dot(balance.emitted, Rgb(1));
}

}  // namespace fluxel
