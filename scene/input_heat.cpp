#include "scene/input_heat.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace fluxel {

namespace {

constexpr double kMinEmissivity = 1e-6;  // of a perfect mirror no temperature could be told
constexpr double kMaxTemperature = 1e5;  // [K]
constexpr double kMaxHeatFlux = 1e15;    // [W/m2], as for Ke

/// What is wrong with the value alone.
std::optional<std::string> fault_of(std::string_view name, double value) {
  if (name == "emissivity") {
    if (value >= kMinEmissivity && value <= 1) return std::nullopt;
    return "outside 1e-6..1";
  }
  if (name == "temperature") {
    if (value < 0) return "below 0 kelvin";
    if (value > kMaxTemperature) return fmt::format("too large: at most {} kelvin", kMaxTemperature);
    return std::nullopt;
  }
  if (std::abs(value) > kMaxHeatFlux) return "too large";
  return std::nullopt;
}

}  // namespace

bool is_heat_name(std::string_view name) { return std::ranges::find(kHeatNames, name) != kHeatNames.end(); }

std::optional<std::string> set_heat(std::string_view name, double value, InputHeat& heat) {
  if (std::optional<std::string> fault = fault_of(name, value)) return fault;
  std::optional<double>& target = name == "emissivity"    ? heat.emissivity
                                  : name == "temperature" ? heat.temperature
                                                          : heat.heat_flux;
  if (target) return "given twice";
  const bool both = name == "temperature" ? heat.heat_flux.has_value()
                                          : name == "heat_flux" && heat.temperature.has_value();
  if (both) return "one too many: a surface has either a temperature or a heat_flux";
  target = value;
  return std::nullopt;
}

void replace_heat(const InputHeat& above, InputHeat& heat) {
  if (above.emissivity) heat.emissivity = above.emissivity;
  if (!above.temperature && !above.heat_flux) return;
  heat.temperature = above.temperature;
  heat.heat_flux = above.heat_flux;
}

std::optional<ThermalSurface> thermal_surface(const InputHeat& heat) {
  if (heat.heat_flux) return ThermalSurface{heat.emissivity.value_or(1), std::nullopt, *heat.heat_flux};
  if (!heat.emissivity || !heat.temperature) return std::nullopt;
  return ThermalSurface{*heat.emissivity, heat.temperature, 0};
}

}  // namespace fluxel
