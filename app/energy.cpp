#include "app/energy.hpp"

#include <algorithm>
#include <cmath>
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

double closure_defect_rms(const Unknowns& unknowns, std::span<const double> row_sums,
                          std::span<const SideView> views) {
  double squares = 0, area = 0;
  for (std::size_t i = 0; i < unknowns.size(); ++i) {
    const double closed = 1 - static_cast<double>(views[i].open) - static_cast<double>(views[i].dark);
    squares += unknowns.area[i] * (row_sums[i] - closed) * (row_sums[i] - closed);
    area += unknowns.area[i];
  }
  return area > 0 ? std::sqrt(squares / area) : 0;
}

bool is_closed(std::span<const SideView> views) {
  return std::ranges::all_of(views, [](const SideView& view) { return view.open == 0; });
}

}  // namespace fluxel
