#pragma once

#include <glm/vec3.hpp>
#include <span>

#include "core/element.hpp"

namespace fluxel {

/// True only where the convex patch cuts every segment between two convex bodies: its plane parts them, and it
/// covers the plane's whole section of their hull, both within epsilon [m]. Of each body up to kMaxCutCorners
/// corners are known.
[[nodiscard]] bool cuts_off(std::span<const glm::dvec3> first, std::span<const glm::dvec3> second,
                            const Outline<glm::dvec3>& patch, double epsilon);

inline constexpr std::size_t kMaxCutCorners = 8;

}  // namespace fluxel
