#pragma once

#include <array>
#include <cstdint>
#include <glm/vec3.hpp>
#include <vector>

#include "scene/scene.hpp"

namespace fluxel {

/// A patch as it stands in the way, in single precision: its corners are the very numbers that the ray scene
/// has.
struct Occluder {
  std::array<glm::vec3, 4> corner;  ///< a triangle's last one stands twice
  glm::vec3 normal{0};
  glm::vec3 centre{0};
  float radius = 0;      ///< [m], of the corners around the centre
  float thinness = 0;    ///< [1/m], longest side of a triangle of it over twice the triangle's area
  float unevenness = 0;  ///< [m], how far rounding may tilt its planes off the normal's, at its corners
  std::uint32_t edges = 0;
};

/// All patches, by PatchId.
[[nodiscard]] std::vector<Occluder> make_occluders(const Scene& scene);

}  // namespace fluxel
