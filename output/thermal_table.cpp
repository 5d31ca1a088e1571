#include "output/thermal_table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/file.hpp"
#include "output/csv.hpp"

namespace fluxel {

namespace {

const char* side_name(const ThermalRow& row) { return row.back ? "back" : "front"; }

/// Empty where there is none.
std::string temperature_text(const ThermalRow& row, TemperatureUnit unit) {
  return std::isfinite(row.temperature) ? fmt::format("{:.9g}", in_unit(row.temperature, unit)) : "";
}

}  // namespace

void write_thermal(const std::filesystem::path& file, std::span<const ThermalRow> rows, TemperatureUnit unit,
                   bool reached) {
  fmt::memory_buffer text;
  fmt::format_to(std::back_inserter(text),
                 "group,side,area_m2,temperature_{},emissivity,emitted_W,absorbed_W,net_W,error_W,"
                 "convected_W,reached\n",
                 symbol_of(unit));
  for (const ThermalRow& row : rows)
    fmt::format_to(std::back_inserter(text),
                   "{},{},{:.12g},{},{:.9g},{:.12g},{:.12g},{:.12g},{:.2g},{:.12g},{}\n",
                   csv_field(row.group), side_name(row), row.area, temperature_text(row, unit),
                   row.emissivity, row.emitted, row.absorbed, row.net, row.error, row.convected, reached);
  write_bytes_atomically(file, fmt::to_string(text));
}

std::string thermal_text(std::span<const ThermalRow> rows, TemperatureUnit unit) {
  const std::size_t shown = std::min(rows.size(), kThermalLines);
  std::size_t width = 5;
  for (const ThermalRow& row : rows.first(shown))
    width = std::max(width, std::min<std::size_t>(row.group.size(), 32));
  std::string text = fmt::format("{:{}}  {:5}  {:>10}  {:>8}  {:>12}  {:>8}", "group", width, "side",
                                 "area m2", symbol_of(unit), "net W", "error W");
  for (const ThermalRow& row : rows.first(shown))
    text += fmt::format(
        "\n{:{}.32}  {:5}  {:>10.5g}  {:>8}  {:>12.6g}  {:>8.2g}", row.group, width, side_name(row), row.area,
        std::isfinite(row.temperature) ? fmt::format("{:.2f}", in_unit(row.temperature, unit)) : "none",
        row.net, row.error);
  if (shown < rows.size()) text += fmt::format("\n... and {} more rows in thermal.csv", rows.size() - shown);
  return text;
}

}  // namespace fluxel
