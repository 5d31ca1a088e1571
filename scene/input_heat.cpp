#include "scene/input_heat.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace fluxel {

namespace {

constexpr double kMinEmissivity = 1e-6;  // of a perfect mirror no temperature could be told
constexpr double kMaxTemperature = 1e5;  // [K]
constexpr double kMaxHeatFlux = 1e15;    // [W/m2], as for Ke
constexpr double kMaxConvection = 1e9;   // [W/(m2 K)], so that its flux is no larger

bool is_temperature(std::string_view name) { return name == "temperature" || name == "air_temperature"; }

/// In kelvin, stated in `unit`.
std::optional<std::string> fault_of_temperature(double kelvin, TemperatureUnit unit) {
  if (kelvin < 0) return fmt::format("below {:g} {}", in_unit(0, unit), name_of(unit));
  if (kelvin > kMaxTemperature)
    return fmt::format("too large: at most {:.8g} {}", in_unit(kMaxTemperature, unit), name_of(unit));
  return std::nullopt;
}

std::optional<std::string> fault_of_emissivity(double value) {
  if (value >= kMinEmissivity && value <= 1) return std::nullopt;
  return "outside 1e-6..1";
}

/// What is wrong with the value alone, a temperature being in kelvin.
std::optional<std::string> fault_of(std::string_view name, double value, TemperatureUnit unit) {
  if (name == "emissivity") return fault_of_emissivity(value);
  if (is_temperature(name)) return fault_of_temperature(value, unit);
  if (name == "convection_coefficient" && value < 0) return "negative";
  if (std::abs(value) > (name == "heat_flux" ? kMaxHeatFlux : kMaxConvection)) return "too large";
  return std::nullopt;
}

/// Of a surface whose temperature is not known.
bool has_heat_supply(const InputHeat& heat) {
  return heat.heat_flux || heat.convection_coefficient || heat.air_temperature;
}

std::optional<double>& number_of(std::string_view name, InputHeat& heat) {
  if (name == "temperature") return heat.temperature;
  if (name == "heat_flux") return heat.heat_flux;
  return name == "air_temperature" ? heat.air_temperature : heat.convection_coefficient;
}

}  // namespace

bool is_heat_name(std::string_view name) { return std::ranges::find(kHeatNames, name) != kHeatNames.end(); }

std::optional<std::string> set_heat(std::string_view name, double value, TemperatureUnit unit,
                                    InputHeat& heat) {
  if (is_temperature(name)) value = kelvin_of(value, unit);
  if (std::optional<std::string> fault = fault_of(name, value, unit)) return fault;
  if (name == "emissivity") return set_emissivity(value, unit, heat);
  std::optional<double>& target = number_of(name, heat);
  if (target) return "given twice";
  if (name == "temperature" ? has_heat_supply(heat) : heat.temperature.has_value())
    return heat.heat_flux || name == "heat_flux"
               ? "one too many: a surface has either a temperature or a heat_flux"
               : "one too many: a surface has either a temperature or convection, which it follows from";
  target = value;
  return std::nullopt;
}

std::optional<std::string> set_emissivity(Emissivity emissivity, TemperatureUnit unit, InputHeat& heat) {
  if (heat.emissivity) return "given twice";
  for (const EmissivityPoint& point : emissivity.points) {
    if (std::optional<std::string> fault = fault_of_emissivity(point.emissivity)) return fault;
    if (std::optional<std::string> fault = fault_of_temperature(point.temperature, unit))
      return "given for a temperature that is " + *fault;
  }
  const bool rises = std::ranges::adjacent_find(emissivity.points, std::ranges::greater_equal(),
                                                &EmissivityPoint::temperature) == emissivity.points.end();
  if (!rises) return "given for temperatures that do not rise from each to the next";
  heat.emissivity = std::move(emissivity);
  return std::nullopt;
}

void replace_heat(const InputHeat& above, InputHeat& heat) {
  if (above.emissivity) heat.emissivity = above.emissivity;
  if (above.temperature) {
    heat = {.emissivity = heat.emissivity, .temperature = above.temperature};
    return;
  }
  if (!has_heat_supply(above)) return;
  heat.temperature.reset();
  if (above.heat_flux) heat.heat_flux = above.heat_flux;
  if (above.convection_coefficient) heat.convection_coefficient = above.convection_coefficient;
  if (above.air_temperature) heat.air_temperature = above.air_temperature;
}

std::string missing_heat(const InputHeat& heat) {
  const bool has_air = heat.convection_coefficient || heat.air_temperature;
  if (!heat.temperature && !has_air && !heat.heat_flux) return "temperature and no heat_flux";
  if (heat.air_temperature && !heat.convection_coefficient)
    return "convection_coefficient to the air of its air_temperature";
  if (has_air && !heat.air_temperature) return "air_temperature to its convection_coefficient";
  if (!heat.emissivity && (heat.temperature || has_air)) return "emissivity";
  return {};
}

ThermalSurface thermal_surface(const InputHeat& heat) {
  return {.emissivity = heat.emissivity.value_or(Emissivity(1)),
          .temperature = heat.temperature,
          .heat_flux = heat.heat_flux.value_or(0),
          .convection_coefficient = heat.convection_coefficient.value_or(0),
          .air_temperature = heat.air_temperature.value_or(0)};
}

}  // namespace fluxel
