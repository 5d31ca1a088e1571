#pragma once

#include <filesystem>
#include <string>

#include "scene/scene_input.hpp"
#include "scene/text_file.hpp"

namespace fluxel {

/// Reads an STL file (3D Systems, StereoLithography Interface Specification, 1989), as text or binary. All
/// facets get the material `default`, reflectance 0.5, with a note. A solid is a group of its name: in a
/// binary file what its header says. The front is where the corners run counterclockwise; stored normals
/// that say otherwise, and attributes of binary facets, are noted. Coordinates are taken as metres. Throws
/// InputError with file and line or byte.
[[nodiscard]] SceneInput read_stl(const std::filesystem::path& file, const std::string& bytes,
                                  const TextLookup& lookup);

}  // namespace fluxel
