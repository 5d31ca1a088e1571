#pragma once

#include <filesystem>
#include <string>

#include "scene/scene_input.hpp"
#include "scene/text_file.hpp"

namespace fluxel {

/// Reads glTF 2.0 (Khronos Group 2021), JSON or GLB, told apart by the first bytes: the triangles of the
/// default scene in metres, y up; base colours as reflectances; emission [cd/m2], point lights and spots
/// [cd]; perspective cameras. Groups are nodes by name. What is left out or taken for something else is
/// noted. Names of other files start at the folder of `file` and stay in it. Throws InputError with byte,
/// line or JSON path.
[[nodiscard]] SceneInput read_gltf(const std::filesystem::path& file, const std::string& bytes,
                                   const TextLookup& lookup);

}  // namespace fluxel
