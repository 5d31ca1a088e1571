#pragma once

#include <vector>

#include "scene/input_camera.hpp"
#include "scene/readers/toml_file.hpp"

namespace fluxel {

/// Reads the table [camera] of a scene file, or tables [[camera]], which have names. Throws InputError with
/// file and line.
[[nodiscard]] std::vector<InputCamera> read_cameras(const TomlFile& toml, const toml::node& node);

}  // namespace fluxel
