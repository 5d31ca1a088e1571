#pragma once

#include <glm/vec3.hpp>

namespace fluxel {

/// A point that light falls on and the side that it falls on.
struct LitPoint {
  glm::dvec3 position{0};  ///< [m, recentred]
  glm::dvec3 normal{0};    ///< unit, of the side
};

}  // namespace fluxel
