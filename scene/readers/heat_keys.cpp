#include "scene/readers/heat_keys.hpp"

#include <fmt/format.h>

#include <optional>
#include <string_view>
#include <vector>

namespace fluxel {

namespace {

/// Of [[T, eps], ...].
Emissivity emissivity_table(const TomlFile& toml, const toml::array& rows, const std::string& key,
                            TemperatureUnit unit) {
  std::vector<EmissivityPoint> points;
  for (const toml::node& row : rows) {
    if (!row.is_array() || row.as_array()->size() != 2)
      throw toml.error(row.source(), key + " must be a number, or pairs [temperature, emissivity]",
                       fmt::format("as [[300, 0.2], [900, 0.4]], temperatures in {}", name_of(unit)));
    const toml::array& pair = *row.as_array();
    points.push_back(
        {kelvin_of(toml.number(pair[0], key + ": a temperature"), unit), toml.number(pair[1], key)});
  }
  if (points.empty()) throw toml.error(rows.source(), key + " is an empty list");
  return Emissivity(std::move(points));
}

}  // namespace

InputHeat read_heat(const TomlFile& toml, const toml::table& table, const std::string& where,
                    TemperatureUnit unit) {
  InputHeat heat;
  for (const std::string_view name : kHeatNames) {
    const toml::node* const value = table.get(name);
    if (value == nullptr) continue;
    const std::string key = fmt::format("{} {}", where, name);
    const bool is_table = name == "emissivity" && value->is_array();
    const std::optional<std::string> fault =
        is_table ? set_emissivity(emissivity_table(toml, *value->as_array(), key, unit), unit, heat)
                 : set_heat(name, toml.number(*value, key), unit, heat);
    if (fault) throw toml.error(value->source(), fmt::format("{} is {}", key, *fault));
  }
  return heat;
}

}  // namespace fluxel
