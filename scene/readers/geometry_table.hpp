#pragma once

#include "scene/readers/toml_file.hpp"
#include "scene/scene_input.hpp"

namespace fluxel {

/// Reads where a table [[geometry]] of a scene file places its file: mirror, then scale, then rotate, then
/// metres_per_unit, then translate. File and material are left to the caller. Throws InputError with file and
/// line, also for unknown keys.
[[nodiscard]] InputGeometry read_placing(const TomlFile& toml, const toml::table& table);

}  // namespace fluxel
