#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <span>

#include "core/element.hpp"
#include "visibility/ray_scene.hpp"

namespace fluxel {

/// From a point of one surface to a point of another, with the unit normals of the sides that face each
/// other.
struct SurfaceSegment {
  glm::dvec3 from{0}, from_normal{0};
  glm::dvec3 to{0}, to_normal{0};
};

/// Bit k is set where nothing crosses segment k, of at most RayPacket::kSize. Both ends are
/// lifted off their surfaces by the scene's surface_epsilon.
[[nodiscard]] std::uint32_t free_segments(const RayScene& ray_scene,
                                          std::span<const SurfaceSegment> segments);

}  // namespace fluxel
