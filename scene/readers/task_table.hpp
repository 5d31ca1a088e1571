#pragma once

#include "scene/readers/toml_file.hpp"
#include "scene/scene_input.hpp"

namespace fluxel {

/// Reads [[observers]] and [[tasks]], whose receivers have been read. Throws InputError with file and line.
void read_observers(const TomlFile& toml, const toml::node& node, SceneInput& scene);
void read_tasks(const TomlFile& toml, const toml::node& node, SceneInput& scene);

}  // namespace fluxel
