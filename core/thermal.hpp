#pragma once

#include <optional>
#include <utility>
#include <vector>

namespace fluxel {

/// Stefan-Boltzmann constant [W/(m2 K4)], CODATA 2018 (Tiesinga, Mohr, Newell & Taylor 2021); exact in the SI
/// but for the digits left out.
inline constexpr double kStefanBoltzmann = 5.670374419e-8;

/// What files state temperatures in; within the program all are in kelvin.
enum class TemperatureUnit { kelvin, celsius };

/// 0 degrees Celsius [K]; exact.
inline constexpr double kZeroCelsius = 273.15;

[[nodiscard]] constexpr double kelvin_of(double temperature, TemperatureUnit unit) {
  return unit == TemperatureUnit::celsius ? temperature + kZeroCelsius : temperature;
}
[[nodiscard]] constexpr double in_unit(double kelvin, TemperatureUnit unit) {
  return unit == TemperatureUnit::celsius ? kelvin - kZeroCelsius : kelvin;
}
/// K or C, as tables write it.
[[nodiscard]] constexpr const char* symbol_of(TemperatureUnit unit) {
  return unit == TemperatureUnit::celsius ? "C" : "K";
}
/// As sentences have it.
[[nodiscard]] constexpr const char* name_of(TemperatureUnit unit) {
  return unit == TemperatureUnit::celsius ? "degrees Celsius" : "kelvin";
}

struct EmissivityPoint {
  double temperature = 0;  ///< [K]
  double emissivity = 1;   ///< 0 < eps <= 1

  bool operator==(const EmissivityPoint&) const = default;
};

/// Total hemispherical emissivity by the temperature of the surface: linear between points, constant beyond
/// the first and the last.
struct Emissivity {
  Emissivity(double constant = 1) : points{{0, constant}} {}
  explicit Emissivity(std::vector<EmissivityPoint> of) : points(std::move(of)) {}

  std::vector<EmissivityPoint> points;  ///< at least one; temperatures rise

  [[nodiscard]] bool is_constant() const { return points.size() == 1; }
  /// At a temperature [K].
  [[nodiscard]] double at(double temperature) const;
  /// d eps / d T [1/K] there; at a point that of the piece above it.
  [[nodiscard]] double slope_at(double temperature) const;
  [[nodiscard]] double least() const;

  bool operator==(const Emissivity&) const = default;
};

/// A grey diffuse opaque surface in heat exchange by radiation: the temperature is known, or the heat that
/// the surface gets from behind and from the air.
///
/// The net radiation method (Siegel & Howell, Thermal Radiation Heat Transfer, chapter on enclosures of
/// diffuse-grey surfaces; Modest, Radiative Heat Transfer, chapter 5): with the emissivity eps, which is also
/// the absorptivity (Kirchhoff), a side sends B = eps sigma T^4 + (1 - eps) H and loses q = B - H. Hence
/// * of a given temperature: E = eps sigma T^4 and rho = 1 - eps;
/// * of a given flux: B = q + H, so E = q and rho = 1, whatever the emissivity. Eliminating B gives
///   q = eps (sigma T^4 - H), which the temperature follows from: sigma T^4 = H + q / eps;
/// * with convection the flux is heat_flux + h (T_air - T), and T follows from H by
///   eps (sigma T^4 - H) = heat_flux + h (T_air - T). B is no linear function of H; see linearised.
struct ThermalSurface {
  Emissivity emissivity;
  std::optional<double> temperature;  ///< [K], >= 0; none: it follows from what is below
  double heat_flux = 0;  ///< net, from each side into the enclosure [W/m2]; below 0: drawn out of it
  double convection_coefficient = 0;  ///< h [W/(m2 K)], >= 0; 0 where the temperature is known
  double air_temperature = 0;         ///< of the air that h is to [K]

  /// Whether B = E + rho H has other E and rho for other H.
  [[nodiscard]] bool has_convection() const { return convection_coefficient > 0; }
};

/// E [W/m2] and rho of B = E + rho H.
struct ThermalExchange {
  double E = 0, rho = 0;
};

/// Of a side with convection the tangent to B(H) at H [W/m2], of all others B(H) itself.
///
/// With s the derivative of eps(T) (sigma T^4 - H) + h T by T, dT / dH = eps / s, and the tangent's rho is
/// 1 - h eps / s. For a constant eps that is 1 - eps k / (eps + k), k = h / (4 sigma T^3): the conductances
/// of the surface and of its linearised convection in series. It lies in 0..1, and is held there where a
/// steep table of emissivities would have it elsewhere.
[[nodiscard]] ThermalExchange linearised(const ThermalSurface& surface, double H);

/// An irradiance to begin with where none is known [W/m2]: that of black surroundings at the air's
/// temperature, or at 1 K where that is lower.
[[nodiscard]] double first_irradiance(const ThermalSurface& surface);

/// What is given of the heat of a side [W/m2]: eps sigma T^4, or the flux; without what the air gives.
[[nodiscard]] double own_exitance(const ThermalSurface& surface);

/// sigma T^4 of a side that receives H, both in W/m2; below 0 where more is drawn than a side at 0 K takes.
[[nodiscard]] double black_exitance(const ThermalSurface& surface, double H);

/// B - H of a side that receives H [W/m2].
[[nodiscard]] double net_flux(const ThermalSurface& surface, double H);

/// At the temperature of a side that receives H [W/m2].
[[nodiscard]] double emissivity_of(const ThermalSurface& surface, double H);

/// [K] of sigma T^4 [W/m2]; not a number below 0.
[[nodiscard]] double temperature_of(double black_exitance);

}  // namespace fluxel
