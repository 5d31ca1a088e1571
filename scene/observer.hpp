#pragma once

#include <glm/vec3.hpp>
#include <string>

namespace fluxel {

/// Somebody who may be dazzled: an eye, and where it looks.
struct Observer {
  std::string name;
  glm::dvec3 eye{0};              ///< [m]
  glm::dvec3 direction{1, 0, 0};  ///< unit: the line of sight
  glm::dvec3 up{0, 0, 1};         ///< unit, normal to `direction`
};

}  // namespace fluxel
