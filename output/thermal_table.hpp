#pragma once

#include <filesystem>
#include <span>
#include <string>

#include "method/thermal.hpp"

namespace fluxel {

/// Writes the rows as CSV, temperatures in `unit`, and whether the run has reached what it was asked for;
/// throws InputError where it cannot.
void write_thermal(const std::filesystem::path& file, std::span<const ThermalRow> rows, TemperatureUnit unit,
                   bool reached);

/// The rows as lines for people, with a heading; at most kThermalLines of them.
[[nodiscard]] std::string thermal_text(std::span<const ThermalRow> rows, TemperatureUnit unit);

inline constexpr std::size_t kThermalLines = 20;

}  // namespace fluxel
