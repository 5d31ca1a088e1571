#pragma once

#include <glm/vec2.hpp>
#include <map>
#include <string>
#include <vector>

#include "scene/readers/mtl_check.hpp"
#include "scene/scene_input.hpp"
#include "scene/text_file.hpp"

namespace fluxel {

/// A face of a material that has maps.
struct TexturedFace {
  std::size_t polygon = 0;
  std::vector<std::size_t> corners;  ///< of `coordinates`, from 0; empty where some corner has none
};

/// What an OBJ file says of its faces' textures.
struct ObjTextures {
  std::vector<glm::dvec2> coordinates;
  std::vector<TexturedFace> faces;
};

/// Multiplies the Kd of faces by the mean of map_Kd over their texture coordinates, or over the whole image
/// where they have none, which gives face_rho and the mean of each material; and the Ke of a material by the
/// mean of map_Ke over its faces, by area. A Kd or Ke of 0, or none, counts as 1. Where an image is not
/// found, or neither PNG nor JPEG, the value stands as it is, with a note. Images are read one by one. Throws
/// InputError with the image's file where that is damaged.
void apply_textures(const std::map<std::string, MaterialMaps>& maps, const ObjTextures& textures,
                    const TextLookup& lookup, SceneInput& scene);

}  // namespace fluxel
