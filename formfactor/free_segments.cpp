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
    // As in trace_tile.
    const glm::vec3 from(segment.from + epsilon * segment.from_normal);
    const glm::vec3 to(segment.to + epsilon * segment.to_normal);
    packet.origin_x[k] = from.x;
    packet.origin_y[k] = from.y;
    packet.origin_z[k] = from.z;
    packet.direction_x[k] = to.x - from.x;
    packet.direction_y[k] = to.y - from.y;
    packet.direction_z[k] = to.z - from.z;
    packet.t_near[k] = 0;
    packet.t_far[k] = 1;
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
