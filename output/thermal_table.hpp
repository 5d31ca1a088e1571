#pragma once

#include <filesystem>
#include <span>
#include <string>

#include "method/thermal.hpp"

namespace fluxel {

/// Writes the rows as CSV, temperatures in `unit`; throws InputError where it cannot.
void write_thermal(const std::filesystem::path& file, std::span<const ThermalRow> rows, TemperatureUnit unit);

/// The rows as lines for people, with a heading; at most kThermalLines of them.
[[nodiscard]] std::string thermal_text(std::span<const ThermalRow> rows, TemperatureUnit unit);

inline constexpr std::size_t kThermalLines = 20;

}  // namespace fluxel
