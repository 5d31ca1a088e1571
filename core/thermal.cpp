#include "core/thermal.hpp"

#include <cmath>

namespace fluxel {

namespace {

double black_exitance_at(double temperature) {
  const double squared = temperature * temperature;
  return kStefanBoltzmann * squared * squared;
}

}  // namespace

double own_exitance(const ThermalSurface& surface) {
  return surface.temperature ? surface.emissivity * black_exitance_at(*surface.temperature)
                             : surface.heat_flux;
}

double reflectance(const ThermalSurface& surface) { return surface.temperature ? 1 - surface.emissivity : 1; }

double black_exitance(const ThermalSurface& surface, double H) {
  return surface.temperature ? black_exitance_at(*surface.temperature)
                             : H + surface.heat_flux / surface.emissivity;
}

double temperature_of(double black_exitance) {
  return std::sqrt(std::sqrt(black_exitance / kStefanBoltzmann));
}

}  // namespace fluxel
