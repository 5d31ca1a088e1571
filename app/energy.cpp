#include "app/energy.hpp"

#include <glm/exponential.hpp>

namespace fluxel {

EnergyBalance energy_balance(const Unknowns& unknowns, const Radiosity& radiosity,
                             std::span<const SideView> views) {
  EnergyBalance balance;
  Rgb variance(0);
  for (std::size_t i = 0; i < unknowns.size(); ++i) {
    const double A = unknowns.area[i];
    const Rgb power = A * radiosity.B[i];
    const auto open = static_cast<double>(views[i].open);
    const auto dark = static_cast<double>(views[i].dark);
    balance.emitted += A * unknowns.E[i];
    balance.absorbed += A * (Rgb(1) - unknowns.rho[i]) * radiosity.H[i];
    balance.escaped += power * open;
    balance.dark += power * dark;
    variance += power * power * ((open + dark) * (1 - open - dark) / kOpenRays);
  }
  balance.defect = balance.emitted - balance.absorbed - balance.escaped - balance.dark;
  balance.sampling_error = glm::sqrt(variance);
  return balance;
}

}  // namespace fluxel
