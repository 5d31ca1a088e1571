#include "method/energy.hpp"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/exponential.hpp>
#include <glm/geometric.hpp>
#include <limits>

namespace fluxel {

EnergyBalance energy_balance(const Unknowns& unknowns, const Radiosity& radiosity,
                             std::span<const SideView> views) {
  EnergyBalance balance;
  Rgb variance(0);
  for (std::size_t i = 0; i < unknowns.size(); ++i) {
    const double A = unknowns.area[i];
    const Rgb power = A * radiosity.B[i];
    const auto escape = static_cast<double>(views[i].escape);
    const auto dark = static_cast<double>(views[i].dark);
    balance.emitted += A * glm::max(unknowns.E[i], Rgb(0));
    balance.absorbed += A * ((Rgb(1) - unknowns.rho[i]) * radiosity.H[i] - glm::min(unknowns.E[i], Rgb(0)));
    balance.received += A * radiosity.H[i];
    balance.escaped += power * escape;
    balance.dark += power * dark;
    variance += power * power * ((escape + dark) * (1 - escape - dark) / kEscapeRays);
  }
  balance.defect = balance.emitted - balance.absorbed - balance.escaped - balance.dark;
  balance.sampling_error = glm::sqrt(variance);
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
