#pragma once

#include <filesystem>
#include <glm/vec2.hpp>
#include <string_view>

#include "scene/readers/key_counts.hpp"
#include "scene/readers/statements.hpp"

namespace fluxel {

/// An image of a material, as map_Kd or map_Ke of an MTL file names it.
struct TextureMap {
  std::filesystem::path image;
  std::filesystem::path beside;    ///< by its last name in the folder, where there is no such image
  glm::dvec2 scale{1}, offset{0};  ///< texture coordinates become scale * them + offset
};

/// Reads what follows the keyword of a map, by the format as Wavefront's Advanced Visualizer manual (1990)
/// has it: options, of which -s and -o are used, and the name of the image, which may hold blanks and
/// backslashes. `folder`, of the MTL file,
/// is where relative names start, and `unused` takes the other options. Throws
/// InputError with file and line.
[[nodiscard]] TextureMap parse_texture_map(const Statements& at, std::string_view keyword,
                                           std::string_view rest, const std::filesystem::path& folder,
                                           KeyCounts& unused);

}  // namespace fluxel
