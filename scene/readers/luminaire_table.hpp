#pragma once

#include "scene/readers/toml_file.hpp"
#include "scene/readers/unit_merger.hpp"
#include "scene/scene_input.hpp"
#include "scene/text_file.hpp"

namespace fluxel {

/// Reads the tables [[luminaires]] of a scene file, and with `lookup` the photometric files that they name,
/// each once; `units` brings them to the scene's. Throws InputError with file and line.
void read_luminaires(const TomlFile& toml, const toml::node& node, const TextLookup& lookup,
                     UnitMerger& units, SceneInput& scene);

}  // namespace fluxel
