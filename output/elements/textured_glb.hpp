#pragma once

#include <cstdint>
#include <filesystem>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "output/elements/glb_file.hpp"

namespace fluxel {

/// Triangles of one group and one material.
struct TexturedPart {
  std::string name, material;
  std::vector<glm::vec3> positions;      ///< [m], from the origin of the file's scene
  std::vector<glm::vec2> along_surface;  ///< [m], to the right and down
  std::vector<glm::vec2>
      in_texture;  ///< 0 to 1, from the upper left corner of the picture to the right and down
  std::vector<std::uint32_t> corners;  ///< three a triangle
};

/// Writes glTF 2.0 as one binary file: as write_glb does, with a material of each name, all unlit and with
/// the same picture, `png`, at TEXCOORD_1. TEXCOORD_0 are metres along the surface, for textures that repeat.
/// Parts that follow each other and have one name are one node. Throws what write_glb_file does.
void write_textured_glb(const std::filesystem::path& file, std::span<const TexturedPart> parts,
                        std::string_view png, const GlbScene& scene);

}  // namespace fluxel
