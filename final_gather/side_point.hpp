#pragma once

#include <cmath>
#include <cstdint>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

namespace fluxel {

/// A point of a side of a piece.
struct SidePoint {
  static constexpr std::uint32_t kNothing = 0xFFFFFFFFu;

  glm::dvec3 position{0};          ///< [m]
  glm::dvec3 normal{0};            ///< unit, of the side
  std::uint32_t piece = kNothing;  ///< kNothing: there is none
};

/// Of normals of one surface, which may bend.
inline constexpr double kLeastSurfaceCosine = 0.94;

/// 1 where the normals are equal, 0 and less where they are not those of one surface.
[[nodiscard]] inline double agreement(const SidePoint& a, const SidePoint& b) {
  return (glm::dot(a.normal, b.normal) - kLeastSurfaceCosine) / (1 - kLeastSurfaceCosine);
}

/// How far both are off the plane midway between their own [m]: 0 of an arc too.
[[nodiscard]] inline double off_plane(const SidePoint& a, const SidePoint& b) {
  return std::abs(glm::dot(b.position - a.position, 0.5 * (a.normal + b.normal)));
}

/// Off that plane, over how far they are apart: what may still be one surface.
inline constexpr double kSurfaceOffPlane = 0.1;

[[nodiscard]] inline bool of_one_surface(const SidePoint& a, const SidePoint& b) {
  return agreement(a, b) > 0 && off_plane(a, b) <= kSurfaceOffPlane * glm::distance(a.position, b.position);
}

}  // namespace fluxel
