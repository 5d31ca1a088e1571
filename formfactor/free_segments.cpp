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

}  // namespace fluxel
