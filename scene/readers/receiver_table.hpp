#pragma once

#include "scene/readers/toml_file.hpp"
#include "scene/scene_input.hpp"

namespace fluxel {

/// Reads the tables [[receivers]] of a scene file. Throws InputError with file and line.
void read_receivers(const TomlFile& toml, const toml::node& node, SceneInput& scene);

}  // namespace fluxel
