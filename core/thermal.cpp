#include "core/thermal.hpp"

#include <algorithm>
#include <cmath>

namespace fluxel {

namespace {

double black_exitance_at(double temperature) {
  const double squared = temperature * temperature;
  return kStefanBoltzmann * squared * squared;
}

/// The heat balance of a side whose temperature is not known, and that receives H: what it loses less what it
/// gets, which rises from the side's temperature being too low to its being too high.
class HeatBalance {
 public:
  HeatBalance(const ThermalSurface& surface, double H) : surface_(surface), H_(H) {}

  /// [W/m2] from behind, and from the air were the side at 0 K.
  [[nodiscard]] double supply() const {
    return surface_.heat_flux + surface_.convection_coefficient * surface_.air_temperature;
  }
  [[nodiscard]] double at(double T) const {
    return surface_.emissivity.at(T) * (black_exitance_at(T) - H_) + surface_.convection_coefficient * T -
           supply();
  }
  /// By the temperature [W/(m2 K)].
  [[nodiscard]] double slope_at(double T) const {
    return surface_.emissivity.slope_at(T) * (black_exitance_at(T) - H_) +
           4 * surface_.emissivity.at(T) * kStefanBoltzmann * T * T * T + surface_.convection_coefficient;
  }
  /// Where not even 0 K is low enough.
  [[nodiscard]] bool has_root() const { return at(0) < 0; }

  /// The temperature [K], by Newton's method from above, on which a constant emissivity makes it monotone,
  /// held in a bracket. Needs has_root.
  [[nodiscard]] double root() const {
    double low = 0, high = temperature_of(H_ + std::max(0.0, supply()) / surface_.emissivity.least());
    double T = high;
    for (int step = 0; step < kMostSteps && high - low > kPrecision * high; ++step) {
      const double value = at(T);
      (value > 0 ? high : low) = T;
      const double next = T - value / slope_at(T);
      const bool is_inside = next > low && next < high;
      const double before = T;
      T = is_inside ? next : (low + high) / 2;
      if (is_inside && std::abs(T - before) <= kPrecision * T) break;
    }
    return T;
  }

 private:
  static constexpr int kMostSteps = 200;
  static constexpr double kPrecision = 1e-15;

  const ThermalSurface& surface_;
  double H_;
};

}  // namespace

double Emissivity::at(double temperature) const {
  const auto above = std::ranges::upper_bound(points, temperature, {}, &EmissivityPoint::temperature);
  if (above == points.begin()) return points.front().emissivity;
  if (above == points.end()) return points.back().emissivity;
  return (above - 1)->emissivity + slope_at(temperature) * (temperature - (above - 1)->temperature);
}

double Emissivity::slope_at(double temperature) const {
  const auto above = std::ranges::upper_bound(points, temperature, {}, &EmissivityPoint::temperature);
  if (above == points.begin() || above == points.end()) return 0;
  const EmissivityPoint& below = *(above - 1);
  return (above->emissivity - below.emissivity) / (above->temperature - below.temperature);
}

double Emissivity::least() const {
  return std::ranges::min_element(points, {}, &EmissivityPoint::emissivity)->emissivity;
}

ThermalExchange linearised(const ThermalSurface& surface, double H) {
  if (surface.temperature) return {own_exitance(surface), 1 - surface.emissivity.at(*surface.temperature)};
  if (!surface.has_convection()) return {surface.heat_flux, 1};
  const HeatBalance balance(surface, H);
  // At 0 K, where more is drawn than that takes, a side only reflects.
  if (!balance.has_root()) return {0, 1 - surface.emissivity.at(0)};
  const double h = surface.convection_coefficient;
  const double T = balance.root();
  const double slope = balance.slope_at(T), eps = surface.emissivity.at(T);
  const double absorbed = slope > h * eps ? h * eps / slope : 1;
  return {surface.heat_flux + h * (surface.air_temperature - T) + absorbed * H, 1 - absorbed};
}

double first_irradiance(const ThermalSurface& surface) {
  constexpr double kLeast = 1;  // [K]; at 0 K some sides reflect nothing, and E is 0 with any convection
  return black_exitance_at(std::max(kLeast, surface.air_temperature));
}

double own_exitance(const ThermalSurface& surface) {
  if (!surface.temperature) return surface.heat_flux;
  return surface.emissivity.at(*surface.temperature) * black_exitance_at(*surface.temperature);
}

double black_exitance(const ThermalSurface& surface, double H) {
  if (surface.temperature) return black_exitance_at(*surface.temperature);
  const HeatBalance balance(surface, H);
  const bool is_linear = surface.emissivity.is_constant() && !surface.has_convection();
  if (is_linear || !balance.has_root()) return H + balance.supply() / surface.emissivity.at(0);
  return black_exitance_at(balance.root());
}

double net_flux(const ThermalSurface& surface, double H) {
  const ThermalExchange tangent = linearised(surface, H);
  return tangent.E - (1 - tangent.rho) * H;
}

double emissivity_of(const ThermalSurface& surface, double H) {
  if (surface.emissivity.is_constant()) return surface.emissivity.at(0);
  return surface.emissivity.at(temperature_of(std::max(0.0, black_exitance(surface, H))));
}

double temperature_of(double black_exitance) {
  return std::sqrt(std::sqrt(black_exitance / kStefanBoltzmann));
}

}  // namespace fluxel
