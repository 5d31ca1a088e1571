#pragma once

#include "scene/readers/toml_file.hpp"
#include "scene/scene_input.hpp"
#include "scene/text_file.hpp"

namespace fluxel {

/// Reads the tables [[luminaires]] of a scene file, and with `lookup` the photometric files that they name,
/// each once. The scene's units become theirs. Throws InputError with file and line.
void read_luminaires(const TomlFile& toml, const toml::node& node, const TextLookup& lookup,
                     SceneInput& scene);

}  // namespace fluxel
