#pragma once

#include <filesystem>
#include <string>

#include "scene/scene_input.hpp"
#include "scene/text_file.hpp"

namespace fluxel {

/// Reads a PLY file (Turk, The PLY Polygon File Format, 1994), as text or binary: `x`, `y`, `z` of `vertex`,
/// taken as metres, and `vertex_indices` (or `vertex_index`) of `face`. `red`, `green`, `blue` of faces, else
/// the mean of a face's vertices, are its reflectance: 8-bit values are sRGB, floating point values linear.
/// Faces whose colours agree in 8 bits of sRGB have one material, `colour R G B`, of their mean
/// reflectance; in a file without colours all have `default`, reflectance 0.5, with a note. Other elements
/// and properties are passed over, with a note. Throws InputError with file and line or byte.
[[nodiscard]] SceneInput read_ply(const std::filesystem::path& file, const std::string& bytes,
                                  const TextLookup& lookup);

}  // namespace fluxel
