#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <string>

#include "core/rgb.hpp"

namespace fluxel {

/// A lamp that is no surface: a far field over a luminous opening, which hides nothing. The intensity of the
/// whole is spread evenly over the opening.
struct Luminaire {
  std::string name;
  glm::dvec3 position{0};       ///< the opening's centre [m]
  glm::dvec3 aim{0, 0, -1};     ///< unit: gamma = 0
  glm::dvec3 ahead{1, 0, 0};    ///< unit, normal to aim: C = 0; C = 90 degrees is cross(ahead, aim)
  glm::dvec2 size{0};           ///< of the opening along C = 0 and along C = 90 degrees [m]; 0, 0: a point
  bool round = false;           ///< an ellipse of these diameters in place of a rectangle
  std::uint32_t intensity = 0;  ///< which of the scene's tables
  Rgb scale{1};                 ///< intensity per unit of the table's
};

}  // namespace fluxel
