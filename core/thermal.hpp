#pragma once

#include <optional>

namespace fluxel {

/// Stefan-Boltzmann constant [W/(m2 K4)], CODATA 2018 (Tiesinga, Mohr, Newell & Taylor 2021); exact in the SI
/// but for the digits left out.
inline constexpr double kStefanBoltzmann = 5.670374419e-8;

/// A grey diffuse opaque surface in heat exchange by radiation: the temperature is known, or the net flux.
///
/// The net radiation method (Siegel & Howell, Thermal Radiation Heat Transfer, chapter on enclosures of
/// diffuse-grey surfaces; Modest, Radiative Heat Transfer, chapter 5): with the emissivity eps, which is also
/// the absorptivity (Kirchhoff), a side sends B = eps sigma T^4 + (1 - eps) H and loses q = B - H. Hence
/// * of a given temperature: E = eps sigma T^4 and rho = 1 - eps;
/// * of a given flux: B = q + H, so E = q and rho = 1, whatever the emissivity. Eliminating B gives
///   q = eps (sigma T^4 - H), which the temperature follows from: sigma T^4 = H + q / eps.
struct ThermalSurface {
  double emissivity = 1;              ///< 0 < eps <= 1
  std::optional<double> temperature;  ///< [K], >= 0; none: the flux is prescribed
  double heat_flux = 0;  ///< net, from each side into the enclosure [W/m2]; below 0: drawn out of it
};

/// What a side sends by itself, E of B = E + rho H [W/m2]; below 0 where a flux is drawn.
[[nodiscard]] double own_exitance(const ThermalSurface& surface);

/// rho of B = E + rho H.
[[nodiscard]] double reflectance(const ThermalSurface& surface);

/// sigma T^4 of a side that receives H, both in W/m2; below 0 where more is drawn than a side at 0 K takes.
[[nodiscard]] double black_exitance(const ThermalSurface& surface, double H);

/// [K] of sigma T^4 [W/m2]; not a number below 0.
[[nodiscard]] double temperature_of(double black_exitance);

}  // namespace fluxel
