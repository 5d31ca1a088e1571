#pragma once

#include <filesystem>
#include <string>

#include "scene/scene_input.hpp"
#include "scene/text_file.hpp"

namespace fluxel {

/// Reads a Radiance scene description (Ward, The RADIANCE 5.1 Synthetic Imaging System, section 2). Surfaces
/// become polygons (round_surfaces.hpp) of a group by their identifier, materials diffuse ones with two
/// sides, and lights emit pi times their radiance [W/(m2 sr)]. Commands are never run; these, and what else
/// is left out or taken as something simpler, are noted. Coordinates are taken as metres. Throws InputError
/// with file and line.
[[nodiscard]] SceneInput read_radiance(const std::filesystem::path& file, const std::string& text,
                                       const TextLookup& lookup);

}  // namespace fluxel
