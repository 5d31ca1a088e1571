#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <glm/vec3.hpp>
#include <span>
#include <string>
#include <vector>

#include "core/rgb.hpp"

namespace fluxel {

/// A node of a file: triangles whose vertices have colours.
struct GlbPart {
  std::string name;
  std::vector<glm::vec3> positions;    ///< [m], from the origin of the file's scene
  std::vector<Rgb> colours;            ///< linear, 0 to 1, of each vertex
  std::vector<Rgb> radiosity;          ///< of each vertex
  std::vector<std::uint32_t> corners;  ///< three a triangle
};

/// Writes glTF 2.0 as one binary file: a root node at `origin` [m], turned from z up to y up where `z_up`,
/// with a node and a mesh for each part, one unlit material, the colours as COLOR_0 and the radiosity as
/// _RADIOSITY. Parts without a triangle are left out. Throws InputError where it cannot be written (nothing
/// then stands under its name) and where it would be longer than the 4 GiB that the format allows.
void write_glb(const std::filesystem::path& file, std::span<const GlbPart> parts, const glm::dvec3& origin,
               bool z_up, const std::string& generator);

}  // namespace fluxel
