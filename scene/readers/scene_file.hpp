#pragma once

#include <filesystem>
#include <string>

#include "scene/scene_input.hpp"
#include "scene/text_file.hpp"

namespace fluxel {

/// Reads the text of a scene file (TOML 1.0): tables `geometry` (files of any known format, with scale and
/// shift), `materials` (overrides by name), `luminaires`, `receivers`, `camera` (one, or several
/// with names), and `options` (handed on as texts).
/// Materials of several geometry files are one where name and values agree. `file` stands in messages and is
/// where relative names start. Throws InputError with file and line; for an unknown key or material with the
/// known ones.
[[nodiscard]] SceneInput read_scene_text(const std::filesystem::path& file, const std::string& text,
                                         const TextLookup& lookup);

}  // namespace fluxel
