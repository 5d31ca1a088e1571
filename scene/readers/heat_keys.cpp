#include "scene/readers/heat_keys.hpp"

#include <fmt/format.h>

#include <optional>
#include <string_view>

namespace fluxel {

InputHeat read_heat(const TomlFile& toml, const toml::table& table, const std::string& where,
                    TemperatureUnit unit) {
  InputHeat heat;
  for (const std::string_view name : kHeatNames) {
    const toml::node* const value = table.get(name);
    if (value == nullptr) continue;
    const std::string key = fmt::format("{} {}", where, name);
    const std::optional<std::string> fault = set_heat(name, toml.number(*value, key), unit, heat);
    if (fault) throw toml.error(value->source(), fmt::format("{} is {}", key, *fault));
  }
  return heat;
}

}  // namespace fluxel
