#pragma once

#include <array>
#include <cstddef>
#include <glm/vec3.hpp>

#include "core/rgb.hpp"
#include "scene/scene.hpp"

namespace fluxel {

/// Figures of a scene that a user checks first.
struct SceneSummary {
  std::size_t emitters = 0;            ///< patches
  Rgb emitted_power{0};                ///< by patches [W]
  Rgb luminaire_power{0};              ///< [W]
  Rgb drawn_power{0};                  ///< [W], of prescribed fluxes that take heat out
  std::array<glm::dvec3, 2> bounds{};  ///< lowest and highest coordinates [m, world]
};

[[nodiscard]] SceneSummary summarise(const Scene& scene);

}  // namespace fluxel
