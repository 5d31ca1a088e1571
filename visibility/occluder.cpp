#include "visibility/occluder.hpp"

#include <algorithm>
#include <glm/geometric.hpp>

#include "scene/polygon.hpp"

namespace fluxel {

std::vector<Occluder> make_occluders(const Scene& scene) {
  std::vector<Occluder> occluders;
  occluders.reserve(scene.patches.size());
  for (const Patch& patch : scene.patches) {
    const Outline<glm::dvec3>& outline = patch.outline;
    Occluder occluder;
    occluder.edges = outline.corners;
    glm::dvec3 middle(0);
    for (std::uint32_t k = 0; k < 4; ++k) {
      const glm::dvec3 corner = outline.corner[std::min(k, outline.corners - 1)];
      occluder.corner[k] = glm::vec3(corner);
      if (k < outline.corners) middle += corner / static_cast<double>(outline.corners);
    }
    occluder.normal = glm::vec3(patch.normal);
    occluder.centre = glm::vec3(middle);
    for (const glm::vec3& corner : occluder.corner)
      occluder.radius = std::max(occluder.radius, glm::length(corner - occluder.centre));
    occluders.push_back(occluder);
  }
  return occluders;
}

}  // namespace fluxel
