#pragma once

#include <cmath>
#include <cstdint>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <numbers>
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

/// A point of the opening, evenly from the unit square [m].
[[nodiscard]] inline glm::dvec3 opening_point(const Luminaire& of, double u, double v) {
  glm::dvec2 on(u - 0.5, v - 0.5);
  if (of.round) {
    const double radius = 0.5 * std::sqrt(u), angle = 2 * std::numbers::pi * v;
    on = {radius * std::cos(angle), radius * std::sin(angle)};
  }
  return of.position + of.size.x * on.x * of.ahead + of.size.y * on.y * glm::cross(of.ahead, of.aim);
}

}  // namespace fluxel
