#include "visibility/occluder.hpp"

#include <algorithm>
#include <glm/geometric.hpp>

#include "scene/polygon.hpp"

namespace fluxel {

std::vector<Occluder> make_occluders(const Scene& scene) {
  std::vector<Occluder> occluders;
  occluders.reserve(scene.patches.size());
  const auto rounding = static_cast<float>(2 * 0x1p-24 * scene.extent);
  for (const Patch& patch : scene.patches) {
    const Outline<glm::dvec3>& outline = patch.outline;
    Occluder occluder;
    occluder.edges = outline.corners;
    glm::dvec3 middle(0);
    double longest = 0;
    for (std::uint32_t k = 0; k < 4; ++k) {
      const glm::dvec3 corner = outline.corner[std::min(k, outline.corners - 1)];
      occluder.corner[k] = glm::vec3(corner);
      if (k < outline.corners) middle += corner / static_cast<double>(outline.corners);
      for (std::uint32_t other = 0; other < outline.corners; ++other)
        longest = std::max(longest, glm::length(outline.corner[other] - corner));
    }
    occluder.normal = glm::vec3(patch.normal);
    occluder.centre = glm::vec3(middle);
    for (const glm::vec3& corner : occluder.corner)
      occluder.radius = std::max(occluder.radius, glm::length(corner - occluder.centre));
    const double twice_area = outline.corners == 3 ? 2 * patch.area : patch.area;
    occluder.thinness = static_cast<float>(longest / twice_area);
    occluder.unevenness = rounding * std::max(1.0f, occluder.thinness * static_cast<float>(longest));
    occluders.push_back(occluder);
  }
  return occluders;
}

}  // namespace fluxel
