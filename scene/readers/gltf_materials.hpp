#pragma once

#include <cstddef>
#include <glm/mat2x2.hpp>
#include <glm/vec2.hpp>
#include <optional>
#include <string>
#include <vector>

#include "scene/readers/gltf_file.hpp"
#include "scene/scene_input.hpp"

namespace fluxel {

/// How a material uses a texture: where in the image a vertex lies (KHR_texture_transform).
struct GltfTextureUse {
  std::size_t image = 0;
  std::string coordinates;  ///< attribute of the vertices, as "TEXCOORD_0"
  glm::dmat2 linear{1};
  glm::dvec2 offset{0};
};

/// A material as far as it goes without its images.
struct GltfMaterial {
  InputMaterial input;  ///< rho and E: what images are multiplied by
  std::optional<GltfTextureUse> base_colour, emission;
};

/// The materials of the file, of names that differ, in its order: the base colour is the reflectance of a
/// diffuse surface whatever the metallic factor, emission a luminance [cd/m2], E = pi * L. Throws InputError
/// with the JSON path.
[[nodiscard]] std::vector<GltfMaterial> read_gltf_materials(const GltfFile& gltf);

}  // namespace fluxel
