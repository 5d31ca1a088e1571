#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <glm/vec3.hpp>
#include <span>
#include <string>
#include <vector>

#include "core/rgb.hpp"
#include "output/elements/glb_file.hpp"

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

/// Writes glTF 2.0 as one binary file: a node and a mesh for each part, one unlit material, the colours as
/// COLOR_0 of 16 bits, and in full the radiosity as _RADIOSITY. Quantised positions (KHR_mesh_quantization)
/// are of one grid, so that parts that meet still do. Parts without a triangle are left out. Throws what
/// write_glb_file does.
void write_glb(const std::filesystem::path& file, std::span<const GlbPart> parts, GlbEncoding encoding,
               const GlbScene& scene);

}  // namespace fluxel
