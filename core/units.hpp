#pragma once

namespace fluxel {

/// What the quantities of light are: power [W] over the wavelengths of a colour, or luminous flux [lm].
enum class Units { radiometric, photometric };

/// A unit's name, as files and messages write it.
struct UnitNames {
  const char* flux;       ///< of power
  const char* exitance;   ///< of irradiance, exitance and radiosity
  const char* radiance;   ///< of radiance
  const char* intensity;  ///< of radiant intensity
};

[[nodiscard]] constexpr UnitNames unit_names(Units units) {
  return units == Units::photometric ? UnitNames{"lm", "lm/m2", "cd/m2", "cd"}
                                     : UnitNames{"W", "W/m2", "W/(m2 sr)", "W/sr"};
}

/// Lumens of a watt of white light, as Radiance counts them (Ward Larson and Shakespeare 1998): where a scene
/// mixes units and states no other.
inline constexpr double kLuminousEfficacy = 179;  // [lm/W]

}  // namespace fluxel
