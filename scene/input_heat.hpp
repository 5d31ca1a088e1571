#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>

#include "core/thermal.hpp"

namespace fluxel {

/// What a file says of a material's heat, as far as it does.
struct InputHeat {
  std::optional<double> emissivity;
  std::optional<double> temperature;  ///< [K]
  std::optional<double> heat_flux;    ///< [W/m2]

  bool operator==(const InputHeat&) const = default;
};

/// The numbers' names, as statements of an MTL file and as keys of a scene file.
inline constexpr std::array<std::string_view, 3> kHeatNames{"emissivity", "temperature", "heat_flux"};

[[nodiscard]] bool is_heat_name(std::string_view name);

/// Takes the number of that name, one of kHeatNames. Returns what is wrong with it as the end of a sentence,
/// with which nothing was taken, or nothing.
[[nodiscard]] std::optional<std::string> set_heat(std::string_view name, double value, InputHeat& heat);

/// What `above` says replaces what `heat` says; a temperature replaces a flux, and the other way round.
void replace_heat(const InputHeat& above, InputHeat& heat);

/// The surface, or nothing where too little is said: an emissivity (1 where the flux is given) and a
/// temperature or a flux.
[[nodiscard]] std::optional<ThermalSurface> thermal_surface(const InputHeat& heat);

}  // namespace fluxel
