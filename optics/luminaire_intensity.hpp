#pragma once

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

#include "scene/intensity_table.hpp"
#include "scene/luminaire.hpp"

namespace fluxel {

/// The table's intensity along `way`, whose length is `distance` [m], from a point of the luminaire's
/// opening; `across`: unit, to C = 90 degrees.
[[nodiscard]] inline double intensity_along(const glm::dvec3& way, double distance, const Luminaire& of,
                                            const glm::dvec3& across, const IntensityTable& table) {
  const double gamma = std::acos(std::clamp(glm::dot(way, of.aim) / distance, -1.0, 1.0));
  const double C = table.C.size() > 1 ? std::atan2(glm::dot(way, across), glm::dot(way, of.ahead)) : 0;
  return intensity(table, C, gamma);
}

}  // namespace fluxel
