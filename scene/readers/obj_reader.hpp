#pragma once

#include <filesystem>
#include <string>

#include "scene/scene_input.hpp"
#include "scene/text_file.hpp"

namespace fluxel {

/// Reads an OBJ text and the material files that it names (Wavefront, 1990): Kd is the reflectance, Ke the
/// emission, both times the means of their maps (obj_textures.hpp), `g` and `o` both name groups. Coordinates
/// are taken as metres. Faces without a material get `default` with reflectance 0.5 and a note. `file` stands
/// in messages, gives the name, and is where relative names of material files start. Throws InputError with
/// file and line.
[[nodiscard]] SceneInput read_obj_text(const std::filesystem::path& file, const std::string& text,
                                       const TextLookup& lookup);

}  // namespace fluxel
