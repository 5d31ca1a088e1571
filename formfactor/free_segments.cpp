#include "formfactor/free_segments.hpp"

#include <array>
#include <cmath>
#include <glm/geometric.hpp>

namespace fluxel {

std::uint32_t free_segments(const RayScene& ray_scene, std::span<const SurfaceSegment> segments) {
  const auto epsilon = static_cast<double>(ray_scene.surface_epsilon());
  RayPacket packet;
  for (std::size_t k = 0; k < segments.size(); ++k) {
    const SurfaceSegment& segment = segments[k];
    // As the rays of a tile.
    packet.set_segment(static_cast<int>(k), glm::vec3(segment.from + epsilon * segment.from_normal),
                       glm::vec3(segment.to + epsilon * segment.to_normal));
  }
  const auto count = static_cast<int>(segments.size());
  return count > 0 ? ~ray_scene.occluded(packet, count) & ((1u << count) - 1) : 0;
}

glm::dvec3 surface_point(const Outline<glm::vec3>& outline, double u, double v) {
  const glm::dvec3 corner(outline.corner[0]);
  const glm::dvec3 first = glm::dvec3(outline.corner[1]) - corner;
  if (outline.corners == 4) return corner + u * first + v * (glm::dvec3(outline.corner[3]) - corner);
  const double root = std::sqrt(u);
  return corner + root * (1 - v) * first + root * v * (glm::dvec3(outline.corner[2]) - corner);
}

}  // namespace fluxel
