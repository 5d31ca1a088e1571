#pragma once

#include "scene/input_camera.hpp"
#include "scene/readers/toml_file.hpp"

namespace fluxel {

/// Reads the table [camera] of a scene file. Throws InputError with file and line.
[[nodiscard]] InputCamera read_camera(const TomlFile& toml, const toml::node& node);

}  // namespace fluxel
