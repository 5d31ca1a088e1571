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

enum class GlbEncoding {
  full,      ///< positions in single precision, _RADIOSITY
  quantised  ///< positions in 16 bits of the longest side of all parts together, no _RADIOSITY
};

/// How a file is made.
struct GlbStyle {
  bool z_up = false;  ///< of the scene, which is then turned to y up
  GlbEncoding encoding = GlbEncoding::full;
  std::string generator;
};

/// Writes glTF 2.0 as one binary file: a root node at `origin` [m], with a node and a
/// mesh for each part, one unlit material, the colours as COLOR_0 of 16 bits, and in full the radiosity as
/// _RADIOSITY. Quantised positions (KHR_mesh_quantization) are of one grid, so that parts that meet still do.
/// Parts without a triangle are left out. Throws InputError where it cannot be written (nothing then stands
/// under its name) and where it would be longer than the 4 GiB that the format allows.
void write_glb(const std::filesystem::path& file, std::span<const GlbPart> parts, const glm::dvec3& origin,
               const GlbStyle& style);

}  // namespace fluxel
