#pragma once

#include <array>
#include <cstdint>
#include <glm/vec3.hpp>
#include <vector>

#include "scene/scene.hpp"

namespace fluxel {

/// A patch as it stands in the way, in single precision.
struct Occluder {
  std::array<glm::vec3, 4> corner;  ///< a triangle's last one stands twice
  glm::vec3 normal{0};
  glm::vec3 centre{0};
  float radius = 0;  ///< [m], of the corners around the centre
  std::uint32_t edges = 0;
};

/// All patches, by PatchId.
[[nodiscard]] std::vector<Occluder> make_occluders(const Scene& scene);

}  // namespace fluxel
