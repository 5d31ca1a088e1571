#pragma once

#include <glm/vec3.hpp>
#include <string>

namespace fluxel {

/// A virtual light meter: a grid of cells over a parallelogram that hides nothing and sends nothing. It
/// measures the irradiance of the side that u x v points to.
struct Receiver {
  std::string name;
  glm::dvec3 origin{0};  ///< corner [m]
  glm::dvec3 u{0};       ///< edge along which the columns follow one another [m]
  glm::dvec3 v{0};       ///< edge along the rows [m]
  int columns = 1;
  int rows = 1;
};

}  // namespace fluxel
