#include "formfactor/free_segments.hpp"

#include <array>
#include <cmath>
#include <glm/geometric.hpp>

namespace fluxel {

std::uint32_t free_segments(const RayScene& ray_scene, std::span<const SurfaceSegment> segments) {
  const auto epsilon = static_cast<double>(ray_scene.surface_epsilon());
  RayPacket packet;
  std::array<std::size_t, RayPacket::kSize> ray{};
  std::uint32_t free = 0;
  int count = 0;
  for (std::size_t k = 0; k < segments.size(); ++k) {
    const SurfaceSegment& segment = segments[k];
    const glm::dvec3 separation = segment.to - segment.from;
    const double near = epsilon / std::abs(glm::dot(segment.from_normal, separation));
    const double far = 1 - epsilon / std::abs(glm::dot(segment.to_normal, separation));
    if (!(near < far)) {
      free |= 1u << k;  // nothing fits between the two planes
      continue;
    }
    const auto lane = static_cast<std::size_t>(count);
    packet.origin_x[lane] = static_cast<float>(segment.from.x);
    packet.origin_y[lane] = static_cast<float>(segment.from.y);
    packet.origin_z[lane] = static_cast<float>(segment.from.z);
    packet.direction_x[lane] = static_cast<float>(separation.x);
    packet.direction_y[lane] = static_cast<float>(separation.y);
    packet.direction_z[lane] = static_cast<float>(separation.z);
    packet.t_near[lane] = static_cast<float>(near);
    packet.t_far[lane] = static_cast<float>(far);
    ray[lane] = k;
    ++count;
  }
  const std::uint32_t hidden = count > 0 ? ray_scene.occluded(packet, count) : 0;
  for (int lane = 0; lane < count; ++lane)
    if ((hidden >> lane & 1u) == 0) free |= 1u << ray[static_cast<std::size_t>(lane)];
  return free;
}

glm::dvec3 grid_point(const Outline<glm::vec3>& outline, const PointGrid& grid, int a, int b) {
  const double u = (a + 0.5) / grid.m, v = (b + 0.5) / grid.n;
  const glm::dvec3 corner(outline.corner[0]);
  const glm::dvec3 first = glm::dvec3(outline.corner[1]) - corner;
  if (outline.corners == 4) return corner + u * first + v * (glm::dvec3(outline.corner[3]) - corner);
  const double root = std::sqrt(u);
  return corner + root * (1 - v) * first + root * v * (glm::dvec3(outline.corner[2]) - corner);
}

}  // namespace fluxel
