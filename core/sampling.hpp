#pragma once

#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

#include "core/element.hpp"
#include "core/portable_sampling.hpp"

namespace fluxel {

/// A point of a triangle or parallelogram, area-preserving from the unit square.
[[nodiscard]] inline glm::dvec3 surface_point(const Outline<glm::dvec3>& outline, double u, double v) {
  return surface_point(outline.corner.data(), outline.corners, u, v);
}
[[nodiscard]] inline glm::dvec3 surface_point(const Outline<glm::vec3>& outline, double u, double v) {
  return surface_point(widen(outline), u, v);
}

}  // namespace fluxel
