#pragma once

#include <cstddef>
#include <glm/vec3.hpp>
#include <span>

#include "scene/polygon.hpp"

namespace fluxel {

/// True only where the flat convex polygon cuts every segment between two convex bodies: its plane parts
/// them, and it covers the plane's whole section of their hull, both within epsilon [m]. The bodies are the
/// hulls of up to kMaxCutCorners points each.
[[nodiscard]] bool cuts_off(std::span<const glm::dvec3> first, std::span<const glm::dvec3> second,
                            PolygonView polygon, double epsilon);

inline constexpr std::size_t kMaxCutCorners = 8;

}  // namespace fluxel
