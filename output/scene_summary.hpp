#pragma once

#include <array>
#include <cstddef>
#include <glm/vec3.hpp>
#include <vector>

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

/// What the scene has of a material.
struct MaterialUse {
  std::size_t patches = 0;
  double area = 0;       ///< [m2] of one side, without what is covered
  Rgb emitted_power{0};  ///< [W] or [lm], below 0 where heat is drawn
};

/// One entry a material of the scene.
[[nodiscard]] std::vector<MaterialUse> use_of_materials(const Scene& scene);

}  // namespace fluxel
