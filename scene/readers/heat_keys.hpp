#pragma once

#include <string>

#include "scene/input_heat.hpp"
#include "scene/readers/toml_file.hpp"

namespace fluxel {

/// What a table [materials.NAME] of a scene file, which errors call `where`, says of heat; temperatures are
/// in `unit`. Throws InputError with file and line.
[[nodiscard]] InputHeat read_heat(const TomlFile& toml, const toml::table& table, const std::string& where,
                                  TemperatureUnit unit);

}  // namespace fluxel
