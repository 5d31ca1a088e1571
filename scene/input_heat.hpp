#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>

#include "core/thermal.hpp"

namespace fluxel {

/// What a file says of a material's heat, as far as it does.
struct InputHeat {
  std::optional<Emissivity> emissivity = std::nullopt;
  std::optional<double> temperature = std::nullopt;             ///< [K]
  std::optional<double> heat_flux = std::nullopt;               ///< [W/m2]
  std::optional<double> convection_coefficient = std::nullopt;  ///< [W/(m2 K)]
  std::optional<double> air_temperature = std::nullopt;         ///< [K]

  bool operator==(const InputHeat&) const = default;
};

/// The numbers' names, as statements of an MTL file and as keys of a scene file.
inline constexpr std::array<std::string_view, 5> kHeatNames{"emissivity", "temperature", "heat_flux",
                                                            "convection_coefficient", "air_temperature"};

[[nodiscard]] bool is_heat_name(std::string_view name);

/// Takes the number of that name, one of kHeatNames, a temperature being in `unit`. Returns what is wrong
/// with it as the end of a sentence, with which nothing was taken, or nothing.
[[nodiscard]] std::optional<std::string> set_heat(std::string_view name, double value, TemperatureUnit unit,
                                                  InputHeat& heat);

/// Takes an emissivity whose points [K] are in the file's order, stated in `unit`. Returns as set_heat does.
[[nodiscard]] std::optional<std::string> set_emissivity(Emissivity emissivity, TemperatureUnit unit,
                                                        InputHeat& heat);

/// What `above` says replaces what `heat` says; a temperature replaces a flux and convection, and the other
/// way round.
void replace_heat(const InputHeat& above, InputHeat& heat);

/// What is not said and has to be, as the end of "has ...": an emissivity (1 where no more than the flux is
/// given), and a temperature, a flux, or a convection coefficient with the air's temperature. Empty: nothing.
[[nodiscard]] std::string missing_heat(const InputHeat& heat);

/// The surface, of heat that misses nothing.
[[nodiscard]] ThermalSurface thermal_surface(const InputHeat& heat);

}  // namespace fluxel
